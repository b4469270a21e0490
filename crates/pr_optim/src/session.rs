//! A solve from a first guess to the optimum: which guess, and what to do where it fails.
//!
//! Gauss–Newton finds the minimum in whose basin it starts. [`Start::Auto`] takes the better of
//! two guesses that cost next to nothing, the poses as given and a spanning tree, and looks how its
//! first step keeps its promise. Where that is broken, the cost rises on the way, the steps do not
//! converge, or a measurement ends up turned by more than [`SUSPICIOUS_TURN_RAD`], that basin is not
//! trusted: the solve begins again from the chordal relaxation, unless that costs more than what is
//! reached. Where the result is not to be trusted either, damped steps follow from there, if full
//! ones climbed or did not converge. An attempt that leads to no lower cost than one before is given
//! up on the way. The best of what converged is kept, unless it costs more than the poses as given:
//! then the best of all. This is a rule of thumb, not a proof of a global optimum.
//! [`Outcome::tried`] lists what was tried.
//!
//! A robust kernel has many more false minima: from a poor guess it switches right measurements off.
//! With one, [`Start::Auto`] goes on to solve the same graph without it, and from there once more
//! with it: plain, and with damped steps where the cost rises. The lower robust cost is kept.

mod attempt;
mod guess;
mod watch;

use pr_geom::SE2;

pub use self::attempt::Trial;
use self::attempt::{Attempt, best_of};
use self::watch::Watch;
use crate::error::OptimizeError;
use crate::kernel::RobustKernel;
use crate::optimizer::Optimizer;
use crate::problem::Problem;
use crate::report::{Report, StepReport, StopReason};
use crate::settings::Method;

/// A heading residual at a minimum that noise does not explain.
///
/// On seven recorded graphs the largest one is 0.71 rad at the best known optimum, of the graph
/// with the worst headings, and at least 1.03 rad at every false minimum that was met.
pub const SUSPICIOUS_TURN_RAD: f64 = 1.0;

/// First damping of the attempt with damped steps.
const FALLBACK_DAMPING: f64 = 1e-4;

/// Where a solve starts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Start {
    /// The better of the given poses and the spanning tree. Where that fails, the chordal
    /// relaxation, and then the same with damped steps.
    #[default]
    Auto,
    /// The poses as given.
    Given,
    /// Along a breadth-first tree of measurements from the fixed poses.
    SpanningTree,
    /// Headings and positions by two linear problems.
    Chordal,
    /// The least-squares solution without the robust kernel, itself started as by [`Start::Auto`].
    LeastSquares,
}

/// What a session found.
#[derive(Clone, Debug, PartialEq)]
pub struct Outcome {
    /// The solve that was kept.
    pub report: Report,
    /// Where it started, never [`Start::Auto`].
    pub start: Start,
    /// Linear systems solved by Gauss–Newton or Levenberg–Marquardt in all attempts.
    pub total_iterations: usize,
    /// Every start that was looked at, in this order.
    pub tried: Vec<Trial>,
}

/// Which cost is lowered, and from where. Without a kernel there is only the first round.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Round {
    /// The caller's cost, from guesses.
    Guess,
    /// Plain least squares in spite of the caller's kernel, from guesses.
    LeastSquares,
    /// The caller's kernel, from the least-squares solution.
    Refine,
}

/// How far a round has got.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Stage {
    /// From what costs next to nothing, or where the caller wants.
    First,
    /// From the chordal relaxation, or from the first guess again where that costs less.
    Second,
    /// With damped steps.
    Damped,
}

/// A solve that goes on step by step.
///
/// Dropped before [`finish`](Self::finish), it leaves the poses where the last step put them.
/// Either way the optimizer has the method again that it came with.
#[derive(Debug)]
pub struct Session<'a> {
    optimizer: &'a mut Optimizer,
    problem: &'a mut Problem,
    /// What the caller asked for. Later attempts solve with another; dropping restores it.
    method: Method,
    /// What the caller asked for; dropping restores it.
    kernel: RobustKernel,
    /// The poses as they came.
    given: Vec<SE2>,
    /// Cost of the poses as they came, where [`Start::Auto`] began with them as one of its guesses.
    given_cost: Option<f64>,
    /// Where the refinement starts: the least-squares solution.
    origin: Vec<SE2>,
    round: Round,
    stage: Stage,
    automatic: bool,
    start: Start,
    tried: Vec<Trial>,
    steps: Vec<StepReport>,
    last_step: Option<StepReport>,
    /// The attempts of this round that have ended.
    ended: Vec<Attempt>,
    /// The attempts of earlier rounds that count at the end.
    kept: Vec<Attempt>,
    total_iterations: usize,
    finished: bool,
}

