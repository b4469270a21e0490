#![doc = include_str!("../README.md")]
//!
//! The chapter's experiments, on the simulator and the estimator: whole laps of the Apartment with
//! their judge, basins of attraction, cost landscapes, and samples to time and to try things on.

#![cfg_attr(not(test), warn(clippy::disallowed_methods, clippy::disallowed_types))]

pub mod basin;
pub mod buildings;
pub mod come_back;
pub mod incremental;
pub mod jacobians;
pub mod lap;
pub mod laps;
pub mod moving_box;
pub mod nudge;
pub mod places;
pub mod procrustes;
pub mod results;
pub mod samples;
mod scenes;
pub mod terrain;
pub mod whole_window;
