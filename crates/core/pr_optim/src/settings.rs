//! Settings of an [`Optimizer`](crate::Optimizer) and its stop rules.

use crate::factor::JacobianModel;
use crate::kernel::RobustKernel;

/// Computation of a step from the linearized problem.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub enum Method {
    /// Full steps, even if they raise the cost.
    #[default]
    GaussNewton,
    /// Damped steps; a step that raises the cost is rejected.
    LevenbergMarquardt {
        /// First damping, relative to the diagonal of H; at least 0.
        initial_damping: f64,
    },
}

/// Which factor of the normal equations solves a Gauss–Newton step.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum FactorUse {
    /// A new one at the poses where the step starts.
    #[default]
    EveryStep,
    /// The factor of an earlier step of the same solve, once steps are short and while each is much shorter than
    /// the one before: the gradient determines the result, and the factor only the speed.
    ///
    /// This is the chord method of Kelley, "Iterative Methods for Linear and Nonlinear Equations", 1995,
    /// section 5.4.
    WhileStepsShrink,
}

/// Settings of a solve and its stop rules.
///
/// Only an accepted step can end a solve as converged, and not because damping made it small: both tests below
/// multiply it by `1 + λ`. Without damping that is the step itself; for strong damping `(1 + λ) δ` tends to
/// `−D⁻¹g`, the gradient in the scale of `D = diag H`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Gauss–Newton or Levenberg–Marquardt.
    pub method: Method,
    /// The chapter's Jacobians or the exact ones.
    pub jacobians: JacobianModel,
    /// Robust kernel of the factors.
    pub kernel: RobustKernel,
    /// Largest number of linear systems solved; for a [`SolveSession`](crate::SolveSession), in one attempt.
    pub max_iterations: usize,
    /// Stop if `1 + λ` times the largest `‖(v_x, v_y)‖ + |ω|` over the nodes, metres and radians
    /// added, falls below this; 0 never stops.
    ///
    /// With [`FactorUse::WhileStepsShrink`] the steps shrink by about a constant factor, and the test applies to
    /// the expected next step.
    pub step_tolerance: f64,
    /// Stop if the estimated remaining decrease falls below this share of the cost; 0 never stops.
    ///
    /// The model predicts a decrease `p` for every step. Near the optimum the predictions shrink by at least a
    /// constant factor, so about `p²/p'` remains after a step with prediction `p` if that of the accepted step
    /// before was `p'`. No further step is needed to confirm that one was the last.
    pub decrease_tolerance: f64,
    /// Added to every diagonal entry of H, 1/m² and 1/rad²: keeps H invertible if the measurements leave a
    /// direction unconstrained.
    pub ridge: f64,
    /// How often Gauss–Newton factorizes; damped steps always do.
    pub factor_use: FactorUse,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            method: Method::GaussNewton,
            jacobians: JacobianModel::Chapter,
            kernel: RobustKernel::None,
            max_iterations: 25,
            step_tolerance: 1e-6,
            decrease_tolerance: 0.0,
            ridge: 1e-9,
            factor_use: FactorUse::EveryStep,
        }
    }
}
