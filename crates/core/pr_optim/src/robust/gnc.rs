//! Graduated non-convexity: the cost becomes robust step by step.

use pr_geom::{SE2, math};

use super::{LOOP_CHI2, with_factors, without_factors};
use crate::error::OptimizeError;
use crate::factor::Between;
use crate::init::spanning_tree;
use crate::optimizer::Optimizer;
use crate::problem::Problem;
use crate::report::{Report, StopReason};
use crate::settings::Settings;

/// A measurement with at least this weight is an inlier.
const INLIER_WEIGHT: f64 = 0.5;

/// The weights have converged if none changed by more in a round of the final shape.
const MAX_WEIGHT_CHANGE: f64 = 0.01;

/// In the final shape of Geman–McClure a measurement of smaller weight is left out.
const WORTH_A_BLOCK: f64 = 1e-4;

/// The robust cost that [`Gnc`] ends with.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum GncLoss {
    /// `min(s, c²)`: a measurement counts fully or not at all.
    #[default]
    TruncatedLeastSquares,
    /// `c² s/(c² + s)`: the weight of a large residual is small.
    GemanMcClure,
}

/// Settings of [`Gnc`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GncSettings {
    /// The final cost.
    pub loss: GncLoss,
    /// c²: the largest `eᵀΩe` of an inlier.
    pub max_chi2: f64,
    /// Factor by which the control parameter μ changes from round to round, above 1.
    pub growth: f64,
    /// Largest number of rounds.
    pub max_rounds: usize,
    /// Solver steps in a round; the next round starts from their result.
    pub steps_in_round: usize,
}

impl Default for GncSettings {
    fn default() -> Self {
        Self {
            loss: GncLoss::TruncatedLeastSquares,
            max_chi2: LOOP_CHI2,
            growth: 1.4,
            max_rounds: 200,
            steps_in_round: 2,
        }
    }
}

/// One round of [`Gnc`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GncRound {
    /// The control parameter.
    pub mu: f64,
    /// Number of inliers, including the trusted ones.
    pub inliers: usize,
    /// Measurements whose weight is neither 0 nor 1 yet.
    pub undecided: usize,
}

/// Why the rounds ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum GncStop {
    /// Every measurement is either an inlier or an outlier.
    Decided,
    /// The cost has its final shape, and the weights have converged.
    FullShape,
    /// The limit of rounds was reached.
    RoundLimit,
}

impl core::fmt::Display for GncStop {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str(match self {
            Self::Decided => "every measurement is an inlier or an outlier",
            Self::FullShape => "the weights converged at the final shape of the cost",
            Self::RoundLimit => "limit of rounds",
        })
    }
}

/// Result of [`Gnc`].
#[derive(Clone, Debug, PartialEq)]
pub struct GncOutcome {
    /// Weight of every measurement, 0 to 1.
    pub weights: Vec<f64>,
    /// Number of rounds.
    pub rounds: usize,
    /// Why they ended.
    pub stop: GncStop,
    /// The last solve, with the inliers.
    pub report: Report,
}

impl GncOutcome {
    /// Whether the measurement of that index is an inlier.
    #[must_use]
    pub fn is_inlier(&self, factor: usize) -> bool {
        self.weights[factor] >= INLIER_WEIGHT
    }
}

/// A robust solve, one round at a time.
///
/// A round gives every measurement that is not trusted a weight by its `s = eᵀΩe` and the control
/// parameter μ, and takes a few steps of weighted least squares. For truncated least squares
/// (Yang, Antonante, Tzoumas, Carlone, "Graduated non-convexity for robust spatial perception",
/// RA-L 2020, eq. (14)) with `c²` the largest s of an inlier,
///
/// ```text
/// w = 0 if s ≥ (μ + 1)/μ c²,   1 if s ≤ μ/(μ + 1) c²,   else c/√s √(μ(μ + 1)) − μ
/// ```
///
/// with μ from `c²/(2 s_max − c²)` upwards; for Geman–McClure (eq. (12)) `w = (μc²/(s + μc²))²` and
/// μ from `2 s_max/c²` down to 1. It starts from the solution of the trusted measurements alone.
#[derive(Debug)]
pub struct Gnc {
    settings: GncSettings,
    optimizer: Optimizer,
    trusted: Vec<bool>,
    weights: Vec<f64>,
    /// The same graph with weighted information matrices.
    weighted: Problem,
    mu: Option<f64>,
    /// Largest change of a weight in the last round.
    change: f64,
    rounds: usize,
}

