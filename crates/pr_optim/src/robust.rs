//! Solving where some measurements are false: which ones to select_inliers, and the poses by those.
//!
//! A kernel judges every measurement by itself, from where the poses happen to be, and from a poor
//! guess it switches right ones off. Three methods look at more:
//!
//! - [`select_inliers`] takes loops along the way, as a robot meets them, and lets each stand or fall by what
//!   the exact covariance of all others says; where that is not clear it asks [`Gnc`] as well.
//! - [`Gnc`] begins with a cost that hardly discriminates and bends it step by step into one that
//!   keeps a measurement whole or drops it.
//! - [`consistent_set`] looks for the largest set of loops that agree with each other along the
//!   trusted path, before anything is solved; [`select_consistent`] begins there and lets each stand or
//!   fall as [`select_inliers`] does.
//!
//! All take the measurements between neighbours in time as true: [`is_sequential`]. What stands or
//! falls is the loops. None can tell a false loop that fits the rest from a right one.

mod along_path;
mod consistency;
mod gnc;
mod inliers;
mod path;
mod refutation;

pub use consistency::{ConsistencySettings, consistent_set};
pub use gnc::{Gnc, GncLoss, GncOutcome, GncRound, GncSettings, GncStop};
pub use inliers::{InlierSelection, InlierStart, select_consistent, select_inliers};

use crate::factor::Between;
use crate::problem::Problem;

/// The 99 % quantile of χ² with three degrees of freedom.
pub const LOOP_CHI2: f64 = 11.345;

/// Whether a measurement is between neighbours in time, such as odometry is.
#[must_use]
pub fn is_sequential(factor: &Between) -> bool {
    factor.from.abs_diff(factor.to) == 1
}

/// The same poses with only those measurements for which `keep` says so, by their indices.
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

/// The same poses without any measurement.
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
