//! Gauss–Newton and Levenberg–Marquardt over a [`Problem`], one iteration at a time.
//!
//! One iteration linearizes every factor, solves `(H + λD) δ = −g` with `D = diag H` by sparse
//! Cholesky factorization, and moves every free pose by `T ← T exp(δ)`. Gauss–Newton is λ = 0 and
//! takes every step. Levenberg–Marquardt raises λ until the cost does not rise.
//!
//! The cost has no factor ½, so with `g = JᵀΩe` and `H = JᵀΩJ` its quadratic model is
//! `cost + 2 gᵀδ + δᵀHδ`. The step has `δᵀHδ = −gᵀδ − λ δᵀDδ`. The model so promises a decrease of
//! `−gᵀδ + λ δᵀDδ`, against which the damping schedule measures what a step won.
//!
//! Full Gauss–Newton steps may climb. A whole run never ends above its start: see [`Optimizer::run`].
//!
//! Source: Nocedal & Wright, "Numerical Optimization", 2006, chapter 10.

mod covariances;
mod held_factor;

use nalgebra::Vector3;
use pr_geom::{SE2, twist_size};

use crate::best::BestPoses;
use crate::damping::{DAMPING_LIMIT, Damping};
use crate::error::OptimizeError;
use crate::factor::PreparedPose;
use crate::growth::Growth;
use crate::linear::{Factorization, LinearSolver};
use crate::problem::Problem;
use crate::report::{Report, StepReport, StopReason};
use crate::settings::{FactorUse, Method, Settings};
use crate::structure::Structure;
use crate::system::NormalEquations;
use held_factor::HeldFactor;

/// A solver with its workspace, which is kept from one solve to the next.
///
/// Ordering and symbolic analysis are made again only where the graph itself has changed.
#[derive(Debug, Default)]
pub struct Optimizer {
    /// May be changed between iterations; a damping begins anew with [`restart`](Self::restart).
    pub settings: Settings,
    linear: Option<LinearSolver>,
    /// Says what `linear` holds the factor of, where that is good for covariances.
    growth: Option<Growth>,
    equations: NormalEquations,
    delta: Vec<f64>,
    trial: Vec<SE2>,
    schedule: Damping,
    /// What the last accepted step promised, times `1 + λ`; 0 before the first.
    last_promise: f64,
    /// Whether `linear` holds a factor of this solve that is good for the next step.
    held: HeldFactor,
    /// Where the steps came from, as far as they led uphill.
    best: BestPoses,
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

    /// Forgets how the last solve went, its damping above all; the analysis is kept.
    pub fn restart(&mut self) {
        self.schedule = match self.settings.method {
            Method::GaussNewton => Damping::default(),
            Method::LevenbergMarquardt { initial_damping } => Damping::new(initial_damping),
        };
        self.last_promise = 0.0;
        self.held.forget();
        self.best.forget();
    }

    /// λ of the next step. Gauss–Newton has none, also where the last steps were damped ones.
    fn damping(&self) -> f64 {
        match self.settings.method {
            Method::GaussNewton => 0.0,
            Method::LevenbergMarquardt { .. } => self.schedule.value(),
        }
    }

    /// One iteration: linearize, solve, move.
    ///
    /// # Errors
    /// Where the normal equations are not positive definite or not finite; the poses stay.
    pub fn step(&mut self, problem: &mut Problem) -> Result<StepReport, OptimizeError> {
        self.linearize(problem)?;
        self.solve_linearized(problem)
    }

