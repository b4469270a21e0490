//! What a user types, and the names of the chapter's printed listings, in one import.
//!
//! Its first worked example: four points on the unit circle, rotated and translated. The motion follows
//! in closed form.
//!
//! ```
//! use ch16_slam2d::prelude::*;
//!
//! let src = [(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0)].map(|(x, y)| Point2::new(x, y));
//! let dst = [(2.8, 1.6), (1.4, 1.8), (1.2, 0.4), (2.6, 0.2)].map(|(x, y)| Point2::new(x, y));
//! let pose: SE2 = svd_align(&src, &dst);
//! assert!((pose.translation() - Vector2::new(2.0, 1.0)).norm() < 1e-12);
//! assert_eq!(format!("{:.2}", pose.theta().to_degrees()), "36.87");
//! ```
//!
//! The second: two odometry edges of 1 m, and a loop of 2.6 m. χ² falls from 0.36 to 0.12,
//! and each edge takes a third of the error.
//!
//! ```
//! use ch16_slam2d::prelude::*;
//!
//! let omega = Matrix3::identity();
//! let mut graph = PoseGraph::new();
//! let a = graph.add_fixed_node(SE2::identity());
//! let b = graph.add_node(SE2::from_xy(1.0, 0.0));
//! let c = graph.add_node(SE2::from_xy(2.0, 0.0));
//! graph.add_edge(a, b, SE2::from_xy(1.0, 0.0), omega, EdgeKind::Odometry);
//! graph.add_edge(b, c, SE2::from_xy(1.0, 0.0), omega, EdgeKind::Odometry);
//! graph.add_edge(a, c, SE2::from_xy(2.6, 0.0), omega, EdgeKind::Loop);
//! assert!((graph.chi2() - 0.36).abs() < 1e-12);
//!
//! graph.optimize(10, 1e-9);
//! assert!((graph.chi2() - 0.12).abs() < 1e-9);
//! // 1e-8: the solver adds 1e-9 to the diagonal.
//! assert!((graph.pose(b).translation().x - 1.2).abs() < 1e-8);
//! assert!((graph.pose(c).translation().x - 2.4).abs() < 1e-8);
//! for edge in graph.edges() {
//!     assert!((graph.edge_chi2(edge.id) - 0.04).abs() < 1e-8);
//! }
//! ```

pub use pr_geom::{Matrix3, Point2, SE2, Vector2, Vector3};

pub use crate::cloud::{NearestMap, Neighbor, PointCloud, VoxelMap};
pub use crate::graph::{EdgeKind, NodeId, PoseEdge, PoseGraph};
pub use crate::icp::{
    IcpConfig, IcpResult, IcpVariant, Pair, icp, icp_information, point_to_plane_step, regularize,
    svd_align,
};
pub use crate::pipeline::{LogFrame, Pipeline};
pub use crate::scan::{Frame, LaserScan};
pub use crate::slam::{Slam, SlamConfig, SlamReport};
