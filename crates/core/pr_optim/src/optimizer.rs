//! Gauss–Newton and Levenberg–Marquardt over a [`Problem`], one iteration at a time.
//!
//! One iteration linearizes every factor, solves `(H + λD) δ = −g` with `D = diag H` by sparse
//! Cholesky factorization, and moves every free pose by `T ← T exp(δ)`. Gauss–Newton has λ = 0 and
//! accepts every step. Levenberg–Marquardt raises λ until the cost does not rise.
//!
//! The cost has no factor ½, so with `g = JᵀΩe` and `H = JᵀΩJ` its quadratic model is `cost + 2 gᵀδ + δᵀHδ`. The
//! step has `δᵀHδ = −gᵀδ − λ δᵀDδ`. The model therefore predicts a decrease of `−gᵀδ + λ δᵀDδ`, and the damping
//! schedule compares the actual decrease with it.
//!
//! Full Gauss–Newton steps may raise the cost. A whole run never ends above its start: see [`Optimizer::run`].
//!
//! Source: Nocedal & Wright, "Numerical Optimization", 2006, chapter 10.

mod covariances;
mod factor_reuse;

use nalgebra::Vector3;
use pr_geom::{SE2, twist_size};

use crate::best::BestPoses;
use crate::damping::{DAMPING_LIMIT, Damping};
use crate::error::OptimizeError;
use crate::factor::PreparedPose;
use crate::incremental::IncrementalCovariances;
use crate::linear::LinearSolver;
use crate::problem::Problem;
use crate::report::{Report, StepReport, StopReason};
use crate::settings::{FactorUse, Method, Settings};
use crate::structure::Structure;
use crate::system::NormalEquations;
use factor_reuse::FactorReuse;

/// A solver and its workspace, which persists between solves.
///
/// Ordering and symbolic analysis are repeated only if the graph has changed.
#[derive(Debug, Default)]
pub struct Optimizer {
    /// May be changed between iterations; [`restart`](Self::restart) resets the damping.
    pub settings: Settings,
    linear: Option<LinearSolver>,
    /// Covariances for which `linear` holds the factor, if it is usable for them.
    covariances: Option<IncrementalCovariances>,
    equations: NormalEquations,
    delta: Vec<f64>,
    trial: Vec<SE2>,
    schedule: Damping,
    /// Decrease predicted for the last accepted step, times `1 + λ`; 0 before the first.
    last_predicted: f64,
    /// Whether `linear` holds a factor of this solve that the next step can use.
    factor_reuse: FactorReuse,
    /// The lowest-cost poses before steps that raised the cost.
    best: BestPoses,
}

impl Optimizer {
    /// A solver without a symbolic analysis yet.
    #[must_use]
    pub fn new(settings: Settings) -> Self {
        let mut optimizer = Self {
            settings,
            ..Self::default()
        };
        optimizer.restart();
        optimizer
    }

    /// Resets the state of the last solve, such as its damping; keeps the analysis.
    pub fn restart(&mut self) {
        self.schedule = match self.settings.method {
            Method::GaussNewton => Damping::default(),
            Method::LevenbergMarquardt { initial_damping } => Damping::new(initial_damping),
        };
        self.last_predicted = 0.0;
        self.factor_reuse.reset();
        self.best.reset();
    }

    /// λ of the next step; 0 for Gauss–Newton, even after damped steps.
    fn damping(&self) -> f64 {
        match self.settings.method {
            Method::GaussNewton => 0.0,
            Method::LevenbergMarquardt { .. } => self.schedule.value(),
        }
    }

    /// One iteration: linearize, solve, move.
    ///
    /// # Errors
    /// If the normal equations are not positive definite or not finite; the poses are unchanged.
    pub fn step(&mut self, problem: &mut Problem) -> Result<StepReport, OptimizeError> {
        self.linearize(problem)?;
        self.solve_linearized(problem)
    }

