//! A way and its loops, inliers one stretch after the other, as a robot meets them.

use pr_geom::SE2;

use super::path::{Path, variance_share};
use super::refutation::{MarginalGate, Standing};
use super::with_factors;
use crate::error::OptimizeError;
use crate::factor::Between;
use crate::optimizer::Optimizer;
use crate::problem::Problem;
use crate::report::StopReason;
use crate::settings::Settings;

/// The way is taken in so many stretches.
const STRETCHES: usize = 100;

/// Steps of the solver after the loops of a stretch were taken.
const STEPS: usize = 3;

/// Where the loops lead that are inliers in the order of the way.
#[derive(Clone, Debug)]
pub struct PathInliers {
    /// The poses, in the frame of the first.
    pub poses: Vec<SE2>,
    /// Which measurements were inliers, the trusted ones among them.
    pub inliers: Vec<bool>,
}

/// Which end of the way comes first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// From the first pose on.
    Forwards,
    /// From the last pose back.
    Backwards,
}

/// Goes along the way and believes the loops that fit what is known by then.
///
/// A loop fits where its residual passes the gate `eᵀ(Σ + Ω⁻¹)⁻¹e ≤ v max_chi2`: Σ is the exact
/// covariance of the relative pose by the way so far and the loops inliers on it, v the share of
/// its stated variance that the noise of loops over short ways has, at most 1. Measurements often
/// state too much noise. Then the gate of what is stated lets false loops in.
/// After the solve a loop has to fit by its own information as well. Only loops marked in `candidates` join.
///
/// `None` where the trusted measurements do not tie every pose to the next.
///
/// # Errors
/// Where the normal equations of a stretch cannot be solved.
pub fn select_along_path(
    problem: &Problem,
    trusted: &[bool],
    candidates: &[bool],
    direction: Direction,
    solver: Settings,
    max_chi2: f64,
) -> Result<Option<PathInliers>, OptimizeError> {
    if direction == Direction::Backwards {
        let grown = select_along_path(
            &turned(problem),
            trusted,
            candidates,
            Direction::Forwards,
            solver,
            max_chi2,
        )?;
        return Ok(grown.map(|mut grown| {
            grown.poses.reverse();
            grown
        }));
    }
    let Some(path) = Path::new(&with_factors(problem, |k| trusted[k])) else {
        return Ok(None);
    };
    let mut doubted: Vec<usize> = (0..trusted.len())
        .filter(|&k| candidates[k] && !trusted[k])
        .collect();
    doubted.sort_by_key(|&k| (later_end(&problem.factors()[k]), k));
    let mut growth = PathSelection {
        problem,
        path: &path,
        inliers: trusted.to_vec(),
        poses: vec![SE2::identity()],
        optimizer: Optimizer::new(Settings {
            max_iterations: STEPS,
            ..solver
        }),
        max_chi2: max_chi2 * variance_share(problem, trusted, &path),
    };
    let stretch = problem.node_count().div_ceil(STRETCHES);
    let mut rest = doubted.as_slice();
    while let Some(first) = rest.first() {
        let end = (later_end(&problem.factors()[*first]) / stretch + 1) * stretch;
        let in_stretch = |&k: &usize| later_end(&problem.factors()[k]) < end;
        let (now, later) = rest.split_at(rest.partition_point(in_stretch));
        growth.take(now, end.min(problem.node_count()))?;
        rest = later;
    }
    growth.extend(problem.node_count());
    Ok(Some(PathInliers {
        poses: growth.poses,
        inliers: growth.inliers,
    }))
}

fn later_end(factor: &Between) -> usize {
    factor.from.max(factor.to)
}

/// The same graph with its poses in the opposite order, none of them fixed.
fn turned(problem: &Problem) -> Problem {
    let mut turned = Problem::new();
    for pose in problem.poses().iter().rev() {
        turned.add_pose(*pose);
    }
    let last = problem.node_count().saturating_sub(1);
    for factor in problem.factors() {
        turned.add_factor(Between {
            from: last - factor.from,
            to: last - factor.to,
            ..*factor
        });
    }
    turned
}

struct PathSelection<'a> {
    problem: &'a Problem,
    path: &'a Path,
    inliers: Vec<bool>,
    /// Of the way so far.
    poses: Vec<SE2>,
    optimizer: Optimizer,
    max_chi2: f64,
}

impl PathSelection<'_> {
    /// Believes those of `loops`, which end before pose `end`, that fit.
    fn take(&mut self, loops: &[usize], end: usize) -> Result<(), OptimizeError> {
        self.extend(end);
        let graph = self.so_far(end);
        let mut gate = MarginalGate::new(&mut self.optimizer, &graph)?;
        let mut fitting = Vec::new();
        for &k in loops {
            let chi2 = gate.chi2(&self.problem.factors()[k], Standing::Dropped);
            // Also where it is no number.
            if chi2 <= self.max_chi2 {
                fitting.push(k);
            }
        }
        while !fitting.is_empty() {
            loops.iter().for_each(|&k| self.inliers[k] = false);
            fitting.iter().for_each(|&k| self.inliers[k] = true);
            let mut graph = self.so_far(end);
            let report = self.optimizer.run(&mut graph);
            if let StopReason::Failed { error } = report.stop {
                return Err(error);
            }
            self.poses.copy_from_slice(graph.poses());
            let before = fitting.len();
            fitting.retain(|&k| self.problem.factor_chi2_at(k, &self.poses) <= self.max_chi2);
            if fitting.len() == before {
                return Ok(());
            }
        }
        loops.iter().for_each(|&k| self.inliers[k] = false);
        Ok(())
    }

    /// The poses that follow, up to `end`, by the path.
    fn extend(&mut self, end: usize) {
        let path = self.path.poses();
        for k in self.poses.len()..end {
            let last = self.poses[k - 1];
            self.poses.push(last * path[k - 1].between(&path[k]));
        }
    }

    /// The poses so far with what is inliers between them; the first is fixed.
    fn so_far(&self, end: usize) -> Problem {
        let mut graph = Problem::new();
        for pose in &self.poses[..end] {
            graph.add_pose(*pose);
        }
        graph.fix(0);
        for (factor, inliers) in self.problem.factors().iter().zip(&self.inliers) {
            if *inliers && later_end(factor) < end {
                graph.add_factor(*factor);
            }
        }
        graph
    }
}
