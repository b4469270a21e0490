//! What a search says: of a step, and at its end.

use pr_geom::SE2;

/// A pose and how well the scan fits there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScoredPose {
    /// `map_from_scan`.
    pub pose: SE2,
    /// Mean score of the points, 0 to 1.
    pub score: f64,
}

/// Poses of a window that are judged together.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PoseBox {
    /// Its poses lie between these in x, m.
    pub x_m: [f64; 2],
    /// In y, m.
    pub y_m: [f64; 2],
    /// In the heading, not wrapped, rad.
    pub heading_rad: [f64; 2],
    /// No pose in it scores more than this, 0 to 1; the score itself where it is a single pose.
    pub bound: f64,
    /// Whether it is a single pose.
    pub is_pose: bool,
}

/// What became of a box.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BoxFate {
    /// It was split into boxes that were bounded.
    Split {
        /// How many.
        parts: usize,
    },
    /// Nothing in it beats the best pose so far.
    Pruned,
    /// It is a pose, and the best so far.
    Best,
    /// All of it is the same place as the best pose, while the runner-up is looked for.
    SamePlace,
}

/// What is looked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SearchGoal {
    /// The best pose of the window.
    Best,
    /// The best pose that is another place.
    RunnerUp,
}

/// One step of a search.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SearchReport {
    /// What was looked for.
    pub goal: SearchGoal,
    /// The box that was taken up.
    pub taken: PoseBox,
    /// What became of it.
    pub fate: BoxFate,
}

/// How much work a search was.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SearchCounts {
    /// Boxes of more than one pose that were bounded: a sum over the points each.
    pub bounds: u64,
    /// Single poses that were scored.
    pub poses: u64,
    /// Poses of the window: what an exhaustive search scores.
    pub window: u64,
}

impl SearchCounts {
    /// Sums over the points that were made.
    #[must_use]
    pub fn scored(&self) -> u64 {
        self.bounds + self.poses
    }
}

/// What a search found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SearchResult {
    /// The best pose; of equals the first in heading, then y, then x.
    pub best: ScoredPose,
    /// The best pose that is another place; `None` if the window has no other.
    pub runner_up: Option<ScoredPose>,
    /// The work.
    pub counts: SearchCounts,
}

impl SearchResult {
    /// By how much the runner-up is behind, 0 to 1.
    #[must_use]
    pub fn margin(&self) -> Option<f64> {
        Some(self.best.score - self.runner_up?.score)
    }
}
