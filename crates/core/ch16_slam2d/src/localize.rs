//! Localization of a robot on a known map, which also detects that the robot is lost.
//!
//! A [`KnownMap`] holds the keyframes of a session at their poses. A [`Localizer`] takes one frame at
//! a time and never changes the map. While the robot is localized, each scan is registered on the
//! keyframes around the prediction and fused with it, weighted by information. While it is lost,
//! the localizer accumulates the sweeps of the last metres and searches for them: similar keyframes
//! ([`ScanContext`](crate::places::ScanContext)) give a lower bound of the score, branch and bound
//! ([`search`](crate::search)) finds the best pose on the whole map and the best distinct one, and
//! registration verifies the fit. If the runner-up is too close, the pose is not accepted: with
//! more metres in the trail one of them wins.
//!
//! Limitation: two locations that look the same for the whole length of the trail remain ambiguous,
//! and the robot is then reported as lost or doubtful.

mod belief;
mod config;
mod fit;
mod known_map;
mod localizer;
mod map_search;
mod pending_fix;
mod report;
mod trail;
mod trial;

#[cfg(test)]
mod tests;

pub use config::{LocalizeConfig, StartPose};
pub use known_map::{KnownMap, PlaceGuess};
pub use localizer::Localizer;
pub use map_search::MapSearch;
pub use pending_fix::PendingFix;
pub use report::{LocalizeReport, Verdict};
