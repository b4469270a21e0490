//! A solve from a first guess to the optimum: which guess, and what to do where it fails.
//!
//! Gauss–Newton finds the minimum in whose basin it starts. [`Start::Auto`] takes the better of
//! two guesses that cost next to nothing, the poses as given and a spanning tree. Where the cost
//! rises on the way, the steps do not converge, or a measurement ends up turned by more than
//! [`SUSPICIOUS_TURN_RAD`], that basin is not trusted: the solve begins again from the chordal
//! relaxation, and once more with damped steps where the result is not to be trusted either. The
//! best of what converged is kept, unless it costs more than the poses as given: then the best of
//! all. This is a rule of thumb, not a proof of a global optimum.
//!
//! A robust kernel has many more false minima: from a poor guess it switches right measurements off.
//! With one, [`Start::Auto`] goes on to solve the same graph without it, and from there once more
//! with it: plain, and with damped steps where the cost rises. The lower robust cost is kept.

use pr_geom::SE2;

use crate::error::OptimizeError;
use crate::init::{chordal, spanning_tree};
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
}

/// One attempt that ended.
#[derive(Clone, Debug)]
struct Attempt {
    report: Report,
    start: Start,
    poses: Vec<SE2>,
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
    automatic: bool,
    start: Start,
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
            automatic,
            optimizer,
            problem,
            start,
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
        let stop = self.optimizer.advance(self.problem, &mut self.steps);
        self.total_iterations += self.steps.len() - done;
        let stop = stop.or_else(|| self.watch());
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
        }
    }

    /// Takes the better of the given poses and the spanning tree.
    fn start_cheaply(&mut self) {
        self.steps.clear();
        self.optimizer.restart();
        let tree = spanning_tree(self.problem);
        let given = self.optimizer.cost_at(self.problem, self.problem.poses());
        if self.round == Round::Guess {
            self.given_cost = Some(given);
        }
        let of_tree = self.optimizer.cost_at(self.problem, &tree);
        if of_tree < given || (given.is_nan() && of_tree.is_finite()) {
            self.problem.poses_mut().copy_from_slice(&tree);
            self.start = Start::SpanningTree;
        } else {
            self.start = Start::Given;
        }
    }

    fn start_from(&mut self, start: Start) -> Result<(), OptimizeError> {
        match start {
            Start::Auto | Start::Given => {}
            Start::SpanningTree => {
                let poses = spanning_tree(self.problem);
                self.move_to(&poses)?;
            }
            Start::Chordal => {
                let linear = self.optimizer.linear_for(self.problem);
                let poses = chordal(self.problem, linear)?;
                self.move_to(&poses)?;
            }
            Start::LeastSquares => self.problem.poses_mut().copy_from_slice(&self.origin),
        }
        self.start = start;
        self.steps.clear();
        self.optimizer.restart();
        Ok(())
    }

    /// Moves to a guess whose cost is finite.
    fn move_to(&mut self, guess: &[SE2]) -> Result<(), OptimizeError> {
        if !self.optimizer.cost_at(self.problem, guess).is_finite() {
            return Err(OptimizeError::NotFinite);
        }
        self.problem.poses_mut().copy_from_slice(guess);
        Ok(())
    }

    /// A reason to give up the first attempt of a round: its last step began at a higher cost than the one before.
    fn watch(&self) -> Option<StopReason> {
        match self.steps.as_slice() {
            [.., before, last]
                if self.automatic
                    && self.ended.is_empty()
                    && last.cost_before > before.cost_before =>
            {
                Some(StopReason::CostRose {
                    before: before.cost_before,
                    after: last.cost_before,
                })
            }
            _ => None,
        }
    }

    fn end_attempt(&mut self, stop: StopReason) {
        let steps = core::mem::take(&mut self.steps);
        let attempt = Attempt {
            report: self.optimizer.settle(self.problem, steps, stop),
            start: self.start,
            poses: self.problem.poses().to_vec(),
        };
        let trusted = is_converged(&attempt) && !self.is_twisted();
        self.ended.push(attempt);
        let goes_on =
            self.automatic && (!trusted && self.begin_next_attempt() || self.begin_next_round());
        self.finished = !goes_on;
    }

    /// From the chordal relaxation; then the same with damped steps; then no more. A refinement goes
    /// on from where it began, with damped steps.
    fn begin_next_attempt(&mut self) -> bool {
        let damped = Method::LevenbergMarquardt {
            initial_damping: FALLBACK_DAMPING,
        };
        let (start, method) = match (self.round, self.ended.len(), self.method) {
            (Round::Refine, 1, Method::GaussNewton) => (Start::LeastSquares, damped),
            (Round::Refine, ..) => return false,
            (_, 1, method) => (Start::Chordal, method),
            (_, 2, Method::GaussNewton) => (Start::Chordal, damped),
            _ => return false,
        };
        self.optimizer.settings.method = method;
        self.start_from(start).is_ok()
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
        self.optimizer.settings.kernel = RobustKernel::None;
        self.optimizer.settings.method = self.method;
        self.problem.poses_mut().copy_from_slice(&self.given);
        self.start_cheaply();
    }

    fn begin_refinement(&mut self) {
        self.round = Round::Refine;
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

/// The lowest cost of what converged at no more than `bound`; of all where nothing did.
fn best_of(attempts: Vec<Attempt>, bound: Option<f64>) -> Attempt {
    let is_good = |attempt: &Attempt| {
        let climbed = bound.is_some_and(|bound| attempt.report.cost > bound);
        is_converged(attempt) && !climbed
    };
    let any_good = attempts.iter().any(is_good);
    attempts
        .into_iter()
        .filter(|attempt| is_good(attempt) || !any_good)
        .min_by(|a, b| rank(a).total_cmp(&rank(b)))
        .expect("at least one attempt has ended")
}

/// The cost; a cost that is out of the range of numbers comes last, whatever the sign of its NaN.
fn rank(attempt: &Attempt) -> f64 {
    attempt.report.cost_or_nan().abs()
}

fn is_converged(attempt: &Attempt) -> bool {
    attempt.report.stop.is_converged()
}
