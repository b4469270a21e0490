//! What of the graph is looked at: a keyframe, an edge between two of them, or a loop.

use ch16_lab::lap::{LoopAttempt, RecordedEdge};
use ch16_slam2d::graph::EdgeKind;
use kit::param::Values;

use super::moment::Moment;

/// Part of the graph, by the numbers of its keyframes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// A keyframe.
    Keyframe(usize),
    /// The edge of odometry from this keyframe to the next.
    Edge(usize),
    /// The loop that was tried at this keyframe.
    Loop(usize),
    /// The loop of the reader's own.
    Own,
}

/// A way through the parts of one kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Step {
    /// To the part before; from the first, to the last.
    Back,
    /// To the next part; from the last, to the first.
    On,
}

impl Part {
    /// What the settings choose; none where they choose nothing.
    pub fn chosen(values: &Values) -> Option<Self> {
        let number = values.get("number") as usize;
        match values.get("pick") as usize {
            1 => Some(Self::Keyframe(number)),
            2 => Some(Self::Edge(number)),
            3 => Some(Self::Loop(number)),
            _ => None,
        }
    }

    /// The values that choose it; the own loop is told where nothing else is looked at.
    pub fn values(part: Option<Self>) -> [f64; 2] {
        match part {
            Some(Self::Keyframe(number)) => [1.0, number as f64],
            Some(Self::Edge(number)) => [2.0, number as f64],
            Some(Self::Loop(number)) => [3.0, number as f64],
            Some(Self::Own) | None => [0.0, 0.0],
        }
    }

    /// The part before or after among those that are there, in the kind that is looked at.
    pub fn stepped(part: Option<Self>, step: Step, moment: &Moment) -> Option<Self> {
        let nodes = moment.nodes.len();
        let (all, make): (Vec<usize>, fn(usize) -> Self) = match part {
            Some(Self::Edge(_)) => ((0..nodes - 1).collect(), Self::Edge),
            Some(Self::Loop(_)) => {
                let tried = moment.loops_tried();
                let nodes = tried.map(|attempt| attempt.verification.from_node);
                (nodes.collect(), Self::Loop)
            }
            _ => ((0..nodes).collect(), Self::Keyframe),
        };
        let now = part.and_then(Self::number);
        let next = match (step, now) {
            (Step::On, Some(now)) => all.iter().find(|number| **number > now),
            (Step::Back, Some(now)) => all.iter().rfind(|number| **number < now),
            (_, None) => None,
        };
        let around = match step {
            Step::On => all.first(),
            Step::Back => all.last(),
        };
        next.or(around).copied().map(make)
    }

    fn number(self) -> Option<usize> {
        match self {
            Self::Keyframe(number) | Self::Edge(number) | Self::Loop(number) => Some(number),
            Self::Own => None,
        }
    }
}

/// A part that is there at the moment shown.
pub enum Found<'a> {
    /// A keyframe.
    Keyframe(usize),
    /// An edge of odometry.
    Edge(&'a RecordedEdge),
    /// A loop that was tried.
    Loop(&'a LoopAttempt),
    /// The loop of the reader's own.
    Own,
}

/// Finds a part among those that are there; none where it is not, or not yet.
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
