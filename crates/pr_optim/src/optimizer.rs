//! Gauss–Newton and Levenberg–Marquardt over a [`Problem`], one iteration at a time.
//!
//! One iteration linearizes every factor, solves `(H + λ diag H) δ = −g` by sparse Cholesky
//! factorization, and moves every free pose by `T ← T exp(δ)`. Gauss–Newton is λ = 0 and takes
//! every step. Levenberg–Marquardt raises λ until the cost falls.
//!
//! Source: Nocedal & Wright, "Numerical Optimization", 2006, chapter 10; the damping schedule is
//! that of Nielsen, "Damping parameter in Marquardt's method", 1999.

use nalgebra::{Matrix3, Vector3};
use pr_geom::{SE2, math};

use crate::error::OptimizeError;
use crate::factor::JacobianModel;
use crate::kernel::RobustKernel;
use crate::linear::{Factorization, LinearSolver};
use crate::marginals::JointCovariance;
use crate::problem::Problem;
use crate::report::{Report, StepReport, StopReason};
use crate::structure::Structure;
use crate::system::NormalEquations;

/// How a step is made from the linearized problem.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub enum Method {
    /// Full steps, also where they raise the cost on the way.
    #[default]
    GaussNewton,
    /// Damped steps; none that raises the cost is taken.
    LevenbergMarquardt {
        /// First damping, relative to the diagonal of H.
        initial_damping: f64,
    },
}

/// Largest damping that Levenberg–Marquardt tries before it gives up.
const DAMPING_LIMIT: f64 = 1e12;

/// What to solve with, and when to stop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Gauss–Newton or Levenberg–Marquardt.
    pub method: Method,
    /// The chapter's Jacobians or the exact ones.
    pub jacobians: JacobianModel,
    /// Cost of a factor.
    pub kernel: RobustKernel,
    /// Largest number of linear systems solved.
    pub max_iterations: usize,
    /// Stop where the largest `‖(v_x, v_y)‖ + |ω|` over the nodes falls below this.
    pub step_tolerance: f64,
    /// Stop where less than this share of the cost is still to be won, by the estimate below;
    /// 0 never stops.
    ///
    /// The model promises a decrease `p` with every step. Near the optimum the promises shrink by
    /// the same factor or faster, so that about `p²/p'` is left after a step that promised `p`
    /// where the one before promised `p'`. A step so needs no other to confirm that it was the last.
    pub decrease_tolerance: f64,
    /// Added to every diagonal entry of H.
    pub ridge: f64,
    /// Which sparse Cholesky factorization to use.
    pub factorization: Factorization,
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
        }
    }
}

/// A solver with its workspace, which is kept from one solve to the next.
///
/// Ordering and symbolic analysis are made again only where the graph itself has changed.
#[derive(Debug, Default)]
pub struct Optimizer {
    /// May be changed between iterations.
    pub settings: Settings,
    linear: Option<LinearSolver>,
    equations: NormalEquations,
    delta: Vec<f64>,
    trial: Vec<SE2>,
    damping: f64,
    growth: f64,
    last_promise: f64,
}

impl Optimizer {
    /// A solver without any analysis yet.
    #[must_use]
    pub fn new(settings: Settings) -> Self {
        let mut optimizer = Self {
            settings,
            ..Self::default()
        };
        optimizer.restart();
        optimizer
    }

    /// Forgets the damping of the last solve, not the analysis.
    pub fn restart(&mut self) {
        self.damping = match self.settings.method {
            Method::GaussNewton => 0.0,
            Method::LevenbergMarquardt { initial_damping } => initial_damping,
        };
        self.growth = 2.0;
        self.last_promise = 0.0;
    }

    /// One iteration: linearize, solve, move.
    ///
    /// # Errors
    /// Where the normal equations are not positive definite or not finite; the poses stay.
    pub fn step(&mut self, problem: &mut Problem) -> Result<StepReport, OptimizeError> {
        let linear = analysed(&mut self.linear, problem, self.settings.factorization);
        let settings = &self.settings;
        self.equations.assemble(
            problem,
            linear.structure(),
            settings.jacobians,
            settings.kernel,
            settings.ridge,
        );
        let (cost, chi2) = (self.equations.cost, self.equations.chi2);
        if !cost.is_finite() {
            return Err(OptimizeError::NotFinite);
        }
        linear.factorize(&self.equations, self.damping)?;
        self.delta.clear();
        self.delta
            .extend(self.equations.gradient.iter().map(|g| -g));
        linear.solve(&mut self.delta);
        let predicted_decrease = -dot(&self.equations.gradient, &self.delta);
        let largest_step = move_poses(
            problem.poses(),
            linear.structure(),
            &self.delta,
            &mut self.trial,
        );
        if !largest_step.is_finite() {
            return Err(OptimizeError::NotFinite);
        }
        let damping = self.damping;
        let accepted = match settings.method {
            Method::GaussNewton => true,
            Method::LevenbergMarquardt { .. } => {
                let trial_cost = self
                    .equations
                    .cost_at(problem, &self.trial, settings.kernel);
                self.update_damping((cost - trial_cost) / predicted_decrease)
            }
        };
        if accepted {
            problem.poses_mut().copy_from_slice(&self.trial);
        }
        Ok(StepReport {
            chi2_before: chi2,
            cost_before: cost,
            largest_step,
            predicted_decrease,
            damping,
            accepted,
        })
    }

