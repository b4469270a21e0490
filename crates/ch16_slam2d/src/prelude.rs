//! What the chapter's printed listings use, in one import.
//!
//! ```
//! use ch16_slam2d::prelude::*;
//!
//! let turned = SE2::new(2.0, 1.0, 0.5);
//! assert_eq!(turned.translation(), Vector2::new(2.0, 1.0));
//! ```

pub use pr_geom::{Matrix3, SE2, Translation, Vector2, Vector3};

pub use crate::cloud::{NearestMap, Neighbor, PointCloud, VoxelMap};
pub use crate::graph::{EdgeKind, NodeId, PoseEdge, PoseGraph};
pub use crate::icp::{
    IcpConfig, IcpResult, IcpVariant, Pair, icp, icp_information, point_to_plane_step, regularize,
    svd_align,
};
