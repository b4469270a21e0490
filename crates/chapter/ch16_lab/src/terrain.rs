//! The scenes of w16.3: the cost of ICP and the score of NDT as landscapes over `(Δx, Δy)`.
//!
//! A cloud is shifted over its own map with its heading fixed. ICP's cost is the mean over the
//! points of `min(d², τ²)`, d the distance to the nearest map point (m²); NDT's is the mean score
//! of the points (no unit). Every shift is evaluated; nothing is interpolated.
//!
//! The ICP landscape has one local minimum for every pairing of points along a wall, and plateaus where all
//! points are truncated. The NDT landscape is smooth but falls to zero a cell away from the walls. [`Ball`]
//! descends on either; [`TerrainScene::information`] returns how steep the valley is.
//!
//! A sweep on its own points is too optimistic: the noise is the same in both. In [`SceneKind::LongCorridor`]
//! map and sweep have independent noise, and [`Drops`] shows the scatter of many sweeps' results.

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
pub use rows::{PlaneRow, PlaneRows, RowConstraints};
pub use scene::{SceneKind, TerrainScene, TerrainSettings};
