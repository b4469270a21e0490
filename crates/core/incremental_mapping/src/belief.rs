//! Particle filter: a posterior over the pose.

use core::f64::consts::TAU;

use nalgebra::{Point2, Vector3};
use pr_geom::{Rng, SE2, math, wrap_angle};
use serde::Serialize;

use super::LikelihoodMap;
use ch16_slam2d::cloud::PointCloud;

/// Stride of the scan's points in the likelihood of a particle, to reduce its cost.
const POINT_STRIDE: usize = 2;

/// Spread of the particles.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct BeliefSpread {
    /// Standard deviation of the position, `√(σ_x² + σ_y²)`, m.
    pub position_m: f64,
    /// Standard deviation of the heading, rad.
    pub heading_rad: f64,
}

/// Particles with weights, which represent the posterior of the pose.
///
/// The seed determines all random numbers: the same calls give the same bits.
#[derive(Clone, Debug)]
pub struct PoseBelief {
    rng: Rng,
    particles: Vec<SE2>,
    weights: Vec<f64>,
}

impl PoseBelief {
    /// Equally likely particles at one pose; at least one.
    #[must_use]
    pub fn new(pose: SE2, particles: usize, seed: u32) -> Self {
        let count = particles.max(1);
        Self {
            rng: Rng::new(seed),
            particles: vec![pose; count],
            weights: vec![1.0 / count as f64; count],
        }
    }

    /// The particles, `map_from_body`.
    #[must_use]
    pub fn particles(&self) -> &[SE2] {
        &self.particles
    }

    /// Their weights; the sum is 1.
    #[must_use]
    pub fn weights(&self) -> &[f64] {
        &self.weights
    }

    /// Moves every particle by `motion` with independent noise: standard deviations of x and y in
    /// metres and of the heading in radians.
    pub fn predict(&mut self, motion: &SE2, sigma_m: f64, sigma_rad: f64) {
        for particle in &mut self.particles {
            let noise = Vector3::new(
                self.rng.normal(0.0, sigma_m),
                self.rng.normal(0.0, sigma_m),
                self.rng.normal(0.0, sigma_rad),
            );
            *particle = (*particle * *motion).boxplus(&noise);
        }
    }

    /// Multiplies every weight by the likelihood of `scan` on `map`, to the power of `weight`, and resamples
    /// if few particles have most of the weight.
    pub fn weigh(&mut self, map: &LikelihoodMap, scan: &PointCloud, weight: f64) {
        let points: Vec<Point2<f64>> = scan.iter().step_by(POINT_STRIDE).collect();
        let factor = weight * POINT_STRIDE as f64;
        let logs: Vec<f64> = self
            .particles
            .iter()
            .map(|pose| {
                let ratios = points.iter().map(|&p| map.log_ratio(pose.transform(p)));
                factor * ratios.sum::<f64>()
            })
            .collect();
        let largest = logs.iter().copied().fold(f64::NEG_INFINITY, math::max);
        if !largest.is_finite() {
            return;
        }
        for (weight, log) in self.weights.iter_mut().zip(&logs) {
            *weight *= math::exp(log - largest);
        }
        self.normalize();
        let squares: f64 = self.weights.iter().map(|w| w * w).sum();
        if 2.0 < squares * self.particles.len() as f64 {
            self.resample();
        }
    }

    /// Mean of the particles, with the circular mean of the headings.
    #[must_use]
    pub fn mean(&self) -> SE2 {
        let (mut x, mut y, mut cos, mut sin) = (0.0, 0.0, 0.0, 0.0);
        for (pose, weight) in self.particles.iter().zip(&self.weights) {
            x += weight * pose.x();
            y += weight * pose.y();
            cos += weight * pose.rotation().cos;
            sin += weight * pose.rotation().sin;
        }
        SE2::new(x, y, math::atan2(sin, cos))
    }

    /// Spread of the particles.
    #[must_use]
    pub fn spread(&self) -> BeliefSpread {
        let mean = self.mean();
        let (mut position, mut heading) = (0.0, 0.0);
        for (pose, weight) in self.particles.iter().zip(&self.weights) {
            let (x, y) = (pose.x() - mean.x(), pose.y() - mean.y());
            let turn = wrap_angle(pose.theta() - mean.theta());
            position += weight * (x * x + y * y);
            heading += weight * turn * turn;
        }
        BeliefSpread {
            position_m: math::sqrt(position),
            heading_rad: math::sqrt(heading).min(TAU),
        }
    }

