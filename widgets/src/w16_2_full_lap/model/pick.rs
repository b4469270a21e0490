//! The selected part of the graph: a keyframe, an edge between two of them, or a loop.

use widget_kit::values::Values;

use crate::w16_2_full_lap::spec::{NUMBER, PICK, Picked};

/// Part of the graph, by the numbers of its keyframes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GraphPart {
    /// A keyframe.
    Keyframe(usize),
    /// The edge of odometry from this keyframe to the next.
    Edge(usize),
    /// The loop that was tried at this keyframe.
    Loop(usize),
    /// The custom loop.
    Own,
}

/// A direction through the parts of one kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PickDirection {
    /// To the previous part; from the first to the last.
    Back,
    /// To the next part; from the last to the first.
    On,
}

impl GraphPart {
    /// The selection in the settings; `None` if they select nothing.
    pub fn chosen(values: &Values) -> Option<Self> {
        let number = values.get(&NUMBER);
        match values.get(&PICK) {
            Picked::Nothing => None,
            Picked::Keyframe => Some(Self::Keyframe(number)),
            Picked::Edge => Some(Self::Edge(number)),
            Picked::Loop => Some(Self::Loop(number)),
        }
    }

    /// Stores the selection; the custom loop is described if nothing else is selected.
    pub fn put(part: Option<Self>, values: &mut Values) {
        let (picked, number) = match part {
            Some(Self::Keyframe(number)) => (Picked::Keyframe, number),
            Some(Self::Edge(number)) => (Picked::Edge, number),
            Some(Self::Loop(number)) => (Picked::Loop, number),
            Some(Self::Own) | None => (Picked::Nothing, 0),
        };
        values.put(&PICK, picked);
        values.put(&NUMBER, number);
    }

    /// Its keyframe; `None` for the custom loop, which is unique.
    pub fn number(self) -> Option<usize> {
        match self {
            Self::Keyframe(number) | Self::Edge(number) | Self::Loop(number) => Some(number),
            Self::Own => None,
        }
    }
}
