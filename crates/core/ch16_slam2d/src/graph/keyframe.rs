//! A node of the graph with its scan.

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::cloud::PointCloud;

/// A keyframe: a node of the graph with its scan.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Keyframe {
    /// Index of its node.
    pub node: usize,
    /// Index of its frame.
    pub frame: usize,
    /// Time of its frame, s.
    pub stamp_s: f64,
    /// Its thinned scan with normals, body frame. Not serialized with the rest: a session stores it compactly.
    #[serde(skip)]
    pub scan: Arc<PointCloud>,
}
