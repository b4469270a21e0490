//! Starts that were tried: one line and one JSON object each.

use core::fmt;

use pr_optim::{Method, RobustKernel, Start, TriedStart};
use serde::Serialize;

/// One start that the solver tried.
#[derive(Clone, Debug, Serialize)]
pub struct TriedJson {
    init: &'static str,
    /// `gn` or `lm`.
    method: &'static str,
    /// Whether the robust kernel was on.
    robust: bool,
    iterations: usize,
    /// Initial cost.
    cost_initial: f64,
    /// Final cost.
    cost: f64,
    /// Why it ended or was not continued.
    stop: String,
}

impl From<&TriedStart> for TriedJson {
    fn from(trial: &TriedStart) -> Self {
        Self {
            init: start_name(trial.start),
            method: match trial.method {
                Method::GaussNewton => "gn",
                Method::LevenbergMarquardt { .. } => "lm",
            },
            robust: trial.kernel != RobustKernel::None,
            iterations: trial.iterations,
            cost_initial: trial.cost_initial,
            cost: trial.cost,
            stop: trial.stop.map_or_else(
                || "not continued, another start has a lower cost".to_owned(),
                |stop| stop.to_string(),
            ),
        }
    }
}

impl fmt::Display for TriedJson {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            init,
            method,
            iterations,
            cost_initial,
            cost,
            stop,
            ..
        } = self;
        let kernel = if self.robust { ", robust" } else { "" };
        write!(f, "{init} ({method}{kernel}): cost {cost_initial:.6e}")?;
        if *iterations > 0 {
            write!(f, " to {cost:.6e}, iterations {iterations}")?;
        }
        write!(f, ": {stop}")
    }
}

/// The name of a start on the command line.
pub fn start_name(start: Start) -> &'static str {
    match start {
        Start::Auto => "auto",
        Start::Given => "file",
        Start::SpanningTree => "spanning-tree",
        Start::Chordal => "chordal",
        Start::LeastSquares => "least-squares",
    }
}
