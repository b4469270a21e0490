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
    /// The second component of a mixture: odometry that slipped.
    pub slip: Option<Slip>,
}

/// Odometry that slipped, jumped or stood still: the motion is known only roughly.
///
/// Student's tail costs the more, the smaller the deviation that is expected: after a step of centimetres a slip of half
/// a metre would be ten times as unlikely as after one of a metre. Wheels slip at a rate, whatever the step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slip {
    /// Its probability.
    pub rate: f64,
    /// Standard deviation of the position along each axis, m.
    pub sigma_m: f64,
    /// Standard deviation of the heading, rad.
    pub sigma_rad: f64,
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
        let deviation = self.deviation(pose);
        let rolled = self.component_cost(&deviation, self.sigma_m, self.sigma_rad);
        let Some(slip) = &self.slip else {
            return rolled;
        };
        let slipped = self.slipped_cost(&deviation, slip);
        let least = math::min(rolled, slipped);
        least - math::ln(math::exp(least - rolled) + math::exp(least - slipped))
    }

    /// Probability of a slip, given the deviation.
    #[must_use]
    pub fn slip_probability(&self, deviation: &Vector3<f64>) -> f64 {
        let Some(slip) = &self.slip else {
            return 0.0;
        };
        let rolled = self.component_cost(deviation, self.sigma_m, self.sigma_rad);
        1.0 / (1.0 + math::exp(self.slipped_cost(deviation, slip) - rolled))
    }

    /// Cost of a slip, against the density at the prediction without one.
    fn slipped_cost(&self, deviation: &Vector3<f64>, slip: &Slip) -> f64 {
        let [wider, turned] = [slip.sigma_m / self.sigma_m, slip.sigma_rad / self.sigma_rad];
        let odds = slip.rate / (1.0 - slip.rate);
        self.component_cost(deviation, slip.sigma_m, slip.sigma_rad)
            + math::ln(wider * wider * turned / odds)
    }

    fn component_cost(&self, deviation: &Vector3<f64>, sigma_m: f64, sigma_rad: f64) -> f64 {
        let (position, heading) = squared(deviation, sigma_m, sigma_rad);
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
        let rolled = self.component_weights(deviation, self.sigma_m, self.sigma_rad);
        let Some(slip) = &self.slip else {
            return rolled;
        };
        let slipped = self.component_weights(deviation, slip.sigma_m, slip.sigma_rad);
        let probability = self.slip_probability(deviation);
        rolled * (1.0 - probability) + slipped * probability
    }

    fn component_weights(
        &self,
        deviation: &Vector3<f64>,
        sigma_m: f64,
        sigma_rad: f64,
    ) -> Vector3<f64> {
        let (position, heading) = squared(deviation, sigma_m, sigma_rad);
        let weight = |dimensions: f64, squared: f64| match self.tail {
            PriorTail::Normal => 1.0,
            PriorTail::Student => (FREEDOM + dimensions) / (FREEDOM + squared),
        };
        let xy = weight(2.0, position) / (sigma_m * sigma_m);
        let theta = weight(1.0, heading) / (sigma_rad * sigma_rad);
        Vector3::new(xy, xy, theta)
    }

    /// Covariance of the motion to the estimated pose: large if the odometry deviates from it.
    #[must_use]
    pub fn covariance(&self, pose: &SE2) -> Matrix3<f64> {
        let weights = self.weights(&self.deviation(pose));
        Matrix3::from_diagonal(&weights.map(|weight| 1.0 / weight))
    }

    /// Squared deviations of position and heading in standard deviations, without a slip.
    #[must_use]
    pub fn squared(&self, deviation: &Vector3<f64>) -> (f64, f64) {
        squared(deviation, self.sigma_m, self.sigma_rad)
    }
}

fn squared(deviation: &Vector3<f64>, sigma_m: f64, sigma_rad: f64) -> (f64, f64) {
    let position = (deviation.x * deviation.x + deviation.y * deviation.y) / (sigma_m * sigma_m);
    let heading = deviation.z * deviation.z / (sigma_rad * sigma_rad);
    (position, heading)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_weights_are_the_derivative_of_the_cost() {
        let slip = Slip {
            rate: 0.05,
            sigma_m: 0.3,
            sigma_rad: 0.5,
        };
        for (tail, slip) in [
            (PriorTail::Student, None),
            (PriorTail::Normal, None),
            (PriorTail::Student, Some(slip)),
        ] {
            let prior = MotionPrior {
                pose: SE2::new(1.0, -2.0, 0.4),
                sigma_m: 0.1,
                sigma_rad: 0.05,
                tail,
                slip,
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
            slip: None,
        };
        let slipped = SE2::new(0.5, 0.0, 0.0);
        // ½ · 5 · ln(1 + 100/3) and ½ · 100.
        assert!((prior(PriorTail::Student).cost(&slipped) - 8.8403).abs() < 1e-3);
        assert!((prior(PriorTail::Normal).cost(&slipped) - 50.0).abs() < 1e-9);
        let wide = prior(PriorTail::Student).covariance(&slipped);
        // (3 + 100)/(3 + 2) times as large as stated.
        assert!((wide[(0, 0)] / (0.05 * 0.05) - 20.6).abs() < 1e-9);
    }

    #[test]
    fn a_slip_costs_about_the_same_after_a_short_and_after_a_long_motion() {
        let cost = |sigma: f64, slip_m: f64, rate: Option<f64>| {
            let prior = MotionPrior {
                pose: SE2::identity(),
                sigma_m: sigma,
                sigma_rad: sigma,
                tail: PriorTail::Student,
                slip: rate.map(|rate| Slip {
                    rate,
                    sigma_m: 0.5,
                    sigma_rad: 0.5,
                }),
            };
            prior.cost(&SE2::new(slip_m, 0.0, slip_m))
        };
        // Both components of the pose off by 0.7 m and 0.7 rad, where 1 cm is expected and where 6 cm are.
        let [short, long] = [0.01, 0.06].map(|sigma| cost(sigma, 0.7, None));
        assert!(short - long > 15.0, "{short}, {long}");
        let [short, long] = [0.01, 0.06].map(|sigma| cost(sigma, 0.7, Some(0.002)));
        assert!((0.0..6.0).contains(&(short - long)), "{short}, {long}");
        // A rate that is ten times as high costs ln 10 less.
        let often = cost(0.01, 0.7, Some(0.02));
        assert!((short - often - 2.32).abs() < 0.05, "{short}, {often}");
    }
}
