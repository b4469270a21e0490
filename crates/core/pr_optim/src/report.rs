//! Results of a solve, and why it stopped.

use crate::error::OptimizeError;
use crate::kernel::RobustKernel;
use crate::problem::Problem;

/// Why a solve stopped, with the measured value and the threshold.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum StopReason {
    /// An accepted step, corrected for damping, moved no node by as much as the tolerance.
    SmallStep {
        /// Largest `‖(v_x, v_y)‖ + |ω|` over the nodes, metres and radians added, times `1 + λ`.
        step: f64,
        /// The threshold.
        tolerance: f64,
    },
    /// After an accepted step, the estimated remaining decrease is below this share of the cost.
    SmallDecrease {
        /// Estimated decrease over cost; see [`Settings::decrease_tolerance`](crate::Settings).
        decrease: f64,
        /// The threshold.
        tolerance: f64,
    },
    /// A step raised the cost, and a [`SolveSession`](crate::SolveSession) has another start to try.
    CostRose {
        /// Cost before the step.
        before: f64,
        /// Cost after it.
        after: f64,
    },
    /// The gain ratio of the first step is too low: a [`SolveSession`](crate::SolveSession) tries another start.
    LowGainRatio {
        /// Decrease of the cost by the linear model.
        predicted: f64,
        /// Actual decrease of the cost.
        actual: f64,
    },
    /// By a step with a good gain ratio, this attempt of a [`SolveSession`](crate::SolveSession) cannot end below an
    /// earlier one.
    CannotImprove {
        /// Cost at the minimum of the linear model.
        predicted: f64,
        /// Cost at which an earlier attempt converged.
        best: f64,
    },
    /// The limit of iterations was reached.
    IterationLimit {
        /// Allowed number of iterations.
        limit: usize,
    },
    /// Levenberg–Marquardt found no damping up to the limit that lowers the cost.
    DampingLimit {
        /// The damping of the step that was no longer tried.
        damping: f64,
        /// The largest damping allowed.
        limit: f64,
    },
    /// A step could not be computed. The poses are those before it.
    Failed {
        /// The error.
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
            Self::LowGainRatio { predicted, actual } => {
                write!(
                    f,
                    "the first step lowered the cost by {actual:.6e} instead of the predicted {predicted:.6e}"
                )
            }
            Self::CannotImprove { predicted, best } => {
                write!(
                    f,
                    "its predicted cost {predicted:.6e} is not below the best one, {best:.6e}"
                )
            }
            Self::IterationLimit { limit } => write!(f, "limit of {limit} iterations"),
            Self::DampingLimit { damping, limit } => {
                write!(f, "damping {damping:.2e} above {limit:.2e}")
            }
            Self::Failed { error } => write!(f, "{error}"),
        }
    }
}

/// Result of one iteration.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct StepReport {
    /// χ² = Σ eᵀΩe at the poses where the step was computed, kernel not applied.
    pub chi2_before: f64,
    /// `Σ ρ(eᵀΩe)` there; equals χ² without a kernel.
    pub cost_before: f64,
    /// Largest `‖(v_x, v_y)‖ + |ω|` over the nodes.
    pub largest_step: f64,
    /// Decrease of the cost predicted by the quadratic model: `−gᵀδ + λ δᵀDδ` with `D = diag H`.
    ///
    /// The cost has no factor ½, and `g` is half of its derivative.
    pub predicted_decrease: f64,
    /// Damping λ that the step was computed with; 0 for Gauss–Newton.
    pub damping: f64,
    /// Whether the step was accepted. Levenberg–Marquardt rejects a step that raises the cost.
    pub accepted: bool,
}

/// Result of a whole solve.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Report {
    /// Linear systems solved.
    pub iterations: usize,
    /// χ² = Σ eᵀΩe at the start, kernel not applied.
    pub chi2_initial: f64,
    /// χ² at the end, kernel not applied.
    pub chi2: f64,
    /// `Σ ρ(eᵀΩe)` at the end, the minimized cost; equals χ² without a kernel.
    pub cost: f64,
    /// Why the solve stopped.
    pub stop: StopReason,
    /// One entry per iteration.
    pub steps: Vec<StepReport>,
    /// Index in `steps` of the step before which the solve ended, because later steps raised the cost;
    /// `None` if it ended after the last step.
    pub reverted_to: Option<usize>,
}

impl Report {
    /// Reports on `steps` that ended at the present poses of `problem`.
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
            reverted_to: None,
        }
    }

    /// The cost at the end; NaN if it or χ² overflowed.
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
