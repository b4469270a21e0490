//! What the worker has told of another log on this map: where its robot was, scan by scan. The numbers
//! stand in `web/robot/src/whereabouts.rs`.

use kit::outside::Delivery;

use crate::w16_10_own_robot::spec::MOST_SCANS;

/// Numbers on the whole.
const HEAD: usize = 7;
/// Numbers of a scan.
const PLACE: usize = 10;

/// How far a pose is localized.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Belief {
    /// The place was looked for and found in this scan.
    Found,
    /// The pose follows from the one before.
    Tracking,
    /// A pose is told, and should not be driven by.
    Doubtful,
    /// Nobody knows.
    Lost,
}

impl Belief {
    fn from_number(number: f64) -> Option<Self> {
        let all = [Self::Found, Self::Tracking, Self::Doubtful, Self::Lost];
        all.get(number as usize).copied()
    }

    /// Whether the pose is one to drive by.
    #[must_use]
    pub fn is_localized(self) -> bool {
        matches!(self, Self::Found | Self::Tracking)
    }

    /// In a word.
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

/// Where a scan was taken; NaN where there is no number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// Number of the scan, from 0.
    pub scan: f64,
    /// Its time, s.
    pub stamp_s: f64,
    /// `[x, y, θ]` on the map, m and rad.
    pub pose: [f64; 3],
    /// How far that is localized.
    pub belief: Belief,
    /// Share of the scan that fits there.
    pub fit: f64,
    /// Half axes of the 1σ ellipse, m, and the heading of the long one, rad.
    pub ellipse: [f64; 3],
}

impl Place {
    fn from_numbers(numbers: &[f64]) -> Option<Self> {
        (0.0..=MOST_SCANS).contains(&numbers[0]).then_some(Self {
            scan: numbers[0],
            stamp_s: numbers[1],
            pose: [numbers[2], numbers[3], numbers[4]],
            belief: Belief::from_number(numbers[5])?,
            fit: numbers[6],
            ellipse: [numbers[7], numbers[8], numbers[9]],
        })
    }
}

/// Another log on this map.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Whereabouts {
    /// Name of its file.
    pub name: String,
    /// Share of it that is done.
    pub share: f64,
    /// Whether no scan follows.
    pub is_over: bool,
    /// Scans found, followed, doubtful, lost.
    pub counts: [f64; 4],
    /// The first scan that is localized, from 0; NaN where none is.
    pub first: f64,
    /// What its owner should know, a sentence each.
    pub remarks: Vec<String>,
    /// Where the scans were taken, in order.
    pub places: Vec<Place>,
}

impl Whereabouts {
    /// What a delivery tells; none where it does not hold what it has to.
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
                .filter_map(Place::from_numbers)
                .collect(),
        })
    }

    /// Scans whose pose is localized.
    #[must_use]
    pub fn localized(&self) -> f64 {
        self.counts[0] + self.counts[1]
    }
}
