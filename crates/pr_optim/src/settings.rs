//! What an [`Optimizer`](crate::Optimizer) solves with, and when it stops.

use crate::factor::JacobianModel;
use crate::kernel::RobustKernel;
use crate::linear::Factorization;

/// How a step is made from the linearized problem.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub enum Method {
    /// Full steps, also where they raise the cost on the way.
    #[default]
    GaussNewton,
    /// Damped steps; none that raises the cost is taken.
    LevenbergMarquardt {
        /// First damping, relative to the diagonal of H; at least 0.
        initial_damping: f64,
    },
}

/// Which factor of the normal equations solves a step of Gauss–Newton.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum FactorUse {
    /// One of its own, at the poses where the step begins.
    #[default]
    EveryStep,
    /// That of an earlier step of the same solve, once steps are short and as long as each is much shorter
    /// than the one before it: the gradient decides where a solve ends, and the factor only how fast.
    ///
    /// This is the chord method of Kelley, "Iterative Methods for Linear and Nonlinear Equations", 1995,
    /// section 5.4.
    WhileItShrinks,
}

/// What to solve with, and when to stop.
///
/// Only an accepted step can end a solve as converged, and not because damping made it small:
/// both tests below see it multiplied by `1 + λ`. Without damping that is the step itself, and
/// with much of it `(1 + λ) δ` tends to `−D⁻¹g`, the gradient in the scale of `D = diag H`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Gauss–Newton or Levenberg–Marquardt.
    pub method: Method,
    /// The chapter's Jacobians or the exact ones.
    pub jacobians: JacobianModel,
    /// Cost of a factor.
    pub kernel: RobustKernel,
    /// Largest number of linear systems solved; in a [`Session`](crate::Session), by one attempt.
    pub max_iterations: usize,
    /// Stop where `1 + λ` times the largest `‖(v_x, v_y)‖ + |ω|` over the nodes, metres and radians
    /// added, falls below this; 0 never stops.
    ///
    /// With [`FactorUse::WhileItShrinks`] a step that is shorter than the one before by some factor counts
    /// as the one that would follow it, which is shorter by that factor once more.
    pub step_tolerance: f64,
    /// Stop where less than this share of the cost is still to be won, by the estimate below;
    /// 0 never stops.
    ///
    /// The model promises a decrease `p` with every step. Near the optimum the promises shrink by
    /// the same factor or faster, so that about `p²/p'` is left after a step that promised `p`
    /// where the accepted one before promised `p'`. A step so needs no other to confirm that it was
    /// the last.
    pub decrease_tolerance: f64,
    /// Added to every diagonal entry of H, 1/m² and 1/rad²: keeps H invertible where a measurement
    /// says nothing about a direction.
    pub ridge: f64,
    /// Which sparse Cholesky factorization to use.
    pub factorization: Factorization,
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
            factorization: Factorization::Block,
            factor_use: FactorUse::EveryStep,
        }
    }
}
