//! The chapter's listings under the names and shapes that it prints: a reference to read and to run.
//!
//! Each file is one concept, written for the reader: clouds are vectors of points, the map is a hash,
//! the graph is `petgraph`'s, and its normal equations go to `faer`'s sparse Cholesky as scalars. The
//! laps and the page use the core's own types, which do the same faster; the tests compare the two to
//! 1e-9.
//!
//! | file | what it holds |
//! |---|---|
//! | `se2` | poses: [`SE2::new`] takes a vector and an angle |
//! | `cloud` | [`PointCloud`] |
//! | `voxel_map` | [`VoxelMap`] |
//! | `correspondence` | [`Correspondence`], and the association of a sweep |
//! | `align` | [`svd_align`], [`point_to_plane_step`] |
//! | `registration` | [`icp()`] |
//! | `information` | [`icp_information`], [`regularize`] |
//! | `pose_graph` | [`PoseEdge`], [`PoseGraph`] |
//! | `loop_closure` | [`detect_loop_candidates`], [`submap`], [`verify_loop`] |

#![cfg_attr(not(test), warn(clippy::disallowed_methods, clippy::disallowed_types))]

mod align;
mod cloud;
mod correspondence;
mod information;
mod loop_closure;
mod pose_graph;
pub mod prelude;
mod registration;
mod se2;
mod voxel_map;

pub use align::{point_to_plane_step, svd_align};
pub use cloud::PointCloud;
pub use correspondence::{Correspondence, associate};
pub use information::{icp_information, regularize};
pub use loop_closure::{LoopConfig, VerifiedLoop, detect_loop_candidates, submap, verify_loop};
pub use pose_graph::{EdgeKind, PoseEdge, PoseGraph};
pub use registration::{IcpConfig, IcpResult, IcpVariant, icp, measures_pose};
pub use se2::{SE2, Translation};
pub use voxel_map::VoxelMap;
