//! Statistics of a list of errors.

use pr_geom::{math, sort_numbers};
use serde::Serialize;

/// Mean, standard deviation and percentiles of a list of errors.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Spread {
    /// Mean.
    pub mean: f64,
    /// Standard deviation of the population: divided by n.
    pub std: f64,
    /// 50th percentile.
    pub median: f64,
    /// 95th percentile.
    pub p95: f64,
}

impl Spread {
    /// Computes the statistics; all zero if the list is empty.
    #[must_use]
    pub fn from_values(errors: &[f64]) -> Self {
        let mut sorted = errors.to_vec();
        sort_numbers(&mut sorted);
        let (mean, std) = mean_and_std(errors);
        Self {
            mean,
            std,
            median: percentile(&sorted, 0.5),
            p95: percentile(&sorted, 0.95),
        }
    }
}

/// The statistics that evo prints.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct PoseErrors {
    /// Root of the mean square.
    pub rmse: f64,
    /// Mean.
    pub mean: f64,
    /// Median.
    pub median: f64,
    /// Standard deviation, divided by n.
    pub std: f64,
    /// Smallest.
    pub min: f64,
    /// Largest.
    pub max: f64,
    /// Sum of the squares.
    pub sse: f64,
}

impl PoseErrors {
    /// Computes the statistics; all zero if the list is empty.
    #[must_use]
    pub fn from_errors(errors: &[f64]) -> Self {
        let mut sorted = errors.to_vec();
        sort_numbers(&mut sorted);
        let (mean, std) = mean_and_std(errors);
        let sse: f64 = errors.iter().map(|e| e * e).sum();
        Self {
            rmse: math::sqrt(sse / errors.len().max(1) as f64),
            mean,
            median: percentile(&sorted, 0.5),
            std,
            min: sorted.first().copied().unwrap_or_default(),
            max: sorted.last().copied().unwrap_or_default(),
            sse,
        }
    }
}

fn mean_and_std(errors: &[f64]) -> (f64, f64) {
    if errors.is_empty() {
        return (0.0, 0.0);
    }
    let count = errors.len() as f64;
    let mean = errors.iter().sum::<f64>() / count;
    let squares: f64 = errors.iter().map(|e| (e - mean) * (e - mean)).sum();
    (mean, math::sqrt(squares / count))
}

/// Interpolates linearly between the two errors around the percentile.
fn percentile(sorted: &[f64], share: f64) -> f64 {
    let Some(last) = sorted.len().checked_sub(1) else {
        return 0.0;
    };
    let rank = share * last as f64;
    let below = rank as usize;
    let above = (below + 1).min(last);
    sorted[below] + (rank - below as f64) * (sorted[above] - sorted[below])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_to_five_have_the_mean_and_median_of_three() {
        let found = Spread::from_values(&[5.0, 1.0, 4.0, 2.0, 3.0]);
        assert_eq!((found.mean, found.median), (3.0, 3.0));
        assert!((found.std - 2.0_f64.sqrt()).abs() < 1e-15);
        assert!((found.p95 - 4.8).abs() < 1e-12);
        let none = PoseErrors::from_errors(&[]);
        assert_eq!((none.rmse, none.max), (0.0, 0.0));
    }
}
