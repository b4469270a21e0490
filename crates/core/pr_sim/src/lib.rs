#![doc = include_str!("../README.md")]
//!
//! Simulates a robot in the plane: worlds, ray casting, LiDAR, wheel odometry and a way-point driver
//! (Chapters 4 and 9).
//!
//! Every result depends on the arguments and on one seeded [`Rng`] only: the same seed gives the same
//! bits natively and in WebAssembly. Units are metres, radians and seconds.

#![cfg_attr(not(test), warn(clippy::disallowed_methods, clippy::disallowed_types))]

pub mod course;
pub mod driver;
pub mod lidar;
pub mod motion;
pub mod sketch;
pub mod world;

pub use course::{Course, CourseError};
pub use driver::{DriveStep, DriverConfig, WaypointDriver};
pub use lidar::{Lidar, LidarConfig};
pub use motion::{VelocityCommand, VelocityNoise};
pub use pr_geom::Rng;
pub use sketch::{Sketch, SketchError};
pub use world::{Room, Wall, World, WorldRect};
