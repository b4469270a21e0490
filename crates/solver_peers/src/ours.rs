//! This project's solver.

use pr_optim::{JacobianModel, Optimizer, Problem, Session, Settings, Start};

use crate::clock::timed;
use crate::{Peer, Timing};

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
    /// Keeps the graph; solves begin at `start`.
    #[must_use]
    pub fn new(problem: Problem, start: Start) -> Self {
        Self {
            problem,
            optimizer: Optimizer::new(settings()),
            start,
        }
    }
}

fn solve(optimizer: &mut Optimizer, problem: &mut Problem, start: Start) -> (f64, usize) {
    let outcome = Session::new(optimizer, problem, start)
        .expect("the file was checked when it was read")
        .run();
    (outcome.report.chi2, outcome.total_iterations)
}

impl Peer for Ours {
    fn name(&self) -> &'static str {
        match self.start {
            Start::Auto => "ours",
            _ => "ours, file's start",
        }
    }

    fn solve_cold(&mut self) -> Timing {
        let mut problem = self.problem.clone();
        let ((chi2, iterations), cpu_ms) =
            timed(|| solve(&mut Optimizer::new(settings()), &mut problem, self.start));
        Timing {
            cpu_ms,
            chi2,
            iterations,
        }
    }

    fn solve_warm(&mut self) -> Option<Timing> {
        let mut problem = self.problem.clone();
        let ((chi2, iterations), cpu_ms) =
            timed(|| solve(&mut self.optimizer, &mut problem, self.start));
        Some(Timing {
            cpu_ms,
            chi2,
            iterations,
        })
    }
}
