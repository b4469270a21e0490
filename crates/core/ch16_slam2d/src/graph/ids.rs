//! Handles of nodes and edges.

use serde::{Deserialize, Serialize};

/// Handle of a node. Nodes are numbered from 0 in the order in which they were added.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct NodeId(usize);

/// Handle of an edge. Edges are numbered from 0 in the order in which they were added.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct EdgeId(usize);

impl NodeId {
    /// The node's number.
    #[must_use]
    pub fn index(self) -> usize {
        self.0
    }
}

impl From<usize> for EdgeId {
    fn from(number: usize) -> Self {
        Self(number)
    }
}

impl From<usize> for NodeId {
    fn from(number: usize) -> Self {
        Self(number)
    }
}

impl EdgeId {
    /// The edge's number.
    #[must_use]
    pub fn index(self) -> usize {
        self.0
    }
}

/// A loop by its keyframes. Two loops between the same keyframes have the same identity.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct LoopId {
    /// The older keyframe.
    pub old: usize,
    /// The newer keyframe.
    pub new: usize,
}