    /// Iterates until a stop rule of the settings is met.
    pub fn run(&mut self, problem: &mut Problem) -> Report {
        self.restart();
        let mut steps = Vec::new();
        let stop = loop {
            if let Some(stop) = self.advance(problem, &mut steps) {
                break stop;
            }
        };
        Report::new(steps, problem, self.settings.kernel, stop)
    }

    /// One iteration, whose report is added to `steps`; the reason to stop, if there is one.
    pub fn advance(
        &mut self,
        problem: &mut Problem,
        steps: &mut Vec<StepReport>,
    ) -> Option<StopReason> {
        let limit = self.settings.max_iterations;
        if steps.len() >= limit {
            return Some(StopReason::IterationLimit { limit });
        }
        match self.step(problem) {
            Ok(step) => {
                steps.push(step);
                self.stop_after(&step)
            }
            Err(error) => Some(StopReason::Failed { error }),
        }
    }

    fn stop_after(&mut self, step: &StepReport) -> Option<StopReason> {
        let settings = &self.settings;
        let promise = step.predicted_decrease;
        let before = core::mem::replace(&mut self.last_promise, promise);
        let remaining = if step.cost_before > 0.0 {
            promise * (promise / before).min(1.0) / step.cost_before
        } else {
            0.0
        };
        if step.largest_step < settings.step_tolerance {
            Some(StopReason::SmallStep {
                step: step.largest_step,
                tolerance: settings.step_tolerance,
            })
        } else if step.accepted && remaining < settings.decrease_tolerance {
            Some(StopReason::SmallDecrease {
                decrease: remaining,
                tolerance: settings.decrease_tolerance,
            })
        } else if self.damping > DAMPING_LIMIT {
            Some(StopReason::DampingLimit {
                damping: self.damping,
                limit: DAMPING_LIMIT,
            })
        } else {
            None
        }
    }

    /// Nielsen's rule: a good step lowers the damping smoothly, each bad one raises it faster.
    fn update_damping(&mut self, gain: f64) -> bool {
        if gain > 0.0 {
            let shortfall = 2.0 * gain - 1.0;
            self.damping *= (1.0 - shortfall * shortfall * shortfall).max(1.0 / 3.0);
            self.growth = 2.0;
            true
        } else {
            self.damping *= self.growth;
            self.growth *= 2.0;
            false
        }
    }

    /// The linear solver for the graph of `problem`, analysed if need be.
    pub fn linear_for(&mut self, problem: &Problem) -> &mut LinearSolver {
        analysed(&mut self.linear, problem, self.settings.factorization)
    }

    /// Covariance blocks of two nodes at the present poses, exact to first order.
    ///
    /// The measurements count unweighted by any kernel, with their exact Jacobians.
    ///
    /// # Errors
    /// Where the normal equations are not positive definite.
    pub fn joint_covariance(
        &mut self,
        problem: &Problem,
        first: usize,
        second: usize,
    ) -> Result<JointCovariance, OptimizeError> {
        self.factorize_plain(problem)?;
        Ok(self
            .linear_for(problem)
            .joint_covariance(problem, first, second))
    }

    /// Covariance block of every node at the present poses, exact to first order; zero for fixed ones.
    ///
    /// # Errors
    /// Where the normal equations are not positive definite.
    ///
    /// # Panics
    /// Where the factorization of the settings is not [`Factorization::Block`].
    pub fn marginals(&mut self, problem: &Problem) -> Result<Vec<Matrix3<f64>>, OptimizeError> {
        self.factorize_plain(problem)?;
        let marginals = self.linear_for(problem).marginals(problem);
        Ok(marginals.expect("the block factorization shows its factor"))
    }

    /// Factorizes H at the present poses without kernel or damping.
    fn factorize_plain(&mut self, problem: &Problem) -> Result<(), OptimizeError> {
        let linear = analysed(&mut self.linear, problem, self.settings.factorization);
        self.equations.assemble(
            problem,
            linear.structure(),
            JacobianModel::Exact,
            RobustKernel::None,
            self.settings.ridge,
        );
        linear.factorize(&self.equations, 0.0)
    }

    /// `Σ ρ(eᵀΩe)` at other poses of the same graph.
    pub fn cost_at(&mut self, problem: &Problem, poses: &[SE2]) -> f64 {
        self.equations
            .cost_at(problem, poses, self.settings.kernel)
    }
}

/// The solver in `slot`, made anew where the graph or the factorization has changed.
fn analysed<'a>(
    slot: &'a mut Option<LinearSolver>,
    problem: &Problem,
    factorization: Factorization,
) -> &'a mut LinearSolver {
    if !slot
        .as_ref()
        .is_some_and(|linear| linear.fits(problem, factorization))
    {
        *slot = None;
    }
    slot.get_or_insert_with(|| LinearSolver::new(problem, factorization))
}

/// Writes `T exp(δ)` of every pose to `moved`; returns the largest `‖(v_x, v_y)‖ + |ω|`.
fn move_poses(poses: &[SE2], structure: &Structure, delta: &[f64], moved: &mut Vec<SE2>) -> f64 {
    let mut largest: f64 = 0.0;
    moved.clear();
    for (pose, &position) in poses.iter().zip(&structure.position_of) {
        let k = 3 * position as usize;
        let step = Vector3::new(delta[k], delta[k + 1], delta[k + 2]);
        let size = math::norm2(step.x, step.y) + step.z.abs();
        // `max` would drop a NaN.
        if size > largest || size.is_nan() {
            largest = size;
        }
        moved.push(pose.boxplus(&step));
    }
    largest
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