impl Gnc {
    /// A solve of `problem` in which the measurements marked in `trusted` are always inliers.
    ///
    /// # Panics
    /// If `trusted` does not have one entry for each measurement.
    #[must_use]
    pub fn new(
        problem: &Problem,
        trusted: Vec<bool>,
        solver: Settings,
        settings: GncSettings,
    ) -> Self {
        assert_eq!(trusted.len(), problem.factors().len());
        let mut weighted = problem.clone();
        let backbone = with_factors(problem, |index| trusted[index]);
        let start = spanning_tree(&backbone);
        weighted.poses_mut().copy_from_slice(&start);
        Self {
            settings,
            optimizer: Optimizer::new(solver),
            weights: vec![1.0; trusted.len()],
            trusted,
            weighted,
            mu: None,
            change: 0.0,
            rounds: 0,
        }
    }

    /// Starts at these poses, and with the final shape of the cost.
    ///
    /// # Panics
    /// If the number of poses is not that of the graph.
    #[must_use]
    pub fn refining(mut self, poses: &[SE2]) -> Self {
        self.weighted.poses_mut().copy_from_slice(poses);
        self.mu = Some(match self.settings.loss {
            GncLoss::TruncatedLeastSquares => f64::INFINITY,
            GncLoss::GemanMcClure => 1.0,
        });
        self
    }

    /// Runs one round; returns the reason to stop once finished.
    ///
    /// # Errors
    /// If the weighted normal equations cannot be solved.
    pub fn step(
        &mut self,
        problem: &Problem,
    ) -> Result<(GncRound, Option<GncStop>), OptimizeError> {
        let norms = self.squared_norms(problem);
        let mu = match self.mu {
            Some(mu) => self.changed(mu),
            None => self.first_mu(&norms),
        };
        self.mu = Some(mu);
        self.rounds += 1;
        self.change = 0.0;
        for (index, s) in norms.iter().enumerate() {
            if !self.trusted[index] {
                let weight = self.weight(*s, mu);
                self.change = math::max(self.change, (weight - self.weights[index]).abs());
                self.weights[index] = weight;
            }
        }
        self.solve(problem, self.settings.steps_in_round)?;
        // Compared exactly: far from the optimum every weight is small at first, and grows with μ.
        let is_undecided = |w: &&f64| **w > 0.0 && **w < 1.0;
        let round = GncRound {
            mu,
            inliers: self.weights.iter().filter(|w| **w >= INLIER_WEIGHT).count(),
            undecided: self.weights.iter().filter(is_undecided).count(),
        };
        Ok((round, self.stop_after(&round)))
    }

    /// Runs all rounds, then solves with the inliers; `problem` gets its poses.
    ///
    /// # Errors
    /// If the weighted normal equations cannot be solved; the poses are unchanged.
    pub fn run(mut self, problem: &mut Problem) -> Result<GncOutcome, OptimizeError> {
        let stop = loop {
            if let (_, Some(stop)) = self.step(problem)? {
                break stop;
            }
        };
        if self.settings.loss == GncLoss::TruncatedLeastSquares {
            for weight in &mut self.weights {
                *weight = f64::from(u8::from(*weight >= INLIER_WEIGHT));
            }
        }
        let limit = self.optimizer.settings.max_iterations;
        let report = self.solve(problem, limit)?;
        problem.poses_mut().copy_from_slice(self.weighted.poses());
        Ok(GncOutcome {
            weights: self.weights,
            rounds: self.rounds,
            stop,
            report,
        })
    }

    /// Weight of every measurement, 0 to 1, in the order of [`Problem::factors`].
    #[must_use]
    pub fn weights(&self) -> &[f64] {
        &self.weights
    }

