//! The exercises in code: each module is one, with its task, its formula and a function to write.
//!
//! `teaching/exercises/README.md` describes how to work on them.

// A stub uses none of its arguments.
#![allow(unused_variables)]

#[cfg_attr(feature = "forged", path = "../forged/gauss_newton.rs")]
pub mod gauss_newton;
#[cfg_attr(feature = "forged", path = "../forged/point_to_plane_step.rs")]
pub mod point_to_plane_step;
#[cfg_attr(feature = "forged", path = "../forged/range_histogram.rs")]
pub mod range_histogram;
#[cfg_attr(feature = "forged", path = "../forged/residual.rs")]
pub mod residual;
#[cfg_attr(feature = "forged", path = "../forged/svd_align.rs")]
pub mod svd_align;
#[cfg_attr(feature = "forged", path = "../forged/trimmed_icp.rs")]
pub mod trimmed_icp;
#[cfg_attr(feature = "forged", path = "../forged/verify_loop.rs")]
pub mod verify_loop;

#[cfg(feature = "solutions")]
pub use exercise_solutions::*;
#[cfg(not(feature = "solutions"))]
pub use {
    gauss_newton::{optimize, optimize_once},
    point_to_plane_step::point_to_plane_step,
    range_histogram::{chi2_distance, detect_by_histogram, range_histogram},
    residual::{jacobians, residual},
    svd_align::svd_align,
    trimmed_icp::icp,
    verify_loop::verify_loop,
};

/// Ends a test or lap that needs an unwritten exercise; the message has its name and file.
///
/// # Panics
/// Always.
#[track_caller]
pub fn not_written(name: &str) -> ! {
    panic!("{name} is not written yet: its task is in teaching/exercises/src/{name}.rs")
}
