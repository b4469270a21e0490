//! Motion prior: the distribution of the pose by odometry, before the scan is used.

use nalgebra::{Matrix3, Vector3};
use pr_geom::{SE2, math};

/// Degrees of freedom of Student's distribution: between 1 and 30 the errors are the same.
const FREEDOM: f64 = 3.0;

/// Tail of the distribution of deviations.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PriorTail {
    /// Slipping or pushed wheels: Student's t-distribution, for position and heading separately.
    Student,
    /// Constant velocity: a normal distribution.
    Normal,
}

/// A predicted pose with standard deviations, equal along both axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MotionPrior {
    /// The prediction, `map_from_body`.
    pub pose: SE2,
    /// Standard deviation of the position along each axis, m.
    pub sigma_m: f64,
    /// Standard deviation of the heading, rad.
    pub sigma_rad: f64,
    /// Tail of the distribution of deviations.
    pub tail: PriorTail,
}

impl MotionPrior {
    /// Deviation of a pose, `log(P⁻¹ T)`: m, m, rad.
    #[must_use]
    pub fn deviation(&self, pose: &SE2) -> Vector3<f64> {
        self.pose.between(pose).log()
    }

    /// Negative logarithm of the density at a pose, up to a constant.
    #[must_use]
    pub fn cost(&self, pose: &SE2) -> f64 {
        let (position, heading) = self.squared(&self.deviation(pose));
        match self.tail {
            PriorTail::Normal => 0.5 * (position + heading),
            PriorTail::Student => {
                let cost = |dimensions: f64, squared: f64| {
                    0.5 * (FREEDOM + dimensions) * math::ln(1.0 + squared / FREEDOM)
                };
                cost(2.0, position) + cost(1.0, heading)
            }
        }
    }

    /// Weights of the squared deviations, 1/m², 1/m², 1/rad², which replace the inverse variances in iteratively
    /// reweighted least squares.
    #[must_use]
    pub fn weights(&self, deviation: &Vector3<f64>) -> Vector3<f64> {
        let (position, heading) = self.squared(deviation);
        let weight = |dimensions: f64, squared: f64| match self.tail {
            PriorTail::Normal => 1.0,
            PriorTail::Student => (FREEDOM + dimensions) / (FREEDOM + squared),
        };
        let xy = weight(2.0, position) / (self.sigma_m * self.sigma_m);
        let theta = weight(1.0, heading) / (self.sigma_rad * self.sigma_rad);
        Vector3::new(xy, xy, theta)
    }

    /// Covariance of the motion to the estimated pose: large if the odometry deviates from it.
    #[must_use]
    pub fn covariance(&self, pose: &SE2) -> Matrix3<f64> {
        let weights = self.weights(&self.deviation(pose));
        Matrix3::from_diagonal(&weights.map(|weight| 1.0 / weight))
    }

    /// Squared deviations of position and heading in standard deviations.
    #[must_use]
    pub fn squared(&self, deviation: &Vector3<f64>) -> (f64, f64) {
        let position =
            (deviation.x * deviation.x + deviation.y * deviation.y) / (self.sigma_m * self.sigma_m);
        let heading = deviation.z * deviation.z / (self.sigma_rad * self.sigma_rad);
        (position, heading)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_weights_are_the_derivative_of_the_cost() {
        for tail in [PriorTail::Student, PriorTail::Normal] {
            let prior = MotionPrior {
                pose: SE2::new(1.0, -2.0, 0.4),
                sigma_m: 0.1,
                sigma_rad: 0.05,
                tail,
            };
            let pose = prior.pose * SE2::new(0.35, -0.1, 0.0);
            let deviation = prior.deviation(&pose);
            let weights = prior.weights(&deviation);
            let step = 1e-6;
            let moved = |by: f64| prior.cost(&(prior.pose * SE2::new(0.35 + by, -0.1, 0.0)));
            let slope = (moved(step) - moved(-step)) / (2.0 * step);
            // 1e-6: the third derivative of a logarithm times the square of the step, and rounding.
            assert!(
                (slope - weights.x * deviation.x).abs() < 1e-6 * slope.abs(),
                "{tail:?}"
            );
        }
    }

    #[test]
    fn a_slip_of_ten_sigmas_costs_little_under_students_distribution() {
        let prior = |tail| MotionPrior {
            pose: SE2::identity(),
            sigma_m: 0.05,
            sigma_rad: 0.02,
            tail,
        };
        let slipped = SE2::new(0.5, 0.0, 0.0);
        // ½ · 5 · ln(1 + 100/3) and ½ · 100.
        assert!((prior(PriorTail::Student).cost(&slipped) - 8.8403).abs() < 1e-3);
        assert!((prior(PriorTail::Normal).cost(&slipped) - 50.0).abs() < 1e-9);
        let wide = prior(PriorTail::Student).covariance(&slipped);
        // (3 + 100)/(3 + 2) times as large as stated.
        assert!((wide[(0, 0)] / (0.05 * 0.05) - 20.6).abs() < 1e-9);
    }
}
