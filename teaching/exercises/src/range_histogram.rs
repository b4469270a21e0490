//! 7. Place recognition by range histograms (exercise 7 of the page).
//!
//! **Task.** A search around the estimated pose fails if that pose is wrong. Propose loops by the appearance of the
//! sweeps instead: a histogram of ranges does not change if the robot turns.
//!
//! **Formula.** 64 bins of equal width from 0 to `max_range`; longer ranges count in the last one. The histogram
//! holds shares: they sum to 1, or to 0 if there are no points. The χ² distance between two histograms is
//!
//! ```text
//! ½ Σ (aᵢ − bᵢ)² / (aᵢ + bᵢ)        over the bins in which either has a share
//! ```
//!
//! It is 0 for equal histograms, and 1 if they share no bin.

use ch16_listings::PointCloud;

/// Number of bins.
pub const BINS: usize = 64;

/// Shares of the points by their distance from the sensor.
#[must_use]
pub fn range_histogram(cloud: &PointCloud, max_range: f64) -> [f64; BINS] {
    crate::not_written("range_histogram")
}

/// The χ² distance, 0 to 1.
#[must_use]
pub fn chi2_distance(a: &[f64; BINS], b: &[f64; BINS]) -> f64 {
    crate::not_written("range_histogram")
}

/// The nodes whose scans are similar to `node`'s: at least `min_gap` older, within `max_distance`, the most similar
/// first, and among equals the older first.
///
/// `sweeps[k]` is the sweep of node k in its own frame, `max_range` (m) the range of the sensor.
#[must_use]
pub fn detect_by_histogram(
    sweeps: &[PointCloud],
    node: usize,
    min_gap: usize,
    max_range: f64,
    max_distance: f64,
) -> Vec<usize> {
    crate::not_written("range_histogram")
}