impl<'a> Session<'a> {
    /// Moves `problem` to its first guess.
    ///
    /// # Errors
    /// Where the start that is asked for cannot be computed or is not finite; the poses stay.
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

    /// One iteration; returns whether there is more to do.
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

    /// What the last iteration did; `None` before the first.
    #[must_use]
    pub fn last_step(&self) -> Option<&StepReport> {
        self.last_step.as_ref()
    }

    /// Iterates to the end, and leaves the poses of the attempt that was kept in the problem.
    #[must_use]
    pub fn run(mut self) -> Outcome {
        while self.step() {}
        self.finish()
    }

    /// Ends here, and leaves the best poses so far in the problem.
    ///
    /// Their cost is finite, and not above that of the start: of the poses as they came, and of the
    /// spanning tree, with [`Start::Auto`]. Where no start has a finite cost, the poses stay as they
    /// came and the report says [`OptimizeError::NotFinite`].
    ///
    /// Attempts that converged go before others, then the lower cost. An attempt that is cut off
    /// is reported with [`StopReason::IterationLimit`].
    #[must_use]
    pub fn finish(mut self) -> Outcome {
        if !self.finished {
            let limit = self.steps.len();
            self.automatic = false;
            self.end_attempt(StopReason::IterationLimit { limit });
            if self.round == Round::LeastSquares {
                // What it found counts by the caller's cost.
                self.begin_refinement();
                self.end_attempt(StopReason::IterationLimit { limit });
            }
        }
        let mut attempts = core::mem::take(&mut self.kept);
        attempts.append(&mut self.ended);
        let mut best = best_of(attempts, self.given_cost);
        if best.report.cost_or_nan().is_nan() {
            // No guess was one to start from.
            best.poses.clone_from(&self.given);
            best.report.stop = StopReason::Failed {
                error: OptimizeError::NotFinite,
            };
        }
        self.problem.poses_mut().copy_from_slice(&best.poses);
        Outcome {
            report: best.report,
            start: best.start,
            total_iterations: self.total_iterations,
            tried: core::mem::take(&mut self.tried),
        }
    }

    /// What the attempt that goes on is given up for.
    fn watch(&self) -> Watch {
        let settings = &self.optimizer.settings;
        let is_plain = settings.kernel == RobustKernel::None;
        if !self.automatic {
            return Watch::Nothing;
        }
        if self.stage == Stage::First {
            return Watch::Climbs {
                and_promise: is_plain && settings.method == Method::GaussNewton,
            };
        }
        let converged = self.ended.iter().filter(|attempt| attempt.is_converged());
        let best = converged
            .map(|attempt| attempt.report.cost)
            .min_by(f64::total_cmp);
        match best {
            Some(best) if is_plain => Watch::Beats(best),
            _ => Watch::Nothing,
        }
    }

    fn end_attempt(&mut self, stop: StopReason) {
        let steps = core::mem::take(&mut self.steps);
        let attempt = Attempt {
            report: self.optimizer.final_report(self.problem, steps, stop),
            start: self.start,
            poses: self.problem.poses().to_vec(),
        };
        self.tried.push(Trial {
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
        let goes_on =
            self.automatic && (!trusted && self.begin_next_attempt() || self.begin_next_round());
        self.finished = !goes_on;
    }

    /// From the chordal relaxation; then damped steps from there; then no more. A refinement goes on
    /// from where it began, with damped steps.
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
                    self.keep_on_where_chordal_costs_more();
                    true
                }
            }
            (_, Stage::Second) if may_damp => {
                let last = self.ended.last().expect("the second attempt has ended");
                let (steady, start) = (last.is_converged() && !last.climbed(), last.start);
                // Where full steps only descended to a minimum, damped ones lead there, too.
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

    /// With a kernel: the least-squares solution, then the caller's cost from there; then no more.
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

    /// Whether some measurement's heading residual is beyond what noise explains.
    ///
    /// A robust kernel is there to leave false measurements where they are: with one, nothing is.
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

impl Drop for Session<'_> {
    fn drop(&mut self) {
        self.optimizer.settings.method = self.method;
        self.optimizer.settings.kernel = self.kernel;
        self.optimizer.restart();
    }
}
