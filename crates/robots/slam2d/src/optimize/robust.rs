//! `--robust`: selects inlier loops before the graph is optimized.

use clap::ValueEnum;
use pr_optim::robust::{
    ConsistencySettings, Gnc, GncLoss, GncSettings, InlierStart, is_sequential, select_consistent,
    select_inliers, with_factors,
};
use pr_optim::{OptimizeError, Problem, Settings};
use serde::Serialize;

/// `--robust`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum RobustName {
    /// Every loop is an inlier.
    None,
    /// Graduated non-convexity by truncated least squares, also started from the loops along the trajectory.
    Gnc,
    /// The same, followed by Geman–McClure: stricter, it rejects ambiguous loops.
    GncGm,
    /// Pairwise consistent loops, each then tested against the graph that they give.
    Pcm,
}

/// Result of `--robust`.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct InlierCounts {
    /// Number of measurements that are not between consecutive nodes.
    pub loops: usize,
    /// Number of inliers among them.
    pub inliers: usize,
    /// Rounds of graduated non-convexity.
    pub rounds: usize,
    /// The start that won.
    pub from: &'static str,
}

/// The selected problem, with its initial guess.
pub struct Selected {
    /// Poses and inlier measurements.
    pub problem: Problem,
    /// Number of inliers.
    pub inliers: InlierCounts,
}

/// Selects the inlier loops of `problem`; `None` if all measurements are kept.
///
/// # Errors
/// If a round of graduated non-convexity cannot be solved.
pub fn select(
    problem: &Problem,
    robust: RobustName,
    solver: Settings,
) -> Result<Option<Selected>, OptimizeError> {
    let trusted: Vec<bool> = problem.factors().iter().map(is_sequential).collect();
    let settings = GncSettings::default();
    let selection = match robust {
        RobustName::None => return Ok(None),
        RobustName::Gnc | RobustName::GncGm => {
            select_inliers(problem, &trusted, solver, &settings)?
        }
        RobustName::Pcm => {
            select_consistent(problem, &trusted, solver, &ConsistencySettings::default())?
        }
    };
    let mut moved = problem.clone();
    moved.poses_mut().copy_from_slice(&selection.poses);
    let (mut member, mut rounds) = (selection.inliers, selection.rounds);
    if robust == RobustName::GncGm {
        let settings = GncSettings {
            loss: GncLoss::GemanMcClure,
            ..settings
        };
        let gnc = Gnc::new(problem, trusted, solver, settings).refining(&selection.poses);
        let outcome = gnc.run(&mut moved)?;
        member = (0..member.len())
            .map(|factor| outcome.is_inlier(factor))
            .collect();
        rounds += outcome.rounds;
    }
    let loops = || {
        let factors = problem.factors().iter().zip(&member);
        factors.filter(|(factor, _): &(_, &bool)| !is_sequential(factor))
    };
    let inliers = InlierCounts {
        loops: loops().count(),
        inliers: loops().filter(|(_, member)| **member).count(),
        rounds,
        from: name_of(selection.start),
    };
    Ok(Some(Selected {
        problem: with_factors(&moved, |factor| member[factor]),
        inliers,
    }))
}

fn name_of(start: InlierStart) -> &'static str {
    match start {
        InlierStart::Forwards => "path",
        InlierStart::Backwards => "path-back",
        InlierStart::GraduatedNonConvexity => "gnc",
        InlierStart::PairwiseConsistency => "pairs",
        InlierStart::PresentPoses => "poses",
    }
}
