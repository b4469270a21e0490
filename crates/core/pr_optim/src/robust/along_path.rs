//! Selection of inlier loops along a path, one stretch after the other, as a robot meets them.

use pr_geom::{SE2, order_by};

use super::marginal_gate::{MarginalGate, Standing};
use super::path::{SequentialPath, variance_share};
use super::with_factors;
use crate::error::OptimizeError;
use crate::factor::Between;
use crate::optimizer::Optimizer;
use crate::problem::Problem;
use crate::report::StopReason;
use crate::settings::Settings;

/// Number of stretches of the path.
const STRETCHES: usize = 100;

/// Solver steps after the loops of a stretch were added.
const STEPS: usize = 3;

/// Result of a selection in the order of the path.
#[derive(Clone, Debug)]
pub struct PathInliers {
    /// The poses, in the frame of the first.
    pub poses: Vec<SE2>,
    /// Which measurements are inliers, including the trusted ones.
    pub inliers: Vec<bool>,
}

/// From which end the path is followed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// From the first pose on.
    Forwards,
    /// From the last pose back.
    Backwards,
}

/// Follows the path and accepts loops that are consistent with everything accepted before.
///
/// A loop is accepted if its residual passes the gate `eᵀ(Σ + Ω⁻¹)⁻¹e ≤ v max_chi2`. Σ is the exact covariance of
/// the relative pose by the path so far and the inlier loops on it. v, at most 1, is the ratio of actual to stated
/// variance, estimated from loops over short paths: many measurements overstate their noise, and the gate of the
/// stated noise would then accept false loops. After the solve a loop has to fit by its own information as well.
/// Only loops marked in `candidates` are tested.
///
/// `None` if the trusted measurements do not connect every pose to the next.
///
/// # Errors
/// If the normal equations of a stretch cannot be solved.
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
            &reversed(problem),
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
    let Some(path) = SequentialPath::new(&with_factors(problem, |k| trusted[k])) else {
        return Ok(None);
    };
    let mut doubted = order_by(trusted.len(), &|k| later_end(&problem.factors()[k]) as f64);
    doubted.retain(|&k| candidates[k] && !trusted[k]);
    let mut selection = PathSelection {
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
        selection.accept(now, end.min(problem.node_count()))?;
        rest = later;
    }
    selection.extend(problem.node_count());
    Ok(Some(PathInliers {
        poses: selection.poses,
        inliers: selection.inliers,
    }))
}

fn later_end(factor: &Between) -> usize {
    factor.from.max(factor.to)
}

/// The same graph with its poses in reverse order, none of them fixed.
fn reversed(problem: &Problem) -> Problem {
    let mut reversed = Problem::new();
    for pose in problem.poses().iter().rev() {
        reversed.add_pose(*pose);
    }
    let last = problem.node_count().saturating_sub(1);
    for factor in problem.factors() {
        reversed.add_factor(Between {
            from: last - factor.from,
            to: last - factor.to,
            ..*factor
        });
    }
    reversed
}

struct PathSelection<'a> {
    problem: &'a Problem,
    path: &'a SequentialPath,
    inliers: Vec<bool>,
    /// Poses of the path so far.
    poses: Vec<SE2>,
    optimizer: Optimizer,
    max_chi2: f64,
}

impl PathSelection<'_> {
    /// Accepts those of `loops`, which end before pose `end`, that are consistent.
    fn accept(&mut self, loops: &[usize], end: usize) -> Result<(), OptimizeError> {
        self.extend(end);
        let graph = self.so_far(end);
        let mut gate = MarginalGate::new(&mut self.optimizer, &graph)?;
        let mut fitting = Vec::new();
        for &k in loops {
            let chi2 = gate.chi2(&self.problem.factors()[k], Standing::Dropped);
            // False for NaN.
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

    /// Adds the following poses, up to `end`, by dead reckoning along the path.
    fn extend(&mut self, end: usize) {
        let path = self.path.poses();
        for k in self.poses.len()..end {
            let last = self.poses[k - 1];
            self.poses.push(last * path[k - 1].between(&path[k]));
        }
    }

    /// The poses so far with the inliers between them; the first is fixed.
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
