#![doc = include_str!("../README.md")]
//!
//! Incremental maximum likelihood mapping, the predecessor of pose-graph SLAM: one map, one pose, no revision.
//!
//! Incremental maximum likelihood mapping puts every scan at its most likely pose on the map of all scans
//! before it, `ŝ = argmax p(z | s, m) p(s | u, ŝ₋₁)`, and adds it there for good. The likelihood is a
//! field of the distance to the nearest wall ([`LikelihoodMap`]). Hill climbing from the odometry prediction finds
//! the maximum ([`ScanClimb`](crate::field::ScanClimb)).
//!
//! Errors are never corrected: at the end of a cycle the map is inconsistent, and the basin of convergence of
//! climbing is only as wide as the field. The variant with cycle closing also keeps a posterior
//! over poses ([`PoseBelief`]): particles that spread with the drift and are weighted on the
//! old part of the map alone. If they agree on a pose, the cycle is closed: the pose error is
//! distributed backwards along the path ([`push_backwards`]).
//!
//! It cannot close a cycle whose drift exceeds the spread of its particles, cannot revert a false
//! closure, and does not weight several cycles against each other, as one sparse solve does.
//!
//! Sources: Thrun, Burgard, Fox, "A real-time algorithm for mobile robot mapping with applications to
//! multi-robot and 3D mapping", ICRA 2000; Thrun, Burgard, Fox, "Probabilistic Robotics", 2005, §6.4
//! (likelihood fields), §4.3 (particles). Theirs optimizes all poses of a cycle again after the
//! correction; here they stay.

#![cfg_attr(not(test), warn(clippy::disallowed_methods, clippy::disallowed_types))]

mod belief;
mod config;
mod cycles;
pub mod field;
mod likelihood_map;
mod mapper;
mod push;
mod report;

pub use belief::{BeliefSpread, PoseBelief};
pub use config::{CycleConfig, IncrementalConfig};
pub use cycles::CycleWatch;
pub use likelihood_map::{LikelihoodField, LikelihoodMap, LikelihoodMapConfig, MAX_MAP_CELLS};
pub use mapper::IncrementalMapper;
pub use push::push_backwards;
pub use report::{CycleClosure, CycleTest, CycleVerdict, IncrementalReport};
