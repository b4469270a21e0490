//! What the widget shows at a tick: poses of the graph, on the way from old to new where a loop's
//! animation runs.

use ch16_lab::lap::{LoopAttempt, OwnLoop, RecordedEdge};
use kit::scene::Bounds;
use pr_geom::SE2;
use pr_sim::{CourseError, Sketch};

use super::flat::Tool;
use super::pick::Part;
use super::piece::Piece;
use super::runs::Runs;

/// What is drawn of the reader's own flat, or of a world that is about to become one.
#[derive(Clone, Copy)]
pub struct Drawn<'a> {
    /// Walls, start and way points.
    pub sketch: &'a Sketch,
    /// The tool in the reader's hand.
    pub tool: Option<Tool>,
    /// What is chosen.
    pub piece: Option<Piece>,
    /// Why it cannot be driven: the laps are of another world then.
    pub problem: Option<&'a CourseError>,
    /// Why the last change was none.
    pub note: Option<&'a str>,
    /// What the map shows while a stroke is under way.
    pub frame: Option<Bounds>,
}

/// The state at one tick.
pub struct Moment<'a> {
    /// The laps.
    pub runs: &'a Runs,
    /// Ticks done.
    pub tick: usize,
    /// The last tick of which anything tells: the one shown, or the end of the lap.
    pub seen_until: usize,
    /// The attempt made in this tick.
    pub attempt: Option<&'a LoopAttempt>,
    /// The loop of the reader's own.
    pub own: Option<&'a OwnLoop>,
    /// Poses of the graph's nodes before the attempt, or before the own loop; empty without one.
    pub old_nodes: Vec<SE2>,
    /// Poses of the graph's nodes as shown: `world_from_body`.
    pub nodes: Vec<SE2>,
    /// The graph's pose of the robot as shown: `world_from_body`.
    pub estimate: SE2,
    /// What is looked at.
    pub picked: Option<Part>,
    /// What the pointer is over.
    pub hovered: Option<Part>,
    /// The keyframe at which a loop of the reader's own begins that has no end yet.
    pub tied: Option<usize>,
    /// What is drawn of the reader's own flat.
    pub drawn: Option<Drawn<'a>>,
}

impl<'a> Moment<'a> {
    /// The state at `tick` with the own loop; `share` is the part of a loop's correction that is shown.
    pub fn new(
        runs: &'a Runs,
        tick: usize,
        share: f64,
        seen_until: usize,
        own: Option<&'a OwnLoop>,
    ) -> Self {
        let attempt = runs.graph.attempt_at(tick);
        let closed = own.filter(|own| own.is_closed());
        let (mut nodes, old_nodes, effect) = match (closed, attempt) {
            (Some(own), _) => (
                own.poses.clone(),
                runs.graph.poses_at(tick).to_vec(),
                own.attempt.effect,
            ),
            (None, Some(attempt)) => (
                runs.graph.poses_at(tick).to_vec(),
                runs.graph.poses_before_loop(tick).to_vec(),
                attempt.effect,
            ),
            (None, None) => (runs.graph.poses_at(tick).to_vec(), Vec::new(), None),
        };
        for (new, old) in nodes.iter_mut().zip(&old_nodes) {
            *new = between(old, new, share);
        }
        let mut estimate = runs.graph.estimate(tick);
        if let Some(effect) = effect {
            let (old, new) = if closed.is_some() {
                (estimate, effect.correction * estimate)
            } else {
                (effect.correction.inverse() * estimate, estimate)
            };
            estimate = between(&old, &new, share);
        }
        Self {
            runs,
            tick,
            seen_until,
            attempt,
            own,
            old_nodes,
            nodes,
            estimate,
            picked: None,
            hovered: None,
            tied: None,
            drawn: None,
        }
    }

    /// The loops tried up to here.
    pub fn loops_tried(&self) -> impl DoubleEndedIterator<Item = &'a LoopAttempt> + use<'a> {
        let tick = self.tick;
        let attempts = self.runs.graph.attempts().iter();
        attempts.filter(move |attempt| attempt.tick <= tick)
    }

    /// The loop that the moment belongs to, as far as it may be told of.
    pub fn loop_near(&self) -> Option<&'a LoopAttempt> {
        let graph = &self.runs.graph;
        let newest = graph.newest_attempt(self.seen_until.min(self.tick + 1));
        let first = graph.attempts().first();
        newest.or(first.filter(|attempt| attempt.tick <= self.seen_until))
    }

    /// The edges of the graph up to here, without the own loop.
    pub fn edges(&self) -> impl Iterator<Item = &'a RecordedEdge> + use<'a> {
        self.runs.graph.lap().edges(self.tick).iter()
    }

    /// The same with the own loop, where it is closed.
    pub fn edges_with_own(&self) -> impl Iterator<Item = &'a RecordedEdge> + use<'a> {
        let own = self.own.filter(|own| own.is_closed());
        self.edges().chain(own.map(|own| &own.edge))
    }

    /// Whether something moved: a loop was closed in this tick, or the reader's own is.
    pub fn has_moved(&self) -> bool {
        let own = self.own.is_some_and(OwnLoop::is_closed);
        own || self.attempt.is_some_and(LoopAttempt::accepted)
    }
}

/// The pose at a share of the way: `old ⊞ share · (new ⊟ old)`.
fn between(old: &SE2, new: &SE2, share: f64) -> SE2 {
    if share >= 1.0 {
        return *new;
    }
    old.boxplus(&(new.boxminus(old) * share))
}
