//! A solve from an initial guess to the optimum, with other guesses if the first fails.
//!
//! Gauss–Newton finds the minimum in whose basin of convergence it starts. [`Start::Auto`] takes the better of two
//! cheap guesses, the given poses and a spanning tree, and checks the gain ratio of its first step. If that is
//! low, the cost rises, the steps do not converge, or the heading residual of a measurement ends above
//! [`SUSPICIOUS_TURN_RAD`], the minimum is suspicious: the solve restarts from the chordal relaxation, unless that
//! costs more than the result so far. If that result is suspicious too, damped steps follow from there, provided
//! that full steps raised the cost or did not converge. An attempt is abandoned once it cannot end below an
//! earlier one. The best converged attempt is kept, unless it costs more than the given poses: then the best of
//! all. This is a heuristic, not a proof of a global optimum. [`SessionOutcome::tried`] lists all attempts.
//!
//! A robust kernel has many more local minima: from a poor guess it rejects true measurements. With one,
//! [`Start::Auto`] also solves the same graph without it, and from there again with it: with full steps, and with
//! damped ones if the cost rises. The lower robust cost is kept.

mod attempt;
mod guess;
mod watch;

use pr_geom::SE2;

pub use self::attempt::TriedStart;
use self::attempt::{Attempt, best_of};
use self::watch::Watch;
use crate::error::OptimizeError;
use crate::kernel::RobustKernel;
use crate::optimizer::Optimizer;
use crate::problem::Problem;
use crate::report::{Report, StepReport, StopReason};
use crate::settings::Method;

/// Smallest heading residual at a minimum that noise does not explain.
///
/// On seven recorded graphs the largest residual is 0.71 rad at the best known optimum, of the graph
/// with the worst headings, and at least 1.03 rad at every local minimum that was observed.
pub const SUSPICIOUS_TURN_RAD: f64 = 1.0;

/// First damping of the attempt with damped steps.
const FALLBACK_DAMPING: f64 = 1e-4;

/// Initial guess of a solve.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Start {
    /// The better of the given poses and the spanning tree. If that fails, the chordal relaxation, and then the
    /// relaxation with damped steps.
    #[default]
    Auto,
    /// The given poses.
    Given,
    /// Poses along a breadth-first tree of measurements from the fixed poses.
    SpanningTree,
    /// Headings and positions by two linear problems.
    Chordal,
    /// The least-squares solution without the robust kernel, itself started as by [`Start::Auto`].
    LeastSquares,
}

/// Result of a session.
#[derive(Clone, Debug, PartialEq)]
pub struct SessionOutcome {
    /// The solve that was kept.
    pub report: Report,
    /// Its initial guess, never [`Start::Auto`].
    pub start: Start,
    /// Linear systems solved by Gauss–Newton or Levenberg–Marquardt in all attempts.
    pub total_iterations: usize,
    /// Every guess that was considered, in this order.
    pub tried: Vec<TriedStart>,
}

/// Cost and start of a round. Without a kernel there is only the first round.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Round {
    /// The caller's cost, from guesses.
    Guess,
    /// Plain least squares without the caller's kernel, from guesses.
    LeastSquares,
    /// The caller's kernel, from the least-squares solution.
    Refine,
}

/// Progress of a round.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Stage {
    /// From a cheap guess, or from the caller's start.
    First,
    /// From the chordal relaxation, or from the first guess again if that costs less.
    Second,
    /// With damped steps.
    Damped,
}

/// A solve that runs step by step.
///
/// If dropped before [`finish`](Self::finish), it leaves the poses after the last step. In both cases the
/// optimizer gets its original method back.
#[derive(Debug)]
pub struct SolveSession<'a> {
    optimizer: &'a mut Optimizer,
    problem: &'a mut Problem,
    /// The caller's method. Later attempts use another; dropping restores it.
    method: Method,
    /// The caller's kernel; dropping restores it.
    kernel: RobustKernel,
    /// The given poses.
    given: Vec<SE2>,
    /// Cost of the given poses, if [`Start::Auto`] considered them as a guess.
    given_cost: Option<f64>,
    /// Where the refinement starts: the least-squares solution.
    origin: Vec<SE2>,
    round: Round,
    stage: Stage,
    automatic: bool,
    start: Start,
    tried: Vec<TriedStart>,
    steps: Vec<StepReport>,
    last_step: Option<StepReport>,
    /// The attempts of this round that have ended.
    ended: Vec<Attempt>,
    /// Attempts of earlier rounds that compete for the result.
    kept: Vec<Attempt>,
    total_iterations: usize,
    finished: bool,
}

