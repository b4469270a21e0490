//! Graduated non-convexity: the cost turns robust little by little.

use pr_geom::{SE2, math};

use super::{LOOP_CHI2, with_factors, without_factors};
use crate::error::OptimizeError;
use crate::factor::Between;
use crate::init::spanning_tree;
use crate::optimizer::Optimizer;
use crate::problem::Problem;
use crate::report::{Report, StopReason};
use crate::settings::Settings;

/// A measurement with at least this weight was inliers.
const INLIER_WEIGHT: f64 = 0.5;

/// Weights that changed by no more in a round of the final shape have settled.
const SETTLED: f64 = 0.01;

/// In the final shape of Geman–McClure a measurement of less weight is left out.
const WORTH_A_BLOCK: f64 = 1e-4;

/// The robust cost that [`Gnc`] ends with.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum GncLoss {
    /// `min(s, c²)`: a measurement counts whole or not at all.
    #[default]
    TruncatedLeastSquares,
    /// `c² s/(c² + s)`: one far out counts little.
    GemanMcClure,
}

/// How [`Gnc`] goes about it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GncSettings {
    /// Which cost is reached.
    pub loss: GncLoss,
    /// c²: the largest `eᵀΩe` of a measurement that is inliers.
    pub max_chi2: f64,
    /// Factor by which the control parameter μ changes from round to round, above 1.
    pub growth: f64,
    /// At most so many rounds.
    pub max_rounds: usize,
    /// Steps of the solver in a round; the next round starts where they end.
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
    /// Measurements that are inliers, the trusted ones among them.
    pub inliers: usize,
    /// Measurements whose weight is neither 0 nor 1 yet.
    pub undecided: usize,
}

/// Why the rounds ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GncStop {
    /// Every measurement is inliers or not.
    Decided,
    /// The cost has its final shape, and the weights have settled.
    FullShape,
    /// The limit of rounds.
    RoundLimit,
}

/// What [`Gnc`] found.
#[derive(Clone, Debug, PartialEq)]
pub struct GncOutcome {
    /// Weight of every measurement, 0 to 1.
    pub weights: Vec<f64>,
    /// Rounds made.
    pub rounds: usize,
    /// Why they ended.
    pub stop: GncStop,
    /// The last solve, with the measurements that are inliers.
    pub report: Report,
}

impl GncOutcome {
    /// Whether the measurement of that index is inliers.
    #[must_use]
    pub fn is_inlier(&self, factor: usize) -> bool {
        self.weights[factor] >= INLIER_WEIGHT
    }
}

/// A robust solve, a round at a time.
///
/// A round gives every measurement that is not trusted a weight by its `s = eᵀΩe` and the control
/// parameter μ, and takes a few steps of weighted least squares. With truncated least squares
/// (Yang, Antonante, Tzoumas, Carlone, "Graduated non-convexity for robust spatial perception",
/// RA-L 2020, eq. (14)) and `c²` the largest believable s,
///
/// ```text
/// w = 0 where s ≥ (μ + 1)/μ c²,   1 where s ≤ μ/(μ + 1) c²,   else c/√s √(μ(μ + 1)) − μ
/// ```
///
/// with μ from `c²/(2 s_max − c²)` upwards; with Geman–McClure (eq. (12)) `w = (μc²/(s + μc²))²` and
/// μ from `2 s_max/c²` down to 1. It starts at the poses to which the trusted measurements lead.
#[derive(Debug)]
pub struct Gnc {
    settings: GncSettings,
    optimizer: Optimizer,
    trusted: Vec<bool>,
    weights: Vec<f64>,
    /// The same graph with its informations weighted.
    weighted: Problem,
    mu: Option<f64>,
    /// Largest change of a weight in the last round.
    change: f64,
    rounds: usize,
}

impl Gnc {
    /// A solve of `problem` in which the measurements marked in `trusted` are never doubted.
    ///
    /// # Panics
    /// Where `trusted` has not as many entries as there are measurements.
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

    /// Begins at these poses, and with the final shape of the cost.
    ///
    /// # Panics
    /// Where there are not as many poses as in the graph.
    #[must_use]
    pub fn refining(mut self, poses: &[SE2]) -> Self {
        self.weighted.poses_mut().copy_from_slice(poses);
        self.mu = Some(match self.settings.loss {
            GncLoss::TruncatedLeastSquares => f64::INFINITY,
            GncLoss::GemanMcClure => 1.0,
        });
        self
    }

    /// One round; the reason to stop once there is nothing left to do.
    ///
    /// # Errors
    /// Where the weighted normal equations cannot be solved.
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
        // Exactly: far from the optimum every weight is small at first, and grows with μ.
        let is_undecided = |w: &&f64| **w > 0.0 && **w < 1.0;
        let round = GncRound {
            mu,
            inliers: self.weights.iter().filter(|w| **w >= INLIER_WEIGHT).count(),
            undecided: self.weights.iter().filter(is_undecided).count(),
        };
        Ok((round, self.stop_after(&round)))
    }

    /// All rounds, and then a solve with what is inliers; `problem` gets its poses.
    ///
    /// # Errors
    /// Where the weighted normal equations cannot be solved; the poses stay.
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

    /// The graph as it is being solved: the poses of the last round, informations weighted, without
    /// the measurements that count for nothing.
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
            // Where nothing is beyond c², the shape is final at once.
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
            GncLoss::GemanMcClure => round.mu <= 1.0 && self.change <= SETTLED,
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
        // What has no weight would only fill the factor: many false loops tie all to all.
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
