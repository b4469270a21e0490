//! `--robust`: which loops are believed before the graph is solved.

use clap::ValueEnum;
use pr_optim::robust::{
    ConsistencySettings, Gnc, GncLoss, GncSettings, consistent_set, is_sequential, with_factors,
};
use pr_optim::{OptimizeError, Problem, Settings, Start};
use serde::Serialize;

/// `--robust`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum RobustName {
    /// Every loop is believed.
    None,
    /// Graduated non-convexity, truncated least squares.
    Gnc,
    /// Graduated non-convexity, Geman–McClure.
    GncGm,
    /// The loops that agree with each other in pairs.
    Pcm,
}

/// What `--robust` found.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Believed {
    /// Measurements that are not between neighbours in time.
    pub loops: usize,
    /// Those among them that are believed.
    pub believed: usize,
    /// Rounds of graduated non-convexity.
    pub rounds: usize,
}

/// What is to be solved, and from where.
pub struct Selected {
    /// The same poses with the measurements that are believed.
    pub problem: Problem,
    /// Where to start.
    pub start: Start,
    /// How many are believed.
    pub believed: Believed,
}

/// Chooses the loops of `problem` that are believed; none where all are.
///
/// # Errors
/// Where a round of graduated non-convexity cannot be solved.
pub fn select(
    problem: &Problem,
    robust: RobustName,
    solver: Settings,
    start: Start,
) -> Result<Option<Selected>, OptimizeError> {
    let mut moved = problem.clone();
    let (member, rounds, start) = match robust {
        RobustName::None => return Ok(None),
        RobustName::Gnc | RobustName::GncGm => {
            let loss = match robust {
                RobustName::GncGm => GncLoss::GemanMcClure,
                _ => GncLoss::TruncatedLeastSquares,
            };
            let trusted = problem.factors().iter().map(is_sequential).collect();
            let settings = GncSettings {
                loss,
                ..GncSettings::default()
            };
            let outcome = Gnc::new(problem, trusted, solver, settings).run(&mut moved)?;
            let member = (0..outcome.weights.len())
                .map(|factor| outcome.is_believed(factor))
                .collect();
            (member, outcome.rounds, Start::Given)
        }
        RobustName::Pcm => (
            consistent_set(problem, &ConsistencySettings::default()),
            0,
            start,
        ),
    };
    let loops = || {
        let factors = problem.factors().iter().zip(&member);
        factors.filter(|(factor, _): &(_, &bool)| !is_sequential(factor))
    };
    let believed = Believed {
        loops: loops().count(),
        believed: loops().filter(|(_, member)| **member).count(),
        rounds,
    };
    Ok(Some(Selected {
        problem: with_factors(&moved, |factor| member[factor]),
        start,
        believed,
    }))
}
