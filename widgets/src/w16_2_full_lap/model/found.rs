//! Looks up the parts of the graph that exist at the current tick.

use ch16_lab::lap::{LoopAttempt, RecordedEdge};
use ch16_slam2d::graph::EdgeKind;

use super::moment::Moment;
use super::pick::{Direction, Part};

/// A part that exists at the current tick.
pub enum Found<'a> {
    /// A keyframe.
    Keyframe(usize),
    /// An edge of odometry.
    Edge(&'a RecordedEdge),
    /// A loop that was tried.
    Loop(&'a LoopAttempt),
    /// The custom loop.
    Own,
}

/// Finds a part; `None` if it does not exist, or not yet.
pub fn find<'a>(moment: &Moment<'a>, part: Part) -> Option<Found<'a>> {
    match part {
        Part::Keyframe(node) => (node < moment.nodes.len()).then_some(Found::Keyframe(node)),
        Part::Edge(from) => {
            let mut edges = moment.edges();
            let odometry = |edge: &&RecordedEdge| edge.kind == EdgeKind::Odometry;
            edges
                .find(|edge| odometry(edge) && edge.from == from)
                .map(Found::Edge)
        }
        Part::Loop(node) => {
            let mut tried = moment.loops_tried();
            tried
                .find(|attempt| attempt.verification.from_node == node)
                .map(Found::Loop)
        }
        Part::Own => moment.own.map(|_| Found::Own),
    }
}

/// The previous or next existing part of the same kind.
pub fn stepped(part: Option<Part>, step: Direction, moment: &Moment) -> Option<Part> {
    let nodes = moment.nodes.len();
    let (all, make): (Vec<usize>, fn(usize) -> Part) = match part {
        Some(Part::Edge(_)) => ((0..nodes - 1).collect(), Part::Edge),
        Some(Part::Loop(_)) => {
            let tried = moment.loops_tried();
            let nodes = tried.map(|attempt| attempt.verification.from_node);
            (nodes.collect(), Part::Loop)
        }
        _ => ((0..nodes).collect(), Part::Keyframe),
    };
    let now = part.and_then(Part::number);
    let next = match (step, now) {
        (Direction::On, Some(now)) => all.iter().find(|number| **number > now),
        (Direction::Back, Some(now)) => all.iter().rfind(|number| **number < now),
        (_, None) => None,
    };
    let around = match step {
        Direction::On => all.first(),
        Direction::Back => all.last(),
    };
    next.or(around).copied().map(make)
}
