//! Searches for loops that are spread over scans.

use nalgebra::Matrix3;
use serde::{Deserialize, Serialize};

use super::LoopCandidate;

/// What is left to search, between two scans.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct LoopSearches {
    /// Keyframes at which loops are to be searched, in order.
    pub due: Vec<usize>,
    /// Windows of the keyframe before those, in order.
    pub windows: Vec<LoopWindow>,
    /// Number of scans that have worked on the first one.
    pub scans: usize,
}

/// A submap that may show the surroundings of a keyframe, and the uncertainty of the relative pose.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct LoopWindow {
    /// The keyframe.
    pub node: usize,
    /// The keyframe in the middle of the submap.
    pub candidate: LoopCandidate,
    /// Covariance of the relative pose by the graph.
    pub covariance: Matrix3<f64>,
    /// Half the width of the window, m.
    pub half_m: f64,
    /// Half its range of headings, rad.
    pub half_rad: f64,
}

impl LoopSearches {
    /// Whether nothing is left to search.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.due.is_empty() && self.windows.is_empty()
    }

    /// Handles new numbers of the keyframes; the search of the first window starts again.
    pub fn renumber(&mut self, number: impl Fn(usize) -> usize) {
        for node in &mut self.due {
            *node = number(*node);
        }
        for window in &mut self.windows {
            window.node = number(window.node);
            window.candidate.node = number(window.candidate.node);
        }
        self.scans = 0;
    }

    /// Handles the removal of a keyframe, which decreases the index of later ones.
    pub fn remove(&mut self, node: usize) {
        self.due.retain(|due| *due != node);
        self.windows
            .retain(|window| window.node != node && window.candidate.node != node);
        self.renumber(|known| known - usize::from(known > node));
    }
}
