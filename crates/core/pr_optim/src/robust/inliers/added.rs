//! Selection of inlier loops after loops were added to a solved graph.

use super::{InlierSelection, InlierStart, Search, cheapest};
use crate::error::OptimizeError;
use crate::problem::Problem;
use crate::settings::Settings;

/// [`select_inliers`](super::select_inliers) after measurements were added to a solved graph, from its present poses.
///
/// The selection starts once with all loops and once without those added since the poses were solved
/// ([`Problem::optimized_factors`]); each is refined, and the lower cost wins. The second ends where it meets a selection
/// of the first, because both would continue alike. Following the path again, or removing nearly rejected loops for a
/// trial, takes solves of the whole graph that repeat what earlier selections found.
///
/// # Errors
/// If neither start leads to solvable normal equations and a finite cost.
///
/// # Panics
/// If `trusted` does not have one entry for each measurement.
pub fn select_added(
    problem: &Problem,
    trusted: &[bool],
    solver: Settings,
    max_chi2: f64,
) -> Result<InlierSelection, OptimizeError> {
    let search = Search {
        trials: 0,
        ..Search::new(problem, trusted, solver, max_chi2)
    };
    let solved = problem.optimized_factors();
    let starting = |is_added: bool| -> Vec<bool> {
        let starts_in = |k: usize| is_added || trusted[k] || k < solved;
        (0..trusted.len()).map(starts_in).collect()
    };
    let (poses, start) = (problem.poses(), InlierStart::PresentPoses);
    let mut passed: Vec<Vec<bool>> = Vec::new();
    let with_added = search.improved_until(poses.to_vec(), starting(true), start, |inliers| {
        passed.push(inliers.to_vec());
        false
    });
    let without = search.improved_until(poses.to_vec(), starting(false), start, |inliers| {
        passed.iter().any(|known| known == inliers)
    });
    cheapest([with_added, without])
}
