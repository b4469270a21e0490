//! What a frame says of the robot's place.

use nalgebra::Matrix3;
use pr_geom::SE2;

use crate::search::{ScoredPose, SearchResult};

/// How far a pose is to be localized.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// The place was searched for and found in this frame.
    Found,
    /// The pose follows from the one before, and the scan fits there.
    Tracking,
    /// A pose is told, but the scan fits poorly, the pose is not known well, or another place fits
    /// about as well.
    Doubtful,
    /// Nobody knows.
    Lost,
}

impl Verdict {
    /// Its name.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Found => "found",
            Self::Tracking => "tracking",
            Self::Doubtful => "doubtful",
            Self::Lost => "lost",
        }
    }

    /// Whether the pose is one to drive by.
    #[must_use]
    pub fn is_localized(self) -> bool {
        matches!(self, Self::Found | Self::Tracking)
    }
}

/// What one frame did.
#[derive(Clone, Debug, PartialEq)]
pub struct LocalizeReport {
    /// Number of the frame, counted from 0.
    pub frame: usize,
    /// Its time, s.
    pub stamp_s: f64,
    /// How far the pose is to be localized.
    pub verdict: Verdict,
    /// `map_from_body`; `None` if it is lost.
    pub pose: Option<SE2>,
    /// Covariance of the pose in the body's frame, 3×3, translation first: m², rad².
    pub covariance: Option<Matrix3<f64>>,
    /// Share of the scan that fits at the pose, 0 to 1.
    pub score: Option<f64>,
    /// The search of this frame, where one was made and found something.
    pub search: Option<SearchResult>,
}

impl LocalizeReport {
    /// By how much the best other place was behind, where a search found one that is close enough to
    /// be asked about.
    #[must_use]
    pub fn margin(&self) -> Option<f64> {
        self.search?.margin()
    }

    /// The best other place, where a search found one.
    #[must_use]
    pub fn runner_up(&self) -> Option<ScoredPose> {
        self.search?.runner_up
    }
}
