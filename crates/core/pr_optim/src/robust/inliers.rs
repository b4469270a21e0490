//! Selection of inlier loops, from more than one start.

mod added;
#[cfg(test)]
mod tests;

use pr_geom::{SE2, math, order_by};

pub use added::select_added;

use super::along_path::{Direction, select_along_path};
use super::consistency::{ConsistencySettings, consistent_set};
use super::gnc::{Gnc, GncLoss, GncSettings};
use super::marginal_gate::{MarginalGate, Standing};
use super::with_factors;
use crate::error::OptimizeError;
use crate::optimizer::Optimizer;
use crate::problem::Problem;
use crate::report::StopReason;
use crate::settings::Settings;

/// Largest number of changes of the inlier set after a start.
const CHANGES: usize = 40;

/// Loops whose gain is at least this share of the largest are flipped together; the next share applies if that did
/// not lower the cost, and finally only one loop is flipped.
const BARS: [f64; 4] = [0.0, 0.5, 0.8, 1.0];

/// A loop is nearly rejected if removing it lowers χ² by this share of the cost of an outlier.
const NEARLY: f64 = 0.25;

/// [`Search::trials`] of a graph that was never solved.
const TRIALS: usize = 8;

/// Start of a selection.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum InlierStart {
    /// Loops accepted along the path, from its first pose on.
    Forwards,
    /// Loops accepted along the path, from its last pose back.
    Backwards,
    /// Graduated non-convexity from the solution of the trusted measurements.
    GraduatedNonConvexity,
    /// The pairwise consistent loops.
    PairwiseConsistency,
    /// The present poses of a solved graph.
    PresentPoses,
}

/// The selected inliers and their solution.
#[derive(Clone, Debug, PartialEq)]
pub struct InlierSelection {
    /// Whether each measurement is an inlier; the trusted ones are.
    pub inliers: Vec<bool>,
    /// The poses at the least-squares optimum of those.
    pub poses: Vec<SE2>,
    /// χ² of the inliers, plus `max_chi2` for every outlier.
    pub cost: f64,
    /// The start of this selection.
    pub start: InlierStart,
    /// Rounds of graduated non-convexity; 0 if it was not needed.
    pub rounds: usize,
}

/// Finds a set of loops of low truncated cost `Σ min(eᵀΩe, max_chi2)`.
///
/// Loops are accepted along the path by their marginal gate, once from each end. Each selection is then refined:
/// an inlier that the others reject by the exact covariance is dropped, and an outlier that they do not reject is
/// added, as long as the cost falls. If both directions give the same selection, and it keeps more loops than it
/// drops, that is the result. Otherwise [`Gnc`] starts from the solution of the trusted measurements, its result
/// is refined too, and the lowest cost wins.
///
/// Every loop of the result therefore passes the gate of all others, unless the cost could not be lowered further.
/// It cannot reject false loops that agree with each other better than the true ones.
///
/// # Errors
/// If no start leads to solvable normal equations and a finite cost.
///
/// # Panics
/// If `trusted` does not have one entry for each measurement.
pub fn select_inliers(
    problem: &Problem,
    trusted: &[bool],
    solver: Settings,
    settings: &GncSettings,
) -> Result<InlierSelection, OptimizeError> {
    let search = Search::new(problem, trusted, solver, settings.max_chi2);
    let all = vec![true; trusted.len()];
    let selections = [
        (Direction::Forwards, InlierStart::Forwards),
        (Direction::Backwards, InlierStart::Backwards),
    ]
    .map(|(direction, start)| search.along(&all, direction, start));
    if let [Some(first), Some(second)] = &selections
        && first.inliers == second.inliers
        && search.keeps_most(first)
    {
        return Ok(first.clone());
    }
    let third = search.graduated(settings);
    let [first, second] = selections.map(|selection| selection.ok_or(OptimizeError::NotFinite));
    cheapest([first, second, third])
}

/// The selection of lowest cost, the first of equals.
fn cheapest(
    selections: impl IntoIterator<Item = Result<InlierSelection, OptimizeError>>,
) -> Result<InlierSelection, OptimizeError> {
    let mut best: Option<InlierSelection> = None;
    let mut failure = OptimizeError::NotFinite;
    for selection in selections {
        match selection {
            Ok(selection) if best.as_ref().is_none_or(|best| selection.cost < best.cost) => {
                best = Some(selection);
            }
            Ok(_) => {}
            Err(error) => failure = error,
        }
    }
    best.ok_or(failure)
}