    /// The graph of the current solve: poses of the last round, weighted information matrices, without
    /// measurements of zero weight.
    #[must_use]
    pub fn weighted(&self) -> &Problem {
        &self.weighted
    }

    /// `eᵀΩe` of every measurement at the present poses, unweighted.
    fn squared_norms(&self, problem: &Problem) -> Vec<f64> {
        problem.squared_norms_at(self.weighted.poses())
    }

    fn first_mu(&self, norms: &[f64]) -> f64 {
        let doubted = norms.iter().zip(&self.trusted);
        let largest = doubted
            .filter(|(_, trusted)| !**trusted)
            .map(|(s, _)| *s)
            .fold(0.0, f64::max);
        let c2 = self.settings.max_chi2;
        match self.settings.loss {
            // If no residual is beyond c², the shape is final at once.
            GncLoss::TruncatedLeastSquares if 2.0 * largest <= c2 => f64::INFINITY,
            GncLoss::TruncatedLeastSquares => c2 / (2.0 * largest - c2),
            GncLoss::GemanMcClure => math::max(2.0 * largest / c2, 1.0),
        }
    }

    fn changed(&self, mu: f64) -> f64 {
        match self.settings.loss {
            GncLoss::TruncatedLeastSquares => mu * self.settings.growth,
            GncLoss::GemanMcClure => math::max(mu / self.settings.growth, 1.0),
        }
    }

    fn weight(&self, s: f64, mu: f64) -> f64 {
        let c2 = self.settings.max_chi2;
        match self.settings.loss {
            GncLoss::TruncatedLeastSquares if mu == f64::INFINITY => f64::from(u8::from(s <= c2)),
            GncLoss::TruncatedLeastSquares if s >= (mu + 1.0) / mu * c2 => 0.0,
            GncLoss::TruncatedLeastSquares if s <= mu / (mu + 1.0) * c2 => 1.0,
            GncLoss::TruncatedLeastSquares => {
                (math::sqrt(c2 / s * mu * (mu + 1.0)) - mu).clamp(0.0, 1.0)
            }
            GncLoss::GemanMcClure => {
                let share = mu * c2 / (s + mu * c2);
                share * share
            }
        }
    }

    fn stop_after(&self, round: &GncRound) -> Option<GncStop> {
        let has_full_shape = match self.settings.loss {
            GncLoss::TruncatedLeastSquares => round.mu == f64::INFINITY,
            GncLoss::GemanMcClure => round.mu <= 1.0 && self.change <= MAX_WEIGHT_CHANGE,
        };
        if self.settings.loss == GncLoss::TruncatedLeastSquares && round.undecided == 0 {
            Some(GncStop::Decided)
        } else if has_full_shape {
            Some(GncStop::FullShape)
        } else if self.rounds >= self.settings.max_rounds {
            Some(GncStop::RoundLimit)
        } else {
            None
        }
    }

    fn solve(&mut self, problem: &Problem, steps: usize) -> Result<Report, OptimizeError> {
        let poses = self.weighted.poses().to_vec();
        self.weighted = without_factors(problem);
        self.weighted.poses_mut().copy_from_slice(&poses);
        // Measurements of zero weight would only cause fill-in: many false loops connect all nodes.
        let least = match (self.settings.loss, self.mu) {
            (GncLoss::GemanMcClure, Some(mu)) if mu <= 1.0 => WORTH_A_BLOCK,
            _ => 0.0,
        };
        let factors = problem.factors().iter().zip(&self.weights);
        for (factor, weight) in factors.filter(|(_, weight)| **weight > least) {
            self.weighted.add_factor(Between {
                information: factor.information * *weight,
                ..*factor
            });
        }
        let limit = self.optimizer.settings.max_iterations;
        self.optimizer.settings.max_iterations = steps;
        let report = self.optimizer.run(&mut self.weighted);
        self.optimizer.settings.max_iterations = limit;
        match report.stop {
            StopReason::Failed { error } => Err(error),
            _ => Ok(report),
        }
    }
}
