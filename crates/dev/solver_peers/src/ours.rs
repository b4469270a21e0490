//! This project's solver.

use bench_support::timed;
use pr_optim::{
    JacobianModel, OptimizeError, Optimizer, Problem, SessionOutcome, Settings, SolveSession, Start,
};

use crate::{Peer, Solve};

/// The settings of `slam2d optimize` without options.
fn settings() -> Settings {
    Settings {
        jacobians: JacobianModel::Exact,
        max_iterations: 100,
        step_tolerance: 1e-10,
        decrease_tolerance: 1e-8,
        ..Settings::default()
    }
}

/// [`pr_optim`] with a graph.
pub struct Ours {
    problem: Problem,
    optimizer: Optimizer,
    start: Start,
}

impl Ours {
    /// Loads the graph; solves start at `start`.
    #[must_use]
    pub fn new(problem: Problem, start: Start) -> Self {
        Self {
            problem,
            optimizer: Optimizer::new(settings()),
            start,
        }
    }
}

fn solve_at(
    optimizer: &mut Optimizer,
    problem: &mut Problem,
    start: Start,
) -> Result<SessionOutcome, OptimizeError> {
    SolveSession::new(optimizer, problem, start).map(SolveSession::run)
}

fn solve(optimizer: &mut Optimizer, problem: &Problem, start: Start) -> Solve {
    let mut problem = problem.clone();
    let (outcome, cpu_ms) = timed(|| solve_at(optimizer, &mut problem, start));
    Solve {
        cpu_ms,
        iterations: outcome.as_ref().map(|found| found.total_iterations).ok(),
        poses: outcome.map(|_| problem.poses().to_vec()).ok(),
    }
}

/// χ² at the end of full steps from the present poses.
#[must_use]
pub fn chi2_below(mut problem: Problem) -> f64 {
    // If no step can be computed, the poses stay, and their χ² counts.
    let _ = solve_at(&mut Optimizer::new(settings()), &mut problem, Start::Given);
    problem.chi2()
}

impl Peer for Ours {
    fn name(&self) -> &'static str {
        match self.start {
            Start::Auto => "ours",
            _ => "ours, file's start",
        }
    }

    fn solve_cold(&mut self) -> Solve {
        solve(&mut Optimizer::new(settings()), &self.problem, self.start)
    }

    fn solve_warm(&mut self) -> Option<Solve> {
        Some(solve(&mut self.optimizer, &self.problem, self.start))
    }
}
