//! What a solve did, and why it stopped.

use crate::error::OptimizeError;
use crate::kernel::RobustKernel;
use crate::problem::Problem;

/// Why a solve stopped, with the value that was measured and the threshold.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum StopReason {
    /// An accepted step moved no node by as much as the tolerance, damping taken out.
    SmallStep {
        /// Largest `‖(v_x, v_y)‖ + |ω|` over the nodes, metres and radians added, times `1 + λ`.
        step: f64,
        /// Threshold that it fell below.
        tolerance: f64,
    },
    /// After an accepted step, less than this share of the cost is estimated to be left to win.
    SmallDecrease {
        /// Estimated decrease over cost; see [`Settings::decrease_tolerance`](crate::Settings).
        decrease: f64,
        /// Threshold that it fell below.
        tolerance: f64,
    },
    /// A step raised the cost, so that a [`Session`](crate::Session) gave up its cheap first guess.
    CostRose {
        /// Cost before the step.
        before: f64,
        /// Cost after it.
        after: f64,
    },
    /// The iterations ran out first.
    IterationLimit {
        /// How many were allowed.
        limit: usize,
    },
    /// Levenberg–Marquardt found no damping, up to this one, that lowers the cost.
    DampingLimit {
        /// The damping of the step that was not tried any more.
        damping: f64,
        /// The largest damping allowed.
        limit: f64,
    },
    /// A step could not be computed. The poses are those before it.
    Failed {
        /// What went wrong.
        error: OptimizeError,
    },
}

impl StopReason {
    /// Whether a convergence test was met.
    #[must_use]
    pub fn is_converged(&self) -> bool {
        matches!(self, Self::SmallStep { .. } | Self::SmallDecrease { .. })
    }
}

impl core::fmt::Display for StopReason {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::SmallStep { step, tolerance } => {
                write!(f, "step {step:.2e} below {tolerance:.2e}")
            }
            Self::SmallDecrease {
                decrease,
                tolerance,
            } => write!(f, "relative decrease {decrease:.2e} below {tolerance:.2e}"),
            Self::CostRose { before, after } => {
                write!(f, "the cost rose from {before:.6e} to {after:.6e}")
            }
            Self::IterationLimit { limit } => write!(f, "limit of {limit} iterations"),
            Self::DampingLimit { damping, limit } => {
                write!(f, "damping {damping:.2e} above {limit:.2e}")
            }
            Self::Failed { error } => write!(f, "{error}"),
        }
    }
}

/// What one iteration did.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepReport {
    /// χ² = Σ eᵀΩe at the poses where the step was computed, kernel not applied.
    pub chi2_before: f64,
    /// `Σ ρ(eᵀΩe)` there: χ² where there is no kernel.
    pub cost_before: f64,
    /// Largest `‖(v_x, v_y)‖ + |ω|` over the nodes.
    pub largest_step: f64,
    /// Decrease of the cost that the quadratic model promises: `−gᵀδ + λ δᵀDδ` with `D = diag H`.
    ///
    /// The cost has no factor ½, and `g` is half of its derivative.
    pub predicted_decrease: f64,
    /// Damping λ that the step was computed with; 0 for Gauss–Newton.
    pub damping: f64,
    /// Whether the step was taken. Levenberg–Marquardt refuses a step that raises the cost.
    pub accepted: bool,
}

/// What a whole solve did.
#[derive(Clone, Debug, PartialEq)]
pub struct Report {
    /// Linear systems solved.
    pub iterations: usize,
    /// χ² = Σ eᵀΩe where the first step was computed, kernel not applied.
    pub chi2_initial: f64,
    /// χ² at the end, kernel not applied.
    pub chi2: f64,
    /// `Σ ρ(eᵀΩe)` at the end, what the solver lowered: χ² where there is no kernel.
    pub cost: f64,
    /// Why the solve stopped.
    pub stop: StopReason,
    /// One entry per iteration.
    pub steps: Vec<StepReport>,
    /// The entry of `steps` at whose poses the solve ended after all, because the later ones climbed;
    /// `None` where it ended where the last step led.
    pub went_back_to: Option<usize>,
}

impl Report {
    /// A report on `steps` that ended at the present poses of `problem`.
    #[must_use]
    pub fn new(
        steps: Vec<StepReport>,
        problem: &Problem,
        kernel: RobustKernel,
        stop: StopReason,
    ) -> Self {
        let (cost, chi2) = problem.cost_and_chi2(kernel);
        Self {
            iterations: steps.len(),
            chi2_initial: steps.first().map_or(chi2, |step| step.chi2_before),
            chi2,
            cost,
            stop,
            steps,
            went_back_to: None,
        }
    }

    /// The cost at the end; not a number where it or χ² is out of the range of numbers.
    pub(crate) fn cost_or_nan(&self) -> f64 {
        if self.cost.is_finite() && self.chi2.is_finite() {
            self.cost
        } else {
            f64::NAN
        }
    }

    /// Whether the solve converged, and not above its start.
    pub(crate) fn ended_well(&self) -> bool {
        let start = self
            .steps
            .first()
            .map_or(self.cost, |step| step.cost_before);
        self.stop.is_converged() && self.cost_or_nan() <= start
    }
}
