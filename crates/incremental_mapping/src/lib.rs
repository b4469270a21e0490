#![doc = include_str!("../README.md")]
//!
//! The ancestor of pose graphs: one map, one pose, and never a look back, or only along the path.
//!
//! Incremental maximum likelihood mapping puts every scan where it fits best on the map of all scans
//! before it, `ŝ = argmax p(z | s, m) p(s | u, ŝ₋₁)`, and adds it there for good. The likelihood is a
//! field: how near the next wall is ([`LikelihoodMap`]). The maximum is sought by hill climbing from
//! where the wheels lead ([`ScanClimb`](crate::field::ScanClimb)).
//!
//! What is wrong once stays wrong: at the end of a cycle the map does not meet its own beginning, and
//! climbing reaches only what is as near as the field is wide. The variant for cycles keeps a posterior
//! over poses beside it ([`PoseBelief`]): particles that spread as the way drifts and are weighed on the
//! old part of the map alone. Where they agree on a place, the cycle is closed: what the pose is off is
//! pushed backwards along the path ([`push_backwards`]).
//!
//! It cannot close a cycle that drifted farther than its particles reached, it cannot take back one that
//! is false, and it weighs no two cycles against each other: one sparse solve does.
//!
//! Sources: Thrun, Burgard, Fox, "A real-time algorithm for mobile robot mapping with applications to
//! multi-robot and 3D mapping", ICRA 2000; Thrun, Burgard, Fox, "Probabilistic Robotics", 2005, §6.4
//! (likelihood fields), §4.3 (particles). Theirs optimizes all poses of a cycle once more after the
//! push; here they stay where it leaves them.

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