impl<'a> SolveSession<'a> {
    /// Moves `problem` to its initial guess.
    ///
    /// # Errors
    /// If the requested start cannot be computed or is not finite; the poses are unchanged.
    pub fn new(
        optimizer: &'a mut Optimizer,
        problem: &'a mut Problem,
        start: Start,
    ) -> Result<Self, OptimizeError> {
        let (method, kernel) = (optimizer.settings.method, optimizer.settings.kernel);
        let is_robust = kernel != RobustKernel::None;
        let automatic = matches!(start, Start::Auto | Start::LeastSquares);
        let mut session = Self {
            method,
            kernel,
            given: problem.poses().to_vec(),
            given_cost: None,
            origin: Vec::new(),
            round: Round::Guess,
            stage: Stage::First,
            automatic,
            optimizer,
            problem,
            start,
            tried: Vec::new(),
            steps: Vec::new(),
            last_step: None,
            ended: Vec::new(),
            kept: Vec::new(),
            total_iterations: 0,
            finished: false,
        };
        match start {
            Start::LeastSquares if is_robust => session.begin_least_squares(),
            Start::Auto | Start::LeastSquares => session.start_cheaply(),
            _ => session.start_from(start)?,
        }
        Ok(session)
    }

    /// Runs one iteration; returns whether there is more to do.
    pub fn step(&mut self) -> bool {
        if self.finished {
            return false;
        }
        let done = self.steps.len();
        let watch = self.watch();
        let stop = self
            .optimizer
            .advance_unless(self.problem, &mut self.steps, |steps, cost| {
                watch.judge(steps, cost)
            });
        self.total_iterations += self.steps.len() - done;
        self.last_step = self.steps.last().copied();
        if let Some(stop) = stop {
            self.end_attempt(stop);
        }
        !self.finished
    }

    /// Report of the last iteration; `None` before the first.
    #[must_use]
    pub fn last_step(&self) -> Option<&StepReport> {
        self.last_step.as_ref()
    }

    /// Iterates to the end, and leaves the poses of the kept attempt in the problem.
    #[must_use]
    pub fn run(mut self) -> SessionOutcome {
        while self.step() {}
        self.finish()
    }

    /// Ends here, and leaves the best poses so far in the problem.
    ///
    /// Their cost is finite, and not above that of the start: of the given poses, and of the spanning tree, for
    /// [`Start::Auto`]. If no start has a finite cost, the poses are unchanged and the report holds
    /// [`OptimizeError::NotFinite`].
    ///
    /// Converged attempts rank before others, then by lower cost. An attempt that is cut off is reported with
    /// [`StopReason::IterationLimit`].
    #[must_use]
    pub fn finish(mut self) -> SessionOutcome {
        if !self.finished {
            let limit = self.steps.len();
            self.automatic = false;
            self.end_attempt(StopReason::IterationLimit { limit });
            if self.round == Round::LeastSquares {
                // Its result is compared by the caller's cost.
                self.begin_refinement();
                self.end_attempt(StopReason::IterationLimit { limit });
            }
        }
        let mut attempts = core::mem::take(&mut self.kept);
        attempts.append(&mut self.ended);
        let mut best = best_of(attempts, self.given_cost);
        if best.report.cost_or_nan().is_nan() {
            // No guess was usable.
            best.poses.clone_from(&self.given);
            best.report.stop = StopReason::Failed {
                error: OptimizeError::NotFinite,
            };
        }
        self.problem.poses_mut().copy_from_slice(&best.poses);
        SessionOutcome {
            report: best.report,
            start: best.start,
            total_iterations: self.total_iterations,
            tried: core::mem::take(&mut self.tried),
        }
    }

    /// The condition on which the current attempt is abandoned.
    fn watch(&self) -> Watch {
        let settings = &self.optimizer.settings;
        let is_plain = settings.kernel == RobustKernel::None;
        if !self.automatic {
            return Watch::Never;
        }
        if self.stage == Stage::First {
            return Watch::StopOnRise {
                and_gain_ratio: is_plain && settings.method == Method::GaussNewton,
            };
        }
        let converged = self.ended.iter().filter(|attempt| attempt.is_converged());
        let best = converged
            .map(|attempt| attempt.report.cost)
            .min_by(f64::total_cmp);
        match best {
            Some(best) if is_plain => Watch::MustBeat(best),
            _ => Watch::Never,
        }
    }

