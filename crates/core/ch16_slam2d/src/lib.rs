#![doc = include_str!("../README.md")]
#![cfg_attr(not(test), warn(clippy::disallowed_methods, clippy::disallowed_types))]

mod assembly;
pub mod chapter;
pub mod chi_squared;
pub mod cloud;
mod config;
pub mod digest;
pub mod graph;
pub mod icp;
pub mod local_map;
pub mod localize;
pub mod loops;
pub mod matching;
pub mod metrics;
pub mod ndt;
pub mod pipeline;
pub mod places;
pub mod prelude;
pub mod scan;
pub mod search;
pub mod slam;