/// [`select_inliers`] with the pairwise consistent loops as candidates: see [`consistent_set`].
///
/// The covariance of a long path lets false loops be consistent with true ones. The consistent loops are therefore
/// accepted along the path, from either end, by the exact covariance of the inliers so far. The refinement then
/// also adds true loops that the clique left out. The lower cost wins.
///
/// # Errors
/// If the trusted measurements do not connect every pose to the next, or neither direction leads to a finite
/// cost.
///
/// # Panics
/// If `trusted` does not have one entry for each measurement.
pub fn select_consistent(
    problem: &Problem,
    trusted: &[bool],
    solver: Settings,
    settings: &ConsistencySettings,
) -> Result<InlierSelection, OptimizeError> {
    let search = Search::new(problem, trusted, solver, settings.max_chi2);
    let agreeing = consistent_set(problem, settings);
    let selections = [Direction::Forwards, Direction::Backwards].map(|direction| {
        let selection = search.along(&agreeing, direction, InlierStart::PairwiseConsistency);
        selection.ok_or(OptimizeError::NotFinite)
    });
    cheapest(selections)
}

/// Decrease of the cost if a loop is flipped between inlier and outlier, to first order.
#[derive(Clone, Copy, Debug)]
struct Gain {
    value: f64,
    /// Whether the covariance determines the value; otherwise the value is a lower bound.
    is_sure: bool,
}

struct Search<'a> {
    problem: &'a Problem,
    trusted: &'a [bool],
    solver: Settings,
    max_chi2: f64,
    /// Largest number of nearly rejected loops that are removed for a trial.
    trials: usize,
}

impl<'a> Search<'a> {
    fn new(problem: &'a Problem, trusted: &'a [bool], solver: Settings, max_chi2: f64) -> Self {
        assert_eq!(trusted.len(), problem.factors().len());
        Self {
            problem,
            trusted,
            solver,
            max_chi2,
            trials: TRIALS,
        }
    }

    /// The selection along the path; `None` if there is no such path, or if it cannot be solved.
    fn along(
        &self,
        candidates: &[bool],
        direction: Direction,
        start: InlierStart,
    ) -> Option<InlierSelection> {
        let grown = select_along_path(
            self.problem,
            self.trusted,
            candidates,
            direction,
            self.solver,
            self.max_chi2,
        );
        let grown = grown.ok()??;
        // The path is placed at the first fixed pose.
        let fixed = self.problem.fixed();
        let held = fixed.iter().position(|fixed| *fixed)?;
        let given = self.problem.poses();
        let moved = given[held] * grown.poses[held].inverse();
        let poses = (0..given.len()).map(|node| {
            if fixed[node] {
                given[node]
            } else {
                moved * grown.poses[node]
            }
        });
        self.improved(poses.collect(), grown.inliers, start).ok()
    }

    fn graduated(&self, settings: &GncSettings) -> Result<InlierSelection, OptimizeError> {
        let mut problem = self.problem.clone();
        let settings = GncSettings {
            loss: GncLoss::TruncatedLeastSquares,
            ..*settings
        };
        let gnc = Gnc::new(self.problem, self.trusted.to_vec(), self.solver, settings);
        let outcome = gnc.run(&mut problem)?;
        let inliers = (0..self.trusted.len())
            .map(|k| outcome.is_inlier(k))
            .collect();
        let mut selection = self.improved(
            problem.poses().to_vec(),
            inliers,
            InlierStart::GraduatedNonConvexity,
        )?;
        selection.rounds = outcome.rounds;
        Ok(selection)
    }

    fn keeps_most(&self, selection: &InlierSelection) -> bool {
        let doubted = self.trusted.iter().filter(|trusted| !**trusted).count();
        let dropped = selection
            .inliers
            .iter()
            .filter(|inliers| !**inliers)
            .count();
        2 * dropped < doubted || doubted == 0
    }

    /// Flips loops between inlier and outlier as long as the cost falls: first all with a positive gain, then
    /// fewer, and finally one at a time.
    fn improved(
        &self,
        poses: Vec<SE2>,
        inliers: Vec<bool>,
        start: InlierStart,
    ) -> Result<InlierSelection, OptimizeError> {
        self.improved_until(poses, inliers, start, |_| false)
    }

