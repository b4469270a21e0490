//! The chapter's rules, for its figures: registration on the last sweeps, and loops by a drift gate.
//!
//! `WindowRegistrar` registers each sweep with a [`Matcher`](crate::matching::Matcher) on the points of the
//! last few, within an [`AdaptiveThreshold`]. `NearbyLoops` queries a [`LoopDetector`](crate::loops::LoopDetector)
//! for candidates, registers the newest sweep on the keyframes around one and tests the innovation against the
//! drift of the path ([`path_information`]). Edges get the information of their pairs, rotated as in the chapter's
//! figures ([`InformationFrame`]), and the optimizer uses the chapter's approximate Jacobians.
//!
//! The estimator for recorded logs uses none of this: see [`LocalMapConfig`](crate::local_map::LocalMapConfig).

mod adaptive_threshold;
mod drift_gate;
mod nearby_loops;
mod parts;
mod window_registrar;

pub use adaptive_threshold::AdaptiveThreshold;
pub use drift_gate::{marginal_information, path_information};
pub(crate) use nearby_loops::NearbyLoops;
pub use parts::ChapterParts;
pub(crate) use window_registrar::WindowRegistrar;

pub use crate::config::{ChapterConfig, DetectorKind, ThresholdConfig};
pub use crate::matching::{InformationFrame, chapter_information};
