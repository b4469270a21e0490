//! `--robust`: which loops are believed before the graph is solved.

use clap::ValueEnum;
use pr_optim::robust::{
    BeliefStart, ConsistencySettings, Gnc, GncLoss, GncSettings, believe, believe_consistent,
    is_sequential, with_factors,
};
use pr_optim::{OptimizeError, Problem, Settings};
use serde::Serialize;

/// `--robust`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum RobustName {
    /// Every loop is believed.
    None,
    /// Loops along the way and graduated non-convexity, by truncated least squares.
    Gnc,
    /// The same, and then Geman–McClure from there: stricter, it drops what is half refuted.
    GncGm,
    /// The loops that agree with each other in pairs, and then what the graph by them says of each.
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
    /// The start that won.
    pub from: &'static str,
}

/// What is to be solved, from where it is.
pub struct Selected {
    /// The poses of the belief, with the measurements that are believed.
    pub problem: Problem,
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
) -> Result<Option<Selected>, OptimizeError> {
    let trusted: Vec<bool> = problem.factors().iter().map(is_sequential).collect();
    let settings = GncSettings::default();
    let belief = match robust {
        RobustName::None => return Ok(None),
        RobustName::Gnc | RobustName::GncGm => believe(problem, &trusted, solver, &settings)?,
        RobustName::Pcm => {
            believe_consistent(problem, &trusted, solver, &ConsistencySettings::default())?
        }
    };
    let mut moved = problem.clone();
    moved.poses_mut().copy_from_slice(&belief.poses);
    let (mut member, mut rounds) = (belief.believed, belief.rounds);
    if robust == RobustName::GncGm {
        let settings = GncSettings {
            loss: GncLoss::GemanMcClure,
            ..settings
        };
        let gnc = Gnc::new(problem, trusted, solver, settings).refining(&belief.poses);
        let outcome = gnc.run(&mut moved)?;
        member = (0..member.len())
            .map(|factor| outcome.is_believed(factor))
            .collect();
        rounds += outcome.rounds;
    }
    let loops = || {
        let factors = problem.factors().iter().zip(&member);
        factors.filter(|(factor, _): &(_, &bool)| !is_sequential(factor))
    };
    let believed = Believed {
        loops: loops().count(),
        believed: loops().filter(|(_, member)| **member).count(),
        rounds,
        from: name_of(belief.start),
    };
    Ok(Some(Selected {
        problem: with_factors(&moved, |factor| member[factor]),
        believed,
    }))
}

fn name_of(start: BeliefStart) -> &'static str {
    match start {
        BeliefStart::Forwards => "way",
        BeliefStart::Backwards => "way-back",
        BeliefStart::GraduatedNonConvexity => "gnc",
        BeliefStart::PairwiseConsistency => "pairs",
    }
}
