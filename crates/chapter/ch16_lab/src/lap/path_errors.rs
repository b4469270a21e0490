//! Errors along the path: the error of the estimate, and the graph's own standard deviation.
//!
//! The final or the largest error does not show where along the path a loop reduced it. Here the true path is
//! cut into shares of equal length.

use pr_geom::math;
use serde::{Deserialize, Serialize};

use super::Drive;
use super::record::{LapRecord, LapTrace};

/// Number of equal shares of the path.
pub const PATH_SHARES: usize = 20;

/// The errors of one estimator at the ends of the shares, from start to end.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PathErrors {
    /// Position errors at the final poses, m; linear between keyframes.
    pub errors_m: [f64; PATH_SHARES + 1],
    /// The graph's standard deviation of the position halfway, `√(σ_x² + σ_y²)` in m; `None` without a
    /// covariance.
    pub half_way_sigma_m: Option<f64>,
}

impl PathErrors {
    /// Position error halfway, m.
    #[must_use]
    pub fn half_path_length_m(&self) -> f64 {
        self.errors_m[PATH_SHARES / 2]
    }
}

impl LapRecord {
    /// The errors of the lap along its path.
    #[must_use]
    pub fn path_errors(&self) -> PathErrors {
        self.path_errors_of(&self.lap)
    }

    /// The errors of its front end alone.
    #[must_use]
    pub fn front_end_path_errors(&self) -> PathErrors {
        self.path_errors_of(&self.front_end)
    }

    fn path_errors_of(&self, trace: &LapTrace) -> PathErrors {
        let end = self.ticks();
        let ticks: Vec<usize> = trace.keyframes.iter().map(|k| k.tick).collect();
        let errors_m: Vec<f64> = trace.keyframe_errors_m(end).collect();
        let sigmas_m = trace.graph(end).pose_covariances().map(|covariances| {
            let positions = covariances.iter().map(|c| math::sqrt(c.m11 + c.m22));
            positions.collect::<Vec<f64>>()
        });
        PathErrors::along_path(&self.drive, &ticks, &errors_m, sigmas_m.ok().as_deref())
    }
}

impl PathErrors {
    /// Errors of keyframes along a drive, from the tick and the error (m) of each in order, and from the
    /// estimator's standard deviation (m) if it has one.
    pub(crate) fn along_path(
        drive: &Drive,
        ticks: &[usize],
        errors_m: &[f64],
        sigmas_m: Option<&[f64]>,
    ) -> Self {
        let shares = path_shares(drive, ticks);
        Self {
            errors_m: core::array::from_fn(|k| {
                interpolated(&shares, errors_m, k as f64 / PATH_SHARES as f64)
            }),
            half_way_sigma_m: sigmas_m.map(|sigmas| interpolated(&shares, sigmas, 0.5)),
        }
    }
}

/// Share of the path at which each keyframe was taken, ascending from 0.
pub(super) fn path_shares(drive: &Drive, ticks: &[usize]) -> Vec<f64> {
    let place = |tick: usize| drive.truth(tick).position();
    let mut path_length_m = vec![0.0];
    for tick in 1..=drive.ticks().len() {
        let step = place(tick) - place(tick - 1);
        path_length_m.push(path_length_m[tick - 1] + math::norm2(step.x, step.y));
    }
    let whole_m = path_length_m[drive.ticks().len()];
    let share = |path_length_m: f64| {
        if whole_m > 0.0 {
            path_length_m / whole_m
        } else {
            0.0
        }
    };
    ticks
        .iter()
        .map(|&tick| share(path_length_m[tick]))
        .collect()
}

/// The value at `share`, linear between keyframes, constant beyond the last one.
fn interpolated(shares: &[f64], values: &[f64], share: f64) -> f64 {
    let after = shares.partition_point(|&known| known <= share);
    let before = after.saturating_sub(1);
    let (Some(&next_share), Some(&next)) = (shares.get(after), values.get(after)) else {
        return values[before];
    };
    let (last_share, last) = (shares[before], values[before]);
    if next_share <= last_share {
        return next;
    }
    last + (next - last) * (share - last_share) / (next_share - last_share)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_between_keyframes_lie_on_the_line_between_them() {
        let (shares, values) = ([0.0, 0.4, 0.4, 0.8], [0.0, 2.0, 6.0, 8.0]);
        let at = |share| interpolated(&shares, &values, share);
        assert_eq!((at(0.0), at(0.2), at(0.4)), (0.0, 1.0, 6.0));
        // 1e-12: 0.6 is halfway between 0.4 and 0.8 up to rounding.
        assert!((at(0.6) - 7.0).abs() < 1e-12);
        assert_eq!((at(0.8), at(1.0)), (8.0, 8.0));
    }
}
