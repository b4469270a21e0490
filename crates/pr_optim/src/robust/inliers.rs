//! Which loops to select_inliers, from more than one start.

use pr_geom::{SE2, math};

use super::along_path::{Direction, select_along_path};
use super::consistency::{ConsistencySettings, consistent_set};
use super::gnc::{Gnc, GncLoss, GncSettings};
use super::refutation::{MarginalGate, Standing};
use super::with_factors;
use crate::error::OptimizeError;
use crate::optimizer::Optimizer;
use crate::problem::Problem;
use crate::report::StopReason;
use crate::settings::Settings;

/// Largest number of times that loops change sides after a start.
const CHANGES: usize = 40;

/// Loops that gain at least this share of the largest gain change sides together; the next share once
/// that did not lower the cost, and at last one loop alone.
const BARS: [f64; 4] = [0.0, 0.5, 0.8, 1.0];

/// A loop whose absence lowers χ² by this share of what its absence costs is nearly refuted.
const NEARLY: f64 = 0.25;

/// Largest number of loops nearly refuted that are left out in earnest.
const TRIALS: usize = 8;

/// Where a selection came from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum InlierStart {
    /// Loops taken along the way, from its first pose on.
    Forwards,
    /// Loops taken along the way, from its last pose back.
    Backwards,
    /// Graduated non-convexity from where the trusted measurements lead.
    GraduatedNonConvexity,
    /// The loops that agree with each other in pairs.
    PairwiseConsistency,
}

/// Which measurements are inliers, and where they lead.
#[derive(Clone, Debug, PartialEq)]
pub struct InlierSelection {
    /// Whether each measurement is inliers; the trusted ones are.
    pub inliers: Vec<bool>,
    /// The poses at the least-squares optimum of those.
    pub poses: Vec<SE2>,
    /// χ² of what is inliers, and `max_chi2` for every loop that is not.
    pub cost: f64,
    /// The start that led there.
    pub start: InlierStart,
    /// Rounds of graduated non-convexity, none where it was not needed.
    pub rounds: usize,
}

/// Finds a set of loops of low truncated cost `Σ min(eᵀΩe, max_chi2)`.
///
/// Loops are taken along the way by their marginal gate, once from each end, and each selection is
/// settled: a loop that the inliers ones refute by the exact covariance is dropped, one that they do
/// not refute is taken in, as long as the cost falls. Where both ways lead
/// to the same selection, and it keeps more loops than it drops, that is the result. Else [`Gnc`] looks
/// from where the trusted measurements lead, is settled too, and the lowest cost wins.
///
/// So every loop of the result passes the gate of all others, unless the cost could not fall further.
/// A set of false loops that agree with each other better than the right ones stays out of its reach.
///
/// # Errors
/// Where no start leads to normal equations that can be solved, and to a finite cost.
///
/// # Panics
/// Where `trusted` has not as many entries as there are measurements.
pub fn select_inliers(
    problem: &Problem,
    trusted: &[bool],
    solver: Settings,
    settings: &GncSettings,
) -> Result<InlierSelection, OptimizeError> {
    let search = Search::new(problem, trusted, solver, settings.max_chi2);
    let all = vec![true; trusted.len()];
    let ways = [
        (Direction::Forwards, InlierStart::Forwards),
        (Direction::Backwards, InlierStart::Backwards),
    ]
    .map(|(direction, start)| search.along(&all, direction, start));
    if let [Some(first), Some(second)] = &ways
        && first.inliers == second.inliers
        && search.keeps_most(first)
    {
        return Ok(first.clone());
    }
    let third = search.graduated(settings);
    let [first, second] = ways.map(|way| way.ok_or(OptimizeError::NotFinite));
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

/// The same with loops that agree with each other in pairs for candidates: see [`consistent_set`].
///
/// Along a long way the path's covariance lets false loops agree with right ones. So what agrees joins along
/// the way, from either end, by the exact covariance of what is inliers by then, and is settled: right
/// loops that a clique left out come in. The lower cost wins.
///
/// # Errors
/// Where the trusted measurements do not tie every pose to the next, or neither way leads to a finite
/// cost.
///
/// # Panics
/// Where `trusted` has not as many entries as there are measurements.
pub fn select_consistent(
    problem: &Problem,
    trusted: &[bool],
    solver: Settings,
    settings: &ConsistencySettings,
) -> Result<InlierSelection, OptimizeError> {
    let search = Search::new(problem, trusted, solver, settings.max_chi2);
    let agreeing = consistent_set(problem, settings);
    let ways = [Direction::Forwards, Direction::Backwards].map(|direction| {
        let way = search.along(&agreeing, direction, InlierStart::PairwiseConsistency);
        way.ok_or(OptimizeError::NotFinite)
    });
    cheapest(ways)
}

/// By how much the cost falls where a loop changes sides, to first order.
#[derive(Clone, Copy, Debug)]
struct Gain {
    value: f64,
    /// Whether the covariance tells; else the value is the least that it may be.
    is_sure: bool,
}

struct Search<'a> {
    problem: &'a Problem,
    trusted: &'a [bool],
    solver: Settings,
    max_chi2: f64,
}

