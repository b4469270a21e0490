//! Another log on the map: the pose of its robot, scan by scan.

use serde::{Deserialize, Serialize};

/// The localization state of a pose.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum LocalizationState {
    /// Found by a search in this scan.
    Found,
    /// Tracked from the previous scan.
    Tracking,
    /// A pose exists, but is not reliable.
    Doubtful,
    /// Lost.
    Lost,
}

impl LocalizationState {
    /// Whether the pose is reliable.
    #[must_use]
    pub fn is_localized(self) -> bool {
        matches!(self, Self::Found | Self::Tracking)
    }

    /// The state in one word.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Found => "found",
            Self::Tracking => "followed",
            Self::Doubtful => "doubtful",
            Self::Lost => "lost",
        }
    }
}

/// The pose of a scan; NaN for missing numbers.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct LocalizedScan {
    /// Number of the scan, from 0.
    pub scan: usize,
    /// Its time, s.
    pub stamp_s: f64,
    /// `[x, y, θ]` on the map, m and rad.
    pub pose: [f64; 3],
    /// Its localization state.
    pub state: LocalizationState,
    /// Share of the scan that fits at the pose.
    pub fit: f64,
    /// Half axes of the 1σ ellipse, m, and the heading of the long one, rad.
    pub ellipse: [f64; 3],
}

/// Another log on this map.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct OtherLog {
    /// Name of its file.
    pub name: String,
    /// Processed share of the log.
    pub share: f64,
    /// Whether all scans are processed.
    pub is_over: bool,
    /// Scans found, followed, doubtful, lost.
    pub counts: [usize; 4],
    /// Number of the first localized scan, from 0.
    pub first: Option<usize>,
    /// Remarks for its owner, a sentence each.
    pub remarks: Vec<String>,
    /// The poses of the scans, in order.
    pub places: Vec<LocalizedScan>,
}

impl OtherLog {
    /// Number of localized scans.
    #[must_use]
    pub fn localized(&self) -> usize {
        self.counts[0] + self.counts[1]
    }
}