    fn end_attempt(&mut self, stop: StopReason) {
        let steps = core::mem::take(&mut self.steps);
        let attempt = Attempt {
            report: self.optimizer.final_report(self.problem, steps, stop),
            start: self.start,
            poses: self.problem.poses().to_vec(),
        };
        self.tried.push(TriedStart {
            start: attempt.start,
            method: self.optimizer.settings.method,
            kernel: self.optimizer.settings.kernel,
            iterations: attempt.report.iterations,
            cost_initial: attempt.cost_initial(),
            cost: attempt.report.cost,
            stop: Some(stop),
        });
        let trusted = attempt.is_converged() && !self.is_twisted();
        self.ended.push(attempt);
        let has_more =
            self.automatic && (!trusted && self.begin_next_attempt() || self.begin_next_round());
        self.finished = !has_more;
    }

    /// Starts the next attempt: from the chordal relaxation, then with damped steps from there. A refinement
    /// continues from its start with damped steps.
    fn begin_next_attempt(&mut self) -> bool {
        let may_damp = self.method == Method::GaussNewton;
        let damped = Method::LevenbergMarquardt {
            initial_damping: FALLBACK_DAMPING,
        };
        match (self.round, self.stage) {
            (Round::Refine, Stage::First) if may_damp => {
                self.stage = Stage::Damped;
                self.optimizer.settings.method = damped;
                self.start_from(Start::LeastSquares).is_ok()
            }
            (Round::Refine, _) => false,
            (_, Stage::First) => {
                self.stage = Stage::Second;
                self.start_from(Start::Chordal).is_ok() && {
                    self.resume_first_if_chordal_costs_more();
                    true
                }
            }
            (_, Stage::Second) if may_damp => {
                let last = self.ended.last().expect("the second attempt has ended");
                let (steady, start) = (last.is_converged() && !last.climbed(), last.start);
                // If full steps only descended to a minimum, damped ones end there too.
                if steady && start == Start::Chordal {
                    return false;
                }
                self.stage = Stage::Damped;
                self.optimizer.settings.method = damped;
                self.start_from(Start::Chordal).is_ok()
            }
            _ => false,
        }
    }

    /// With a kernel: starts the least-squares round, then the round with the caller's cost from its
    /// solution.
    fn begin_next_round(&mut self) -> bool {
        match self.round {
            Round::Guess if self.kernel != RobustKernel::None => {
                self.kept.append(&mut self.ended);
                self.begin_least_squares();
                true
            }
            Round::LeastSquares => {
                self.begin_refinement();
                true
            }
            _ => false,
        }
    }

    fn begin_least_squares(&mut self) {
        self.round = Round::LeastSquares;
        self.stage = Stage::First;
        self.optimizer.settings.kernel = RobustKernel::None;
        self.optimizer.settings.method = self.method;
        self.problem.poses_mut().copy_from_slice(&self.given);
        self.start_cheaply();
    }

    fn begin_refinement(&mut self) {
        self.round = Round::Refine;
        self.stage = Stage::First;
        self.optimizer.settings.kernel = self.kernel;
        self.optimizer.settings.method = self.method;
        self.origin = best_of(core::mem::take(&mut self.ended), None).poses;
        self.start_from(Start::LeastSquares)
            .expect("poses that are known need no solution");
    }

    /// Whether the heading residual of some measurement exceeds what noise explains.
    ///
    /// Always false with a robust kernel, which is meant to leave outliers with large residuals.
    fn is_twisted(&self) -> bool {
        if self.optimizer.settings.kernel != RobustKernel::None {
            return false;
        }
        let poses = self.problem.poses();
        self.problem.factors().iter().any(|factor| {
            let turn = poses[factor.to].theta() - poses[factor.from].theta();
            let residual = pr_geom::wrap_angle(turn - factor.measurement.theta());
            residual.abs() > SUSPICIOUS_TURN_RAD
        })
    }
}

impl Drop for SolveSession<'_> {
    fn drop(&mut self) {
        self.optimizer.settings.method = self.method;
        self.optimizer.settings.kernel = self.kernel;
        self.optimizer.restart();
    }
}
