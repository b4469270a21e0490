//! Consistency of the graph's covariance: the error of a pose beside the covariance that the graph has for it.
//!
//! A covariance describes the scatter of repeated laps. A bias that all laps share is no scatter, and an edge
//! whose information was capped is less certain than its pairs say: both are separate here.

use nalgebra::{Matrix2, Vector2};
use pr_geom::math;

use super::path_errors::path_shares;
use super::record::{LapRecord, LapTrace};

/// Position error of the keyframe halfway along the path, and the graph's covariance of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HalfWay {
    /// Estimate minus truth, world frame, m.
    pub error_m: Vector2<f64>,
    /// The graph's covariance, world frame, m².
    pub covariance_m2: Matrix2<f64>,
}

impl LapRecord {
    /// Halfway of the lap; `None` if its graph has no covariance.
    #[must_use]
    pub fn half_way(&self) -> Option<HalfWay> {
        self.half_way_of(&self.lap)
    }

    /// Halfway of its front end alone.
    #[must_use]
    pub fn front_end_half_way(&self) -> Option<HalfWay> {
        self.half_way_of(&self.front_end)
    }

    fn half_way_of(&self, trace: &LapTrace) -> Option<HalfWay> {
        let end = self.ticks();
        let ticks: Vec<usize> = trace.keyframes.iter().map(|k| k.tick).collect();
        let shares = path_shares(&self.drive, &ticks);
        let from_middle = |node: &usize| (shares[*node] - 0.5).abs();
        let node = (0..shares.len()).min_by(|a, b| from_middle(a).total_cmp(&from_middle(b)))?;
        let pose = trace.poses(end)[node];
        let covariance = trace.graph(end).pose_covariances().ok()?[node];
        // The graph's tangents are in the body frame, translation first.
        let rotation = pose.rotation_matrix();
        let position = covariance.fixed_view::<2, 2>(0, 0);
        Some(HalfWay {
            error_m: pose.translation() - trace.keyframes[node].truth.translation(),
            covariance_m2: rotation * position * rotation.transpose(),
        })
    }
}

/// The errors of many laps beside the covariances of their graphs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LapConsistency {
    /// Length of the mean error, m: what all laps share.
    pub bias_m: f64,
    /// Root of the trace of the errors' covariance, m.
    pub scatter_m: f64,
    /// Root mean trace of the graphs' covariances, m: what the scatter should be.
    pub sigma_m: f64,
    /// Mean of `eᵀ Σ⁻¹ e` (NEES); 2 if the covariances are right and there is no bias.
    pub nees: f64,
}

impl LapConsistency {
    /// Evaluates at least two laps; `None` for fewer, or for a singular covariance.
    #[must_use]
    pub fn of(laps: &[HalfWay]) -> Option<Self> {
        if laps.len() < 2 {
            return None;
        }
        let count = laps.len() as f64;
        let mean = laps.iter().map(|lap| lap.error_m).sum::<Vector2<f64>>() / count;
        let squares = laps.iter().map(|lap| (lap.error_m - mean).norm_squared());
        let traces = laps.iter().map(|lap| lap.covariance_m2.trace());
        let mut nees = 0.0;
        for lap in laps {
            nees += lap
                .error_m
                .dot(&(lap.covariance_m2.try_inverse()? * lap.error_m));
        }
        Some(Self {
            bias_m: math::norm2(mean.x, mean.y),
            scatter_m: math::sqrt(squares.sum::<f64>() / (count - 1.0)),
            sigma_m: math::sqrt(traces.sum::<f64>() / count),
            nees: nees / count,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bias_is_no_scatter_and_raises_the_nees_above_two() {
        let lap = |x: f64, y: f64| HalfWay {
            error_m: Vector2::new(x, y),
            covariance_m2: Matrix2::identity(),
        };
        // Four errors of length 1 about the mean (3, 0): the trace of their covariance is 4/3.
        let laps = [lap(4.0, 0.0), lap(2.0, 0.0), lap(3.0, 1.0), lap(3.0, -1.0)];
        let found = LapConsistency::of(&laps).unwrap();
        assert_eq!(found.bias_m, 3.0);
        // 1e-12: rounding of a square root.
        assert!((found.scatter_m - (4.0_f64 / 3.0).sqrt()).abs() < 1e-12);
        assert!((found.sigma_m - 2.0_f64.sqrt()).abs() < 1e-12);
        // The squares of the bias and of the errors about it.
        assert_eq!(found.nees, 10.0);
        assert_eq!(LapConsistency::of(&laps[..1]), None);
    }
}
