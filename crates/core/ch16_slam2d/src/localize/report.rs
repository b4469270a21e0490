//! Result of one frame of localization.

use nalgebra::Matrix3;
use pr_geom::SE2;
use serde::{Serialize, Serializer};

use crate::search::{ScoredPose, SearchResult};

/// Reliability of a pose.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// The pose was found by a search in this frame.
    Found,
    /// The pose follows from the previous one, and the scan fits there.
    Tracking,
    /// The pose is reported, but the scan fits poorly or has fewer than 8 points that fit, its covariance is large, or another
    /// pose fits about as well.
    Doubtful,
    /// The pose is unknown.
    Lost,
}

impl Verdict {
    /// Name in lower case.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Found => "found",
            Self::Tracking => "tracking",
            Self::Doubtful => "doubtful",
            Self::Lost => "lost",
        }
    }

    /// Whether the pose is reliable enough to navigate by.
    #[must_use]
    pub fn is_localized(self) -> bool {
        matches!(self, Self::Found | Self::Tracking)
    }
}

impl core::fmt::Display for Verdict {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.pad(self.name())
    }
}

/// Result of one frame.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct LocalizeReport {
    /// Index of the frame.
    pub frame: usize,
    /// Its time, s.
    pub stamp_s: f64,
    /// Reliability of the pose.
    pub verdict: Verdict,
    /// `map_from_body`; `None` if the robot is lost.
    pub pose: Option<SE2>,
    /// Covariance of the pose in the body's frame, 3×3, translation first: m², rad².
    #[serde(serialize_with = "rows")]
    pub covariance: Option<Matrix3<f64>>,
    /// Share of the scan that fits at the pose, 0 to 1; `None` without points.
    pub score: Option<f64>,
    /// Result of this frame's search, if there was one and it found a pose.
    pub search: Option<SearchResult>,
}

impl LocalizeReport {
    /// Margin of the search result to the best distinct pose, if the search found a competing one.
    #[must_use]
    pub fn margin(&self) -> Option<f64> {
        self.search?.margin()
    }

    /// The best distinct pose, if a search found one.
    #[must_use]
    pub fn runner_up(&self) -> Option<ScoredPose> {
        self.search?.runner_up
    }
}

/// The rows of a symmetric matrix.
fn rows<S: Serializer>(
    covariance: &Option<Matrix3<f64>>,
    serializer: S,
) -> Result<S::Ok, S::Error> {
    covariance.map(|matrix| matrix.data.0).serialize(serializer)
}
