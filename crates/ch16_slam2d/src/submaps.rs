//! Submaps: small probability grids that are finished and never change again.
//!
//! A scan is registered against the older of two grids that overlap and added to both
//! ([`ActiveSubmaps`]); once it holds N scans the older one is finished ([`FinishedSubmap`]). Every
//! keyframe is tied to the submaps that it was added to, so drift inside a submap is nobody's
//! business. A loop is a keyframe that is found on a finished submap to which it was not added: every
//! pose of the window that the gate lets pass is scored by branch and bound, and the best one climbs
//! on the grid ([`SubmapLoops`]).
//!
//! A submap stands for its anchor, the first keyframe in it: it has no node of its own, and its frame is
//! that keyframe's. What it leaves out of Cartographer: submaps as nodes of the graph, the sparse pose
//! adjustment in the background, and trimming of old submaps.
//!
//! Source: Hess, Kohler, Rapp, Andor, "Real-time loop closure in 2D LIDAR SLAM", ICRA 2016.

mod active;
mod config;
mod finished;
mod loops;
mod probability_grid;

pub use active::{ActiveSubmap, ActiveSubmaps};
pub use config::{FrontEndChoice, FrontEndKind, SubmapConfig};
pub use finished::FinishedSubmap;
pub use loops::SubmapLoops;
pub use probability_grid::{FinishedGrid, GridConfig, MAX_GRID_CELLS, ProbabilityGrid};