    /// The first half of a step: assembles the normal equations and returns the cost.
    fn linearize(&mut self, problem: &Problem) -> Result<f64, OptimizeError> {
        let settings = self.settings;
        self.analyse(problem);
        let linear = self.linear.as_ref().expect("it was analysed");
        let structure = linear.structure();
        let (jacobians, kernel) = (settings.jacobians, settings.kernel);
        if self.factor_reuse.is_reused() {
            self.equations
                .assemble_gradient(problem, structure, jacobians, kernel);
        } else {
            self.equations
                .assemble(problem, structure, jacobians, kernel, settings.ridge);
        }
        let (cost, chi2) = (self.equations.cost, self.equations.chi2);
        let is_finite = cost.is_finite() && chi2.is_finite();
        // A kernel's cost can be finite although χ² is not.
        let known = if is_finite { cost } else { f64::NAN };
        self.best.record_arrival(known, &self.trial);
        if is_finite {
            Ok(cost)
        } else {
            Err(OptimizeError::NotFinite)
        }
    }

    /// The second half: solves the assembled normal equations and moves the poses.
    fn solve_linearized(&mut self, problem: &mut Problem) -> Result<StepReport, OptimizeError> {
        let damping = self.damping();
        let settings = &self.settings;
        let (cost, chi2) = (self.equations.cost, self.equations.chi2);
        let linear = self
            .linear
            .as_mut()
            .expect("the graph was analysed for the equations");
        if !self.factor_reuse.is_reused() {
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
        if is_plain && settings.factor_use == FactorUse::WhileStepsShrink {
            self.factor_reuse.record_step(largest_step);
        } else {
            self.factor_reuse.reset();
        }
        self.best.record_step(cost, accepted);
        if accepted {
            // From now on `trial` holds the poses before this step.
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
    /// If the cost at the start is finite, the cost at the end is finite and not above it. Steps that climb above
    /// the start, and steps that climb and do not converge, are reverted; see [`Report::reverted_to`]. If not even
    /// the first step can be computed, the poses are unchanged and the report holds the error.
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

    /// Reports on steps that ended for this reason, and restores the poses that [`run`](Self::run)
    /// guarantees.
    pub(crate) fn final_report(
        &mut self,
        problem: &mut Problem,
        steps: Vec<StepReport>,
        stop: StopReason,
    ) -> Report {
        let kernel = self.settings.kernel;
        let mut report = Report::new(steps, problem, kernel, stop);
        self.best.record_arrival(report.cost_or_nan(), &self.trial);
        if report.ended_well() {
            return report;
        }
        if let Some((step, poses)) = self.best.cheaper_than(report.cost_or_nan()) {
            problem.poses_mut().copy_from_slice(poses);
            report = Report::new(report.steps, problem, kernel, stop);
            report.reverted_to = Some(step);
        }
        report
    }

    /// Runs one iteration and appends its report to `steps`; returns the reason to stop, if any.
    pub fn advance(
        &mut self,
        problem: &mut Problem,
        steps: &mut Vec<StepReport>,
    ) -> Option<StopReason> {
        self.advance_unless(problem, steps, |_, _| None)
    }

    /// [`advance`](Self::advance), unless `give_up` returns a reason to stop. It receives the steps so far and the
    /// cost after the last one, before a system is solved there.
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

    /// The convergence test that an accepted step meets, if any; see [`Settings`].
    fn convergence_at(&mut self, step: &StepReport) -> Option<StopReason> {
        let settings = &self.settings;
        let undamped = 1.0 + step.damping;
        let expected = self.factor_reuse.expected_size();
        let size = expected.unwrap_or(undamped * step.largest_step);
        let predicted = undamped * step.predicted_decrease;
        let before = core::mem::replace(&mut self.last_predicted, predicted);
        let remaining = if step.cost_before > 0.0 {
            predicted * (predicted / before).min(1.0) / step.cost_before
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

    /// The linear solver for the graph of `problem`, analysed if necessary.
    pub fn linear_for(&mut self, problem: &Problem) -> &mut LinearSolver {
        self.factor_reuse.invalidate();
        self.analyse(problem)
    }

    /// The linear solver for this graph, rebuilt if the graph has changed.
    fn analyse(&mut self, problem: &Problem) -> &mut LinearSolver {
        self.covariances = None;
        let fits = |linear: &LinearSolver| linear.fits(problem);
        if !self.linear.as_ref().is_some_and(fits) {
            self.factor_reuse.invalidate();
            let old = self.linear.take();
            self.linear = Some(LinearSolver::renewed(problem, old));
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
        // `max` would ignore a NaN.
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
