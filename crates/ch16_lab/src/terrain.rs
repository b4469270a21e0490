//! The scenes of w16.3: the cost of ICP and the score of NDT as landscapes over `(Δx, Δy)`.
//!
//! A cloud is shifted over its own map with its heading fixed. ICP's cost is the mean over the
//! points of `min(d², τ²)`, d the distance to the nearest map point (m²); NDT's is the mean score
//! of the points (no unit). Every shift is evaluated; nothing is interpolated.
//!
//! The ICP landscape has one dent for every way of pairing points along a wall, and terraces where
//! most points are truncated. The NDT landscape is smooth but falls to zero a cell away from the
//! walls. [`Ball`] rolls down either; [`TerrainScene::information`] tells how steep the valley is.
//!
//! A sweep on its own points knows too much: it recognizes its own noise. In
//! [`SceneKind::LongCorridor`] map and sweep are measured apart, and [`Drops`] shows how far the
//! answers of many sweeps scatter.

mod ball;
mod drops;
mod grid;
mod icp_row;
mod information;
mod ndt_row;
mod probe;
mod ridge;
mod rows;
mod scene;

pub use ball::{Ball, BallConfig, BallStep, BallStop};
pub use drops::{DROP_SPREAD_M, Drops};
pub use grid::{Peak, Terrain};
pub use information::{PoseInformation, ShiftInformation, pose_information};
pub use probe::{Objective, Slope, TerrainProbe};
pub use ridge::{Partner, PartnerChange};
pub use rows::{PlaneRow, PlaneRows, RowsKnow};
pub use scene::{SceneKind, TerrainScene, TerrainSettings};
