//! 7. Loops by the histogram of ranges.

use ch16_listings::PointCloud;

/// Number of bins.
const BINS: usize = 64;

/// Shares of the points by their distance from the sensor.
#[must_use]
pub fn range_histogram(cloud: &PointCloud, max_range: f64) -> [f64; BINS] {
    let mut shares = [0.0; BINS];
    for point in &cloud.points {
        let bin = (point.coords.norm() * (BINS as f64 / max_range)) as usize;
        shares[bin.min(BINS - 1)] += 1.0 / cloud.points.len() as f64;
    }
    shares
}

/// `½ Σ (a − b)²/(a + b)`.
#[must_use]
pub fn chi2_distance(a: &[f64; BINS], b: &[f64; BINS]) -> f64 {
    let terms = a.iter().zip(b).filter(|(a, b)| *a + *b > 0.0);
    0.5 * terms.map(|(a, b)| (a - b).powi(2) / (a + b)).sum::<f64>()
}

/// The nodes whose scans are similar to `node`'s, the most similar first.
#[must_use]
pub fn detect_by_histogram(
    sweeps: &[PointCloud],
    node: usize,
    min_gap: usize,
    max_range: f64,
    max_distance: f64,
) -> Vec<usize> {
    let here = range_histogram(&sweeps[node], max_range);
    let old_enough = (node + 1).saturating_sub(min_gap).min(node);
    let mut alike: Vec<(f64, usize)> = sweeps[..old_enough]
        .iter()
        .enumerate()
        .map(|(old, sweep)| {
            (
                chi2_distance(&range_histogram(sweep, max_range), &here),
                old,
            )
        })
        .filter(|(distance, _)| *distance <= max_distance)
        .collect();
    // Stable: among equal distances the older node stays first.
    alike.sort_by(|a, b| a.0.total_cmp(&b.0));
    alike.into_iter().map(|(_, old)| old).collect()
}
