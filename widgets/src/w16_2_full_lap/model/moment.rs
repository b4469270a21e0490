//! The state of the widget at a tick: poses of the graph, interpolated during a loop's animation.

use ch16_lab::lap::{OwnLoop, RecordedEdge, RecordedLoopAttempt};
use ch16_slam2d::metrics::position_error_m;
use pr_geom::SE2;
use pr_sim::{CourseError, Sketch};
use widget_kit::scene::Bounds;

use super::pick::GraphPart;
use super::plan_element::PlanElement;
use super::runs::Runs;
use crate::w16_2_full_lap::spec::{Layers, Tool};

/// The drawing of the reader's own flat, or of a world that is being edited.
#[derive(Clone, Copy)]
pub struct Drawn<'a> {
    /// Walls, start and waypoints.
    pub sketch: &'a Sketch,
    /// The selected tool.
    pub tool: Option<Tool>,
    /// The selected piece.
    pub piece: Option<PlanElement>,
    /// Why it cannot be driven; then the laps are of another world.
    pub problem: Option<&'a CourseError>,
    /// Why the last edit was rejected.
    pub note: Option<&'a str>,
    /// The visible part of the map during a stroke.
    pub frame: Option<Bounds>,
}

/// A keyframe so far off at the end of a lap is a wrong place, m.
const WRONG_PLACE_M: f64 = 1.0;

/// What is wrong with the map of a finished lap.
pub enum WrongPlace<'a> {
    /// A keyframe, the one farthest off the truth, and how far, m.
    Keyframe(f64),
    /// An accepted loop between two different places.
    Loop(&'a RecordedLoopAttempt),
}

/// The state at one tick.
pub struct LapState<'a> {
    /// The laps.
    pub runs: &'a Runs,
    /// The current tick.
    pub tick: usize,
    /// The last tick that plots show: the current one, or the end of the lap.
    pub seen_until: usize,
    /// The attempt made in this tick.
    pub attempt: Option<&'a RecordedLoopAttempt>,
    /// The custom loop.
    pub own: Option<&'a OwnLoop>,
    /// Poses of the graph's nodes before the attempt or the custom loop; empty without one.
    pub old_nodes: Vec<SE2>,
    /// Poses of the graph's nodes as shown: `world_from_body`.
    pub nodes: Vec<SE2>,
    /// The graph's pose of the robot as shown: `world_from_body`.
    pub estimate: SE2,
    /// The selected part.
    pub picked: Option<GraphPart>,
    /// The part under the pointer.
    pub hovered: Option<GraphPart>,
    /// The keyframe at which an unfinished custom loop begins.
    pub tied: Option<usize>,
    /// Where the map changes from before the loop to after it, as a share of its width.
    pub wipe: f64,
    /// The layers of the map.
    pub layers: Layers,
    /// The drawing of the reader's own flat.
    pub drawn: Option<Drawn<'a>>,
}

impl<'a> LapState<'a> {
    /// The state at `tick` with the custom loop; `share` is the applied fraction of a loop's correction.
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
            wipe: 0.0,
            layers: Layers::All,
            drawn: None,
        }
    }

    /// The loops tried so far.
    pub fn loops_tried(
        &self,
    ) -> impl DoubleEndedIterator<Item = &'a RecordedLoopAttempt> + use<'a> {
        let tick = self.tick;
        let attempts = self.runs.graph.attempts().iter();
        attempts.filter(move |attempt| attempt.tick <= tick)
    }

    /// The loop to which the tick belongs, if it was tried by then.
    pub fn loop_near(&self) -> Option<&'a RecordedLoopAttempt> {
        let graph = &self.runs.graph;
        let newest = graph.newest_attempt(self.seen_until.min(self.tick + 1));
        let first = graph.attempts().first();
        newest.or(first.filter(|attempt| attempt.tick <= self.seen_until))
    }

    /// The edges of the graph so far, without the custom loop.
    pub fn edges(&self) -> impl Iterator<Item = &'a RecordedEdge> + use<'a> {
        self.runs.graph.lap().edges(self.tick).iter()
    }

    /// Those edges and the custom loop, if it is closed.
    pub fn edges_with_own(&self) -> impl Iterator<Item = &'a RecordedEdge> + use<'a> {
        let own = self.own.filter(|own| own.is_closed());
        self.edges().chain(own.map(|own| &own.edge))
    }

    /// The keyframe farthest off the truth once the lap is over, and how far, m.
    pub fn farthest(&self) -> Option<(usize, f64)> {
        if self.tick < self.runs.ticks() {
            return None;
        }
        let graph = &self.runs.graph;
        let nodes = self.nodes.iter().enumerate();
        let errors = nodes.map(|(node, pose)| {
            let truth = self.runs.truth(graph.keyframe_tick(node));
            (node, position_error_m(pose, &truth))
        });
        errors.max_by(|a, b| a.1.total_cmp(&b.1))
    }

    /// The wrong place of the map once the lap is over: the keyframe farthest off the truth, else a false loop.
    pub fn wrong_place(&self) -> Option<WrongPlace<'a>> {
        let (_, off_m) = self.farthest()?;
        if off_m >= WRONG_PLACE_M {
            return Some(WrongPlace::Keyframe(off_m));
        }
        let wrong = self.runs.graph.lap().false_acceptances().next();
        wrong.map(WrongPlace::Loop)
    }

    /// Whether nodes moved: a loop was closed in this tick, or the custom one is.
    pub fn has_moved(&self) -> bool {
        let own = self.own.is_some_and(OwnLoop::is_closed);
        own || self.attempt.is_some_and(RecordedLoopAttempt::accepted)
    }
}

/// The pose interpolated at `share`: `old ⊞ share · (new ⊟ old)`.
fn between(old: &SE2, new: &SE2, share: f64) -> SE2 {
    if share >= 1.0 {
        return *new;
    }
    old.boxplus(&(new.boxminus(old) * share))
}
