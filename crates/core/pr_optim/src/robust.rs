//! Outlier rejection: which measurements are inliers, and the poses by those.
//!
//! A kernel judges every measurement alone and at the current poses, so from a poor guess it rejects true ones.
//! Three methods use more evidence:
//!
//! - [`select_inliers`] accepts loops in the order of the path, as a robot meets them, and tests each by the exact
//!   covariance of all others; if the result is ambiguous, it runs [`Gnc`] as well. [`select_added`] continues from the
//!   poses of a solved graph.
//! - [`Gnc`] starts with a nearly convex cost and deforms it step by step into one that either keeps or rejects a
//!   measurement.
//! - [`consistent_set`] searches the largest set of loops that are consistent with each other along the trusted
//!   path, before anything is solved; [`select_consistent`] starts from that set and tests each loop as
//!   [`select_inliers`] does.
//!
//! All trust the measurements between consecutive poses ([`is_sequential`]) and decide about the loops. None
//! can distinguish a false loop that is consistent with the rest from a true one.

mod along_path;
mod consistency;
mod gnc;
mod inliers;
mod marginal_gate;
mod path;

pub use consistency::{ConsistencySettings, consistent_set};
pub use gnc::{Gnc, GncLoss, GncOutcome, GncRound, GncSettings, GncStop};
pub use inliers::{InlierSelection, InlierStart, select_added, select_consistent, select_inliers};

use crate::factor::Between;
use crate::problem::Problem;

/// The 99 % quantile of χ² with three degrees of freedom.
pub const LOOP_CHI2: f64 = 11.345;

/// Whether a measurement is between consecutive poses, as odometry is.
#[must_use]
pub fn is_sequential(factor: &Between) -> bool {
    factor.from.abs_diff(factor.to) == 1
}

/// The same poses with only the measurements for whose index `keep` is true.
#[must_use]
pub fn with_factors(problem: &Problem, mut keep: impl FnMut(usize) -> bool) -> Problem {
    let mut kept = without_factors(problem);
    for (index, factor) in problem.factors().iter().enumerate() {
        if keep(index) {
            kept.add_factor(*factor);
        }
    }
    kept
}

/// The same poses without measurements.
fn without_factors(problem: &Problem) -> Problem {
    let mut bare = Problem::new();
    for (pose, fixed) in problem.poses().iter().zip(problem.fixed()) {
        if *fixed {
            bare.add_fixed_pose(*pose);
        } else {
            bare.add_pose(*pose);
        }
    }
    bare
}

#[cfg(test)]
mod tests;
