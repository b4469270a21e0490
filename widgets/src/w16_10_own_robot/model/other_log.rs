//! The worker's report on another log on this map: the pose of its robot, scan by scan.
//! `web/robot/src/localization.rs` defines the numbers.

use widget_kit::host_messages::Delivery;

use crate::w16_10_own_robot::spec::MAX_SCANS;

/// Number of values for the whole log.
const HEAD: usize = 7;
/// Number of values per scan.
const PLACE: usize = 10;

/// The localization state of a pose.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
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
    fn from_number(number: f64) -> Option<Self> {
        let all = [Self::Found, Self::Tracking, Self::Doubtful, Self::Lost];
        all.get(number as usize).copied()
    }

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
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LocalizedScan {
    /// Number of the scan, from 0.
    pub scan: f64,
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

impl LocalizedScan {
    fn from_numbers(numbers: &[f64]) -> Option<Self> {
        (0.0..=MAX_SCANS).contains(&numbers[0]).then_some(Self {
            scan: numbers[0],
            stamp_s: numbers[1],
            pose: [numbers[2], numbers[3], numbers[4]],
            state: LocalizationState::from_number(numbers[5])?,
            fit: numbers[6],
            ellipse: [numbers[7], numbers[8], numbers[9]],
        })
    }
}

/// Another log on this map.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct OtherLog {
    /// Name of its file.
    pub name: String,
    /// Processed share of the log.
    pub share: f64,
    /// Whether all scans are processed.
    pub is_over: bool,
    /// Scans found, followed, doubtful, lost.
    pub counts: [f64; 4],
    /// Index of the first localized scan, from 0; NaN if there is none.
    pub first: f64,
    /// Remarks for its owner, a sentence each.
    pub remarks: Vec<String>,
    /// The poses of the scans, in order.
    pub places: Vec<LocalizedScan>,
}

impl OtherLog {
    /// Parses a delivery; `None` if it is malformed.
    #[must_use]
    pub fn from_delivery(delivery: &Delivery<'_>) -> Option<Self> {
        let (head, places) = delivery.numbers.split_first_chunk::<HEAD>()?;
        let &[share, over, found, tracking, doubtful, lost, first] = head;
        let mut lines = delivery.text.lines().map(str::to_owned);
        Some(Self {
            name: lines.next().unwrap_or_default(),
            share,
            is_over: over == 1.0,
            counts: [found, tracking, doubtful, lost],
            first,
            remarks: lines.collect(),
            places: places
                .chunks_exact(PLACE)
                .filter_map(LocalizedScan::from_numbers)
                .collect(),
        })
    }

    /// Number of localized scans.
    #[must_use]
    pub fn localized(&self) -> f64 {
        self.counts[0] + self.counts[1]
    }
}