    /// [`improved`](Self::improved), up to the first selection that `is_enough`.
    fn improved_until(
        &self,
        poses: Vec<SE2>,
        inliers: Vec<bool>,
        start: InlierStart,
        mut is_enough: impl FnMut(&[bool]) -> bool,
    ) -> Result<InlierSelection, OptimizeError> {
        let mut optimizer = Optimizer::new(self.solver);
        let mut best = self.solved(&mut optimizer, &poses, inliers, start)?;
        let mut bars = BARS.into_iter();
        let mut bar = bars.next().unwrap_or(1.0);
        for _ in 0..CHANGES {
            if is_enough(&best.inliers) {
                break;
            }
            let gains = self.gains(&mut optimizer, &best)?;
            let largest = gains.iter().map(|gain| gain.value).fold(0.0, math::max);
            if largest <= 0.0 {
                match self.without_one(&mut optimizer, &best, &gains)? {
                    Some(next) => best = next,
                    None => break,
                }
                continue;
            }
            let mut inliers = best.inliers.clone();
            for (inliers, gain) in inliers.iter_mut().zip(&gains) {
                // An inlier may appear wrong only because of another that is worse.
                let bar = if *inliers { math::max(bar, 0.5) } else { bar };
                if gain.value > 0.0 && gain.value >= bar * largest {
                    *inliers = !*inliers;
                }
            }
            match self.solved(&mut optimizer, &best.poses, inliers, start) {
                Ok(next) if next.cost < best.cost => best = next,
                _ => match bars.next() {
                    Some(higher) => bar = higher,
                    None => break,
                },
            }
        }
        Ok(best)
    }

    /// A selection of lower cost without one of the nearly rejected loops, or of those whose gain is
    /// uncertain.
    ///
    /// A false loop may bend a weakly constrained part of the graph so far that first order does not reject
    /// it.
    fn without_one(
        &self,
        optimizer: &mut Optimizer,
        selection: &InlierSelection,
        gains: &[Gain],
    ) -> Result<Option<InlierSelection>, OptimizeError> {
        let is_nearly = |gain: &Gain| !gain.is_sure || gain.value > (NEARLY - 1.0) * self.max_chi2;
        let nearly = order_by(gains.len(), &|k| -gains[k].value)
            .into_iter()
            .filter(|&k| !self.trusted[k] && selection.inliers[k] && is_nearly(&gains[k]));
        for k in nearly.take(self.trials) {
            let mut inliers = selection.inliers.clone();
            inliers[k] = false;
            let next = self.solved(optimizer, &selection.poses, inliers, selection.start)?;
            if next.cost < selection.cost {
                return Ok(Some(next));
            }
        }
        Ok(None)
    }

    /// Gain of flipping each loop; −∞ for trusted measurements, and for an outlier whose gain is unknown.
    fn gains(
        &self,
        optimizer: &mut Optimizer,
        selection: &InlierSelection,
    ) -> Result<Vec<Gain>, OptimizeError> {
        let graph = self.with_inliers(&selection.poses, &selection.inliers);
        let mut gate = MarginalGate::new(optimizer, &graph)?;
        let mut kept = gate.all_kept().into_iter();
        let mut gains = Vec::with_capacity(self.trusted.len());
        for (k, factor) in self.problem.factors().iter().enumerate() {
            let mut gain = Gain {
                value: f64::NEG_INFINITY,
                is_sure: true,
            };
            if selection.inliers[k] {
                let chi2 = kept.next().unwrap_or(f64::NAN);
                // (Ω⁻¹ − Σ′)⁻¹ is at least Ω: a smaller value, or NaN, is due to rounding.
                let least = self.problem.factor_chi2_at(k, &selection.poses);
                gain.is_sure = chi2 >= least;
                let chi2 = if gain.is_sure { chi2 } else { least };
                gain.value = chi2 - self.max_chi2;
            } else {
                let value = self.max_chi2 - gate.chi2(factor, Standing::Dropped);
                if !value.is_nan() {
                    gain.value = value;
                }
            }
            if self.trusted[k] {
                gain.value = f64::NEG_INFINITY;
            }
            gains.push(gain);
        }
        Ok(gains)
    }

    /// The least-squares optimum of the inliers.
    fn solved(
        &self,
        optimizer: &mut Optimizer,
        poses: &[SE2],
        inliers: Vec<bool>,
        start: InlierStart,
    ) -> Result<InlierSelection, OptimizeError> {
        let mut graph = self.with_inliers(poses, &inliers);
        let report = optimizer.run(&mut graph);
        if let StopReason::Failed { error } = report.stop {
            return Err(error);
        }
        let dropped = inliers.iter().filter(|inliers| !**inliers).count();
        let cost = report.chi2 + self.max_chi2 * dropped as f64;
        if !cost.is_finite() {
            return Err(OptimizeError::NotFinite);
        }
        Ok(InlierSelection {
            inliers,
            poses: graph.poses().to_vec(),
            cost,
            start,
            rounds: 0,
        })
    }

    fn with_inliers(&self, poses: &[SE2], inliers: &[bool]) -> Problem {
        let mut graph = with_factors(self.problem, |k| inliers[k]);
        graph.poses_mut().copy_from_slice(poses);
        graph
    }
}