    /// The first half of a step: adds up the normal equations, and so knows the cost.
    fn linearize(&mut self, problem: &Problem) -> Result<f64, OptimizeError> {
        let settings = self.settings;
        self.analyse(problem, settings.factorization);
        let linear = self.linear.as_ref().expect("it was analysed");
        let structure = linear.structure();
        let (jacobians, kernel) = (settings.jacobians, settings.kernel);
        if self.held.is_held() {
            self.equations
                .assemble_gradient(problem, structure, jacobians, kernel);
        } else {
            self.equations
                .assemble(problem, structure, jacobians, kernel, settings.ridge);
        }
        let (cost, chi2) = (self.equations.cost, self.equations.chi2);
        let is_finite = cost.is_finite() && chi2.is_finite();
        // A kernel's cost can look fine where χ² is infinite.
        let known = if is_finite { cost } else { f64::NAN };
        self.best.arrived(known, &self.trial);
        if is_finite {
            Ok(cost)
        } else {
            Err(OptimizeError::NotFinite)
        }
    }

    /// The second half: solves the normal equations that were added up at the present poses, and moves.
    fn solve_linearized(&mut self, problem: &mut Problem) -> Result<StepReport, OptimizeError> {
        let damping = self.damping();
        let settings = &self.settings;
        let (cost, chi2) = (self.equations.cost, self.equations.chi2);
        let linear = self
            .linear
            .as_mut()
            .expect("the graph was analysed for the equations");
        if !self.held.is_held() {
            linear.factorize(&self.equations, damping)?;
        }
        self.delta.clear();
        self.delta
            .extend(self.equations.gradient.iter().map(|g| -g));
        linear.solve(&mut self.delta);
        let mut predicted_decrease = -dot(&self.equations.gradient, &self.delta);
        if damping > 0.0 {
            predicted_decrease += damping * self.equations.diagonal_square(&self.delta);
        }
        let largest_step = move_poses(
            self.equations.prepared_poses(),
            linear.structure(),
            &self.delta,
            &mut self.trial,
        );
        if !largest_step.is_finite() {
            return Err(OptimizeError::NotFinite);
        }
        let accepted = match settings.method {
            Method::GaussNewton => true,
            Method::LevenbergMarquardt { .. } => {
                let trial_cost = self
                    .equations
                    .cost_at(problem, &self.trial, settings.kernel);
                self.schedule.update(cost - trial_cost, predicted_decrease)
            }
        };
        let is_plain = settings.method == Method::GaussNewton;
        if is_plain && settings.factor_use == FactorUse::WhileItShrinks {
            self.held.stepped(largest_step);
        } else {
            self.held.forget();
        }
        self.best.left(cost, accepted);
        if accepted {
            // From now on `trial` holds where this step came from.
            problem.swap_poses(&mut self.trial);
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

    /// Iterates from the present poses until a stop rule of the [`Settings`] is met.
    ///
    /// The cost at the end is finite and not above that at the start, where that is finite. Steps
    /// that climb beyond it, and steps that climb and do not converge, are taken back:
    /// [`Report::went_back_to`] says how far. Where not even the first step can be computed, the
    /// poses stay and the report holds the error.
    pub fn run(&mut self, problem: &mut Problem) -> Report {
        self.restart();
        let mut steps = Vec::new();
        let stop = loop {
            if let Some(stop) = self.advance(problem, &mut steps) {
                break stop;
            }
        };
        self.final_report(problem, steps, stop)
    }

    /// The report on steps that ended for that reason, with the poses that [`run`](Self::run)
    /// promises in `problem`.
    pub(crate) fn final_report(
        &mut self,
        problem: &mut Problem,
        steps: Vec<StepReport>,
        stop: StopReason,
    ) -> Report {
        let kernel = self.settings.kernel;
        let mut report = Report::new(steps, problem, kernel, stop);
        self.best.arrived(report.cost_or_nan(), &self.trial);
        if report.ended_well() {
            return report;
        }
        if let Some((step, poses)) = self.best.cheaper_than(report.cost_or_nan()) {
            problem.poses_mut().copy_from_slice(poses);
            report = Report::new(report.steps, problem, kernel, stop);
            report.went_back_to = Some(step);
        }
        report
    }

    /// One iteration, whose report is added to `steps`; the reason to stop, if there is one.
    pub fn advance(
        &mut self,
        problem: &mut Problem,
        steps: &mut Vec<StepReport>,
    ) -> Option<StopReason> {
        self.advance_unless(problem, steps, |_, _| None)
    }

    /// The same, unless `give_up` has a reason to stop: it sees the steps so far, and the cost that
    /// the last of them led to, before a system is solved there.
    pub(crate) fn advance_unless(
        &mut self,
        problem: &mut Problem,
        steps: &mut Vec<StepReport>,
        give_up: impl FnOnce(&[StepReport], f64) -> Option<StopReason>,
    ) -> Option<StopReason> {
        let limit = self.settings.max_iterations;
        if steps.len() >= limit {
            return Some(StopReason::IterationLimit { limit });
        }
        let step = match self.linearize(problem) {
            Ok(cost) => match give_up(steps, cost) {
                Some(stop) => return Some(stop),
                None => self.solve_linearized(problem),
            },
            Err(error) => Err(error),
        };
        match step {
            Ok(step) => {
                steps.push(step);
                self.stop_after(&step)
            }
            Err(error) => Some(StopReason::Failed { error }),
        }
    }

    fn stop_after(&mut self, step: &StepReport) -> Option<StopReason> {
        let converged = if step.accepted {
            self.convergence_at(step)
        } else {
            None
        };
        converged.or_else(|| {
            let damping = self.damping();
            (damping > DAMPING_LIMIT).then_some(StopReason::DampingLimit {
                damping,
                limit: DAMPING_LIMIT,
            })
        })
    }

    /// The convergence test that an accepted step meets, if there is one; see [`Settings`].
    fn convergence_at(&mut self, step: &StepReport) -> Option<StopReason> {
        let settings = &self.settings;
        let undamped = 1.0 + step.damping;
        let expected = self.held.expected_size();
        let size = expected.unwrap_or(undamped * step.largest_step);
        let promise = undamped * step.predicted_decrease;
        let before = core::mem::replace(&mut self.last_promise, promise);
        let remaining = if step.cost_before > 0.0 {
            promise * (promise / before).min(1.0) / step.cost_before
        } else {
            0.0
        };
        if size < settings.step_tolerance {
            Some(StopReason::SmallStep {
                step: size,
                tolerance: settings.step_tolerance,
            })
        } else if remaining < settings.decrease_tolerance {
            Some(StopReason::SmallDecrease {
                decrease: remaining,
                tolerance: settings.decrease_tolerance,
            })
        } else {
            None
        }
    }

    /// The linear solver that the settings name for the graph of `problem`, analysed if need be.
    pub fn linear_for(&mut self, problem: &Problem) -> &mut LinearSolver {
        self.held.lose();
        self.analyse(problem, self.settings.factorization)
    }

    /// The linear solver for that graph, made anew where the graph or the factorization has changed.
    fn analyse(&mut self, problem: &Problem, factorization: Factorization) -> &mut LinearSolver {
        self.growth = None;
        let fits = |linear: &LinearSolver| linear.fits(problem, factorization);
        if !self.linear.as_ref().is_some_and(fits) {
            self.held.lose();
            let old = self.linear.take();
            self.linear = Some(LinearSolver::renewed(problem, factorization, old));
        }
        self.linear.as_mut().expect("it was analysed")
    }

    /// `Σ ρ(eᵀΩe)` at other poses of the same graph, with the kernel of the settings.
    pub fn cost_at(&mut self, problem: &Problem, poses: &[SE2]) -> f64 {
        self.equations.cost_at(problem, poses, self.settings.kernel)
    }
}

/// Writes `T exp(δ)` of every pose to `moved`; returns the largest `‖(v_x, v_y)‖ + |ω|`.
fn move_poses(
    poses: &[PreparedPose],
    structure: &Structure,
    delta: &[f64],
    moved: &mut Vec<SE2>,
) -> f64 {
    let mut largest: f64 = 0.0;
    moved.clear();
    for (pose, &position) in poses.iter().zip(&structure.position_of) {
        let k = 3 * position as usize;
        let step = Vector3::new(delta[k], delta[k + 1], delta[k + 2]);
        let size = twist_size(&step);
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
