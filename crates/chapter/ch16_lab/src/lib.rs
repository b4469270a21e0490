#![doc = include_str!("../README.md")]
//!
//! The chapter's experiments on simulator and estimator: laps of the Apartment with their errors, basins of
//! convergence, cost landscapes, and sample data for benchmarks and examples.

#![cfg_attr(not(test), warn(clippy::disallowed_methods, clippy::disallowed_types))]

pub mod basin;
pub mod buildings;
pub mod drift;
pub mod incremental;
pub mod jacobians;
pub mod lap;
pub mod laps;
pub mod moving_box;
pub mod nudge;
pub mod places;
pub mod procrustes;
pub mod reader_code;
pub mod relocalization;
pub mod results;
pub mod rule;
pub mod samples;
mod scenes;
pub mod sweeping;
pub mod terrain;
pub mod whole_window;