    /// Normalizes the weights; if their sum is zero or not finite, they become equal.
    fn normalize(&mut self) {
        let sum: f64 = self.weights.iter().sum();
        let equal = 1.0 / self.particles.len() as f64;
        let is_usable = sum > 0.0 && sum.is_finite();
        for weight in &mut self.weights {
            *weight = if is_usable { *weight / sum } else { equal };
        }
    }

    /// Low-variance resampling with one random number (Thrun, Burgard, Fox 2005, Table 4.4).
    fn resample(&mut self) {
        let count = self.particles.len();
        let step = 1.0 / count as f64;
        let first = self.rng.unit() * step;
        let mut drawn = Vec::with_capacity(count);
        let (mut index, mut sum) = (0, self.weights[0]);
        for k in 0..count {
            let wanted = first + k as f64 * step;
            while sum < wanted && index + 1 < count {
                index += 1;
                sum += self.weights[index];
            }
            drawn.push(self.particles[index]);
        }
        self.particles = drawn;
        self.weights.fill(step);
    }
}

#[cfg(test)]
mod tests {
    use super::super::LikelihoodMapConfig;
    use super::*;

    /// A corner of a room with a post, seen from the origin.
    fn room() -> PointCloud {
        let wall = |k: i32| 0.1 * f64::from(k) - 2.0;
        let south = (0..40).map(|k| Point2::new(wall(k), -1.5));
        let east = (0..40).map(|k| Point2::new(1.9, wall(k)));
        let post = [Point2::new(0.5, 1.0), Point2::new(-0.9, 0.4)];
        south.chain(east).chain(post).collect()
    }

    fn map() -> LikelihoodMap {
        let mut map = LikelihoodMap::new(LikelihoodMapConfig {
            sigma_m: 0.24,
            ..LikelihoodMapConfig::from_cell_size(0.12)
        });
        map.insert(&room(), &SE2::identity());
        map
    }

    #[test]
    fn particles_spread_by_drift_and_converge_on_known_map() {
        let mut belief = PoseBelief::new(SE2::identity(), 800, 7);
        for _ in 0..16 {
            belief.predict(&SE2::identity(), 0.05, 0.01);
        }
        // 16 steps: √16 · 0.05 m along each of two axes.
        let spread = belief.spread();
        assert!((spread.position_m - 0.283).abs() < 0.03, "{spread:?}");
        assert!((spread.heading_rad - 0.04).abs() < 0.004);
        let (map, truth) = (map(), SE2::new(0.3, -0.2, 0.05));
        let scan = room().transformed(&truth.inverse());
        for _ in 0..6 {
            belief.predict(&SE2::identity(), 0.01, 0.003);
            belief.weigh(&map, &scan, 0.1);
        }
        assert!(belief.spread().position_m < 0.5 * spread.position_m);
        let error = truth.between(&belief.mean());
        // 0.08: a third of the field's 0.24 m.
        assert!(math::norm2(error.x(), error.y()) < 0.08, "{error:?}");
        let sum: f64 = belief.weights().iter().sum();
        assert!((sum - 1.0).abs() < 1e-12);
    }

    #[test]
    fn unseen_space_changes_no_weight_and_equal_seeds_give_equal_bits() {
        let run = |seed: u32| {
            let mut belief = PoseBelief::new(SE2::identity(), 50, seed);
            belief.predict(&SE2::new(40.0, 0.0, 0.1), 0.1, 0.1);
            belief.weigh(&map(), &room(), 1.0);
            belief
        };
        let (one, same, other) = (run(3), run(3), run(4));
        assert_eq!(one.particles(), same.particles());
        assert_ne!(one.particles(), other.particles());
        assert!(one.weights().iter().all(|w| (w - 0.02).abs() < 1e-15));
    }

    #[test]
    fn headings_around_half_a_turn_are_averaged_as_directions() {
        let mut belief = PoseBelief::new(SE2::new(0.0, 0.0, core::f64::consts::PI), 400, 1);
        belief.predict(&SE2::identity(), 0.0, 0.1);
        assert!(belief.mean().theta().abs() > 3.1);
        assert!(belief.spread().heading_rad < 0.12);
    }
}