impl<'a> Search<'a> {
    fn new(problem: &'a Problem, trusted: &'a [bool], solver: Settings, max_chi2: f64) -> Self {
        assert_eq!(trusted.len(), problem.factors().len());
        Self {
            problem,
            trusted,
            solver,
            max_chi2,
        }
    }

    /// The selection along the way; none where there is no such way, or it cannot be solved.
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
        // The way stands where the first fixed pose holds it.
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

    /// Lets loops change sides as long as the cost falls: first all that should, then
    /// fewer, and at last one at a time.
    fn improved(
        &self,
        poses: Vec<SE2>,
        inliers: Vec<bool>,
        start: InlierStart,
    ) -> Result<InlierSelection, OptimizeError> {
        let mut optimizer = Optimizer::new(self.solver);
        let mut best = self.solved(&mut optimizer, &poses, inliers, start)?;
        let mut bars = BARS.into_iter();
        let mut bar = bars.next().unwrap_or(1.0);
        for _ in 0..CHANGES {
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
                // What is refuted may be so by another that is refuted more.
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

    /// A selection of lower cost without one of the loops that are nearly refuted, or of which the covariance
    /// tells nothing.
    ///
    /// A false loop may bend a weak part of the graph so far that first order does not refute it.
    fn without_one(
        &self,
        optimizer: &mut Optimizer,
        selection: &InlierSelection,
        gains: &[Gain],
    ) -> Result<Option<InlierSelection>, OptimizeError> {
        let is_nearly = |gain: &Gain| !gain.is_sure || gain.value > (NEARLY - 1.0) * self.max_chi2;
        let mut nearly: Vec<usize> = (0..gains.len())
            .filter(|&k| !self.trusted[k] && selection.inliers[k] && is_nearly(&gains[k]))
            .collect();
        let value = |k: usize| gains[k].value;
        nearly.sort_by(|&a, &b| value(b).total_cmp(&value(a)).then(a.cmp(&b)));
        for &k in nearly.iter().take(TRIALS) {
            let mut inliers = selection.inliers.clone();
            inliers[k] = false;
            let next = self.solved(optimizer, &selection.poses, inliers, selection.start)?;
            if next.cost < selection.cost {
                return Ok(Some(next));
            }
        }
        Ok(None)
    }

    /// By how much the cost falls where a loop changes sides; −∞ for trusted ones, and for a dropped one of
    /// which that is not known.
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
                // (Ω⁻¹ − Σ′)⁻¹ is at least Ω: what is less, or no number, is a difference lost in rounding.
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

    /// The least-squares optimum of what is inliers.
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
