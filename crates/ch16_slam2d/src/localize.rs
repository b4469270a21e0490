//! Where a robot is on a map that is known, and when it does not know.
//!
//! A [`KnownMap`] holds the keyframes of a session at their poses. A [`Localizer`] takes one frame at
//! a time and never changes the map. While it knows where it is, each scan is registered on the
//! keyframes around the prediction and weighed against it, by what each knows. While it does not,
//! it gathers the sweeps of the last metres and searches for them: keyframes that look alike
//! ([`ScanContext`](crate::places::ScanContext)) say how well a good place fits, branch and bound
//! ([`search`](crate::search)) finds the best place of the whole map and the best other one, and
//! registration with its fit decides. A place that another one is too close to is not localized: with
//! more metres in the trail one of them wins.
//!
//! What it cannot do: two places that look the same for as long as the trail is remain two places,
//! and it says so.

mod belief;
mod config;
mod known_map;
mod localizer;
mod map_search;
mod pending_fix;
mod report;
mod trail;

#[cfg(test)]
mod tests;

pub use config::{LocalizeConfig, StartPose};
pub use known_map::{KnownMap, PlaceGuess};
pub use localizer::Localizer;
pub use map_search::MapSearch;
pub use pending_fix::PendingFix;
pub use report::{LocalizeReport, Verdict};
