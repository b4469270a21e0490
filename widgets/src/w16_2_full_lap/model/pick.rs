//! What of the graph is looked at: a keyframe, an edge between two of them, or a loop.

use kit::values::Values;

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

    /// Its keyframe; none of the own loop, of which there is one.
    pub fn number(self) -> Option<usize> {
        match self {
            Self::Keyframe(number) | Self::Edge(number) | Self::Loop(number) => Some(number),
            Self::Own => None,
        }
    }
}
