//! What the widget shows at a tick: poses of the graph, on the way from old to new where a loop's
//! animation runs.

use ch16_lab::lap::LoopAttempt;
use pr_geom::SE2;

use super::runs::Runs;

/// The state at one tick.
pub struct Moment<'a> {
    /// The laps.
    pub runs: &'a Runs,
    /// Ticks done.
    pub tick: usize,
    /// The last tick of which the plots tell: the one shown, or the end of the lap.
    pub seen_until: usize,
    /// The attempt made in this tick.
    pub attempt: Option<&'a LoopAttempt>,
    /// Poses of the graph's nodes before the attempt; empty without one.
    pub old_nodes: Vec<SE2>,
    /// Poses of the graph's nodes as shown: `world_from_body`.
    pub nodes: Vec<SE2>,
    /// The graph's pose of the robot as shown: `world_from_body`.
    pub estimate: SE2,
}

impl<'a> Moment<'a> {
    /// The state at `tick`; `share` is the part of a loop's correction that is shown.
    pub fn new(runs: &'a Runs, tick: usize, share: f64, seen_until: usize) -> Self {
        let attempt = runs.graph.attempt_at(tick);
        let mut nodes = runs.graph.poses_at(tick).to_vec();
        let mut estimate = runs.graph.estimate(tick);
        let mut old_nodes = Vec::new();
        if let Some(attempt) = attempt {
            old_nodes = runs.graph.poses_before_loop(tick).to_vec();
            for (new, old) in nodes.iter_mut().zip(&old_nodes) {
                *new = between(old, new, share);
            }
            if let Some(effect) = &attempt.effect {
                let old = effect.correction.inverse() * estimate;
                estimate = between(&old, &estimate, share);
            }
        }
        Self {
            runs,
            tick,
            seen_until,
            attempt,
            old_nodes,
            nodes,
            estimate,
        }
    }

    /// The loops tried up to here.
    pub fn loops_tried(&self) -> impl Iterator<Item = &LoopAttempt> {
        let tick = self.tick;
        let attempts = self.runs.graph.attempts().iter();
        attempts.filter(move |attempt| attempt.tick <= tick)
    }
}

/// The pose at a share of the way: `old ⊞ share · (new ⊟ old)`.
fn between(old: &SE2, new: &SE2, share: f64) -> SE2 {
    if share >= 1.0 {
        return *new;
    }
    old.boxplus(&(new.boxminus(old) * share))
}
