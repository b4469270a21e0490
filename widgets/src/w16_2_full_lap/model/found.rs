//! Looks up the parts of the graph that exist at the current tick.

use ch16_lab::lap::{RecordedEdge, RecordedLoopAttempt};
use ch16_slam2d::graph::EdgeKind;

use super::moment::LapState;
use super::pick::{GraphPart, PickDirection};

/// A part that exists at the current tick.
pub enum Found<'a> {
    /// A keyframe.
    Keyframe(usize),
    /// An edge of odometry.
    Edge(&'a RecordedEdge),
    /// A loop that was tried.
    Loop(&'a RecordedLoopAttempt),
    /// The custom loop.
    Own,
}

/// Finds a part; `None` if it does not exist, or not yet.
pub fn find<'a>(moment: &LapState<'a>, part: GraphPart) -> Option<Found<'a>> {
    match part {
        GraphPart::Keyframe(node) => (node < moment.nodes.len()).then_some(Found::Keyframe(node)),
        GraphPart::Edge(from) => {
            let mut edges = moment.edges();
            let odometry = |edge: &&RecordedEdge| edge.kind == EdgeKind::Odometry;
            edges
                .find(|edge| odometry(edge) && edge.from == from)
                .map(Found::Edge)
        }
        GraphPart::Loop(node) => {
            let mut tried = moment.loops_tried();
            tried
                .find(|attempt| attempt.verification.from_node == node)
                .map(Found::Loop)
        }
        GraphPart::Own => moment.own.map(|_| Found::Own),
    }
}

/// The previous or next existing part of the same kind.
pub fn stepped(
    part: Option<GraphPart>,
    step: PickDirection,
    moment: &LapState,
) -> Option<GraphPart> {
    let nodes = moment.nodes.len();
    let (all, make): (Vec<usize>, fn(usize) -> GraphPart) = match part {
        Some(GraphPart::Edge(_)) => ((0..nodes - 1).collect(), GraphPart::Edge),
        Some(GraphPart::Loop(_)) => {
            let tried = moment.loops_tried();
            let nodes = tried.map(|attempt| attempt.verification.from_node);
            (nodes.collect(), GraphPart::Loop)
        }
        _ => ((0..nodes).collect(), GraphPart::Keyframe),
    };
    let now = part.and_then(GraphPart::number);
    let next = match (step, now) {
        (PickDirection::On, Some(now)) => all.iter().find(|number| **number > now),
        (PickDirection::Back, Some(now)) => all.iter().rfind(|number| **number < now),
        (_, None) => None,
    };
    let around = match step {
        PickDirection::On => all.first(),
        PickDirection::Back => all.last(),
    };
    next.or(around).copied().map(make)
}
