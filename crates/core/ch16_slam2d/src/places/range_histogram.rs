//! Histogram of the ranges of a scan.

use pr_geom::math;

use crate::cloud::PointCloud;

/// The bins of a [`RangeHistogram`]; the default is exercise 7 of the chapter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HistogramConfig {
    /// Number of bins of equal width.
    pub bins: usize,
    /// End of the last bin, m; farther returns count in it.
    pub max_range_m: f64,
}

impl Default for HistogramConfig {
    fn default() -> Self {
        Self {
            bins: 64,
            max_range_m: 6.0,
        }
    }
}

/// Shares of the points by their distance from the sensor: they sum to 1, or to 0 without points.
#[derive(Clone, Debug, PartialEq)]
pub struct RangeHistogram {
    shares: Vec<f64>,
}

impl RangeHistogram {
    /// The histogram of a scan in its sensor's frame.
    #[must_use]
    pub fn new(scan: &PointCloud, config: &HistogramConfig) -> Self {
        let last = config.bins.saturating_sub(1);
        let per_metre = config.bins as f64 / config.max_range_m;
        let mut counts = vec![0_u32; config.bins];
        for point in scan.iter() {
            let bin = (math::norm2(point.x, point.y) * per_metre) as usize;
            if let Some(count) = counts.get_mut(bin.min(last)) {
                *count += 1;
            }
        }
        let total = f64::from(counts.iter().sum::<u32>().max(1));
        Self {
            shares: counts.iter().map(|&c| f64::from(c) / total).collect(),
        }
    }

    /// The shares by bin, nearest first.
    #[must_use]
    pub fn shares(&self) -> &[f64] {
        &self.shares
    }

    /// The χ² distance `½ Σ (a − b)²/(a + b)`: 0 for equals, 1 if no bin is shared.
    #[must_use]
    pub fn distance(&self, other: &Self) -> f64 {
        let bins = self.shares.iter().zip(&other.shares);
        let terms = bins.map(|(a, b)| {
            let (difference, sum) = (a - b, a + b);
            if sum > 0.0 {
                difference * difference / sum
            } else {
                0.0
            }
        });
        0.5 * terms.sum::<f64>()
    }
}

#[cfg(test)]
mod tests {
    use pr_geom::{Point2, SE2};

    use super::*;

    fn of(ranges_m: &[f64]) -> RangeHistogram {
        let points = ranges_m.iter().map(|&range| Point2::new(0.0, -range));
        RangeHistogram::new(&points.collect(), &HistogramConfig::default())
    }

    #[test]
    fn the_distance_is_that_of_chi_squared() {
        let (a, b) = (of(&[0.5, 0.5, 2.0, 3.0]), of(&[0.5, 2.0, 2.0, 2.0]));
        // Shares (½, ¼, ¼) and (¼, ¾, 0): ½ (1/16 / ¾ + ¼ / 1 + 1/16 / ¼) = 7/24.
        assert!((a.distance(&b) - 7.0 / 24.0).abs() < 1e-15);
        assert_eq!(a.distance(&b), b.distance(&a));
        assert_eq!(a.distance(&a), 0.0);
        assert_eq!(of(&[1.0]).distance(&of(&[4.0])), 1.0);
    }

    #[test]
    fn the_histogram_is_rotation_invariant_and_keeps_far_returns() {
        let cloud: PointCloud = (1..40)
            .map(|k| Point2::new(0.2 * f64::from(k) + 0.01, 0.05))
            .collect();
        let config = HistogramConfig::default();
        let turned = cloud.transformed(&SE2::new(0.0, 0.0, 2.1));
        let (a, b) = (
            RangeHistogram::new(&cloud, &config),
            RangeHistogram::new(&turned, &config),
        );
        assert_eq!(a, b);
        assert!((a.shares().iter().sum::<f64>() - 1.0).abs() < 1e-12);
        assert!(of(&[]).shares().iter().all(|share| *share == 0.0));
    }
}
