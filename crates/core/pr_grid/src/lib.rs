#![doc = include_str!("../README.md")]
//!
//! Log-odds occupancy grid (Chapter 13): Bresenham rays and the inverse sensor model of Thrun,
//! Burgard, Fox 2005, Table 9.2.
//!
//! The grid assumes known poses and independent cells. It does not correct poses: after a loop
//! closure moves them, rebuild it from scratch.

#![cfg_attr(not(test), warn(clippy::disallowed_methods, clippy::disallowed_types))]

pub mod beams;
pub mod bresenham;
pub mod grid;
pub mod sensor_model;
pub mod tiles;

pub use beams::Beams;
pub use bresenham::{Cell, bresenham};
pub use grid::{GridConfig, OccupancyGrid};
pub use sensor_model::{InverseSensorModel, probability_to_log_odds};
pub use tiles::{MAX_TILED_CELLS, TiledGrid, TooManyCells};
