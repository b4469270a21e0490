//! Reports of a search: for a step, and for its end.

use pr_geom::SE2;
use serde::Serialize;

/// A pose and its score.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct ScoredPose {
    /// `map_from_scan`.
    pub pose: SE2,
    /// Mean score of the points, 0 to 1.
    pub score: f64,
}

/// A box of poses of a window.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct PoseBox {
    /// Range of its poses in x, m.
    pub x_m: [f64; 2],
    /// Range in y, m.
    pub y_m: [f64; 2],
    /// Range of the heading, not wrapped, rad.
    pub heading_rad: [f64; 2],
    /// Upper bound of the score of its poses, 0 to 1; the score itself for a single pose.
    pub bound: f64,
    /// Whether it is a single pose.
    pub is_pose: bool,
}

/// Result of expanding a box.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BoxFate {
    /// It was split into boxes that were bounded.
    Split {
        /// Number of parts.
        parts: usize,
    },
    /// It contains no pose better than the best so far.
    Pruned,
    /// It is a pose, and the best so far.
    Best,
    /// All of it is in the neighbourhood of the best pose, while the runner-up is searched.
    SamePlace,
}

/// Goal of a search.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SearchGoal {
    /// The best pose of the window.
    Best,
    /// The best distinct pose.
    RunnerUp,
}

/// One step of a search.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct SearchReport {
    /// The current goal.
    pub goal: SearchGoal,
    /// The expanded box.
    pub taken: PoseBox,
    /// Its result.
    pub fate: BoxFate,
}

/// Work of a search.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[non_exhaustive]
pub struct SearchCounts {
    /// Boxes of more than one pose that were bounded, by one sum over the points each.
    pub bounds: u64,
    /// Single poses that were scored.
    pub poses: u64,
    /// Poses of the window, which an exhaustive search would score.
    pub window: u64,
}

impl SearchCounts {
    /// Number of sums over the points.
    #[must_use]
    pub fn scored(&self) -> u64 {
        self.bounds + self.poses
    }
}

/// Result of a search.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct SearchResult {
    /// The best pose; of equals the first in heading, then y, then x.
    pub best: ScoredPose,
    /// The best distinct pose; `None` if the window has no other.
    pub runner_up: Option<ScoredPose>,
    /// The work.
    pub counts: SearchCounts,
}

impl SearchResult {
    /// Margin of the score to the runner-up, 0 to 1.
    #[must_use]
    pub fn margin(&self) -> Option<f64> {
        Some(self.best.score - self.runner_up?.score)
    }
}
