//! Heading noise of a recording's odometry, learned from the scans.

use super::MotionPrior;
use crate::config::tuning::{HEADING_RATE, LEAST_HEADING_NOISE};

/// Median of the size of a normal deviation, in standard deviations.
const MEDIAN: f64 = 0.6745;
/// Information of a scan about the heading, over that of the odometry, from which its heading says how far the odometry
/// is off.
const DECISIVE: f64 = 4.0;

/// Heading noise as a factor on the stated standard deviation.
///
/// The factor follows the median of the innovations of the heading, each of which is the odometry's error and the scan's:
/// it is no less than the odometry's own noise. It is 1 at most, because larger errors are what the tails of the prior
/// are for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct HeadingNoise {
    factor: f64,
}

impl Default for HeadingNoise {
    fn default() -> Self {
        Self { factor: 1.0 }
    }
}

impl HeadingNoise {
    /// That of a snapshot.
    pub fn with_factor(factor: f64) -> Self {
        Self { factor }.limited()
    }

    pub fn factor(self) -> f64 {
        self.factor
    }

    fn limited(self) -> Self {
        Self {
            factor: self.factor.clamp(LEAST_HEADING_NOISE, 1.0),
        }
    }

    /// The prior with this noise in place of the stated one.
    pub fn applied(self, stated: &MotionPrior) -> MotionPrior {
        MotionPrior {
            sigma_rad: self.factor * stated.sigma_rad,
            ..*stated
        }
    }

    /// Learns from a registered heading, `deviation_rad` from the prediction, with the scan's information in 1/rad².
    ///
    /// The deviation is the innovation as far as the scan outweighs the prior, `σ²/(σ² + 1/information)`.
    pub fn learn(&mut self, stated: &MotionPrior, deviation_rad: f64, information: f64) {
        let sigma_rad = self.applied(stated).sigma_rad;
        if information * stated.sigma_rad * stated.sigma_rad < DECISIVE {
            return;
        }
        let innovation_rad =
            deviation_rad.abs() * (1.0 + 1.0 / (information * sigma_rad * sigma_rad));
        if innovation_rad > MEDIAN * sigma_rad {
            self.factor *= HEADING_RATE;
        } else {
            self.factor /= HEADING_RATE;
        }
        *self = self.limited();
    }
}

#[cfg(test)]
mod tests {
    use pr_geom::SE2;

    use super::*;
    use crate::local_map::PriorTail;

    /// Standard deviation of the scans, rad.
    const SCAN_RAD: f64 = 0.003;

    fn stated() -> MotionPrior {
        MotionPrior {
            pose: SE2::identity(),
            sigma_m: 0.05,
            sigma_rad: 0.03,
            tail: PriorTail::Student,
        }
    }

    /// The factor after two thousand innovations of this median size, registered with scans of a standard deviation.
    fn learned(median_rad: f64, scan_rad: f64) -> f64 {
        let mut noise = HeadingNoise::default();
        for step in 0..2000 {
            let innovation_rad = median_rad * f64::from(step % 17) / 8.0;
            let sigma_rad = noise.applied(&stated()).sigma_rad;
            let gain = 1.0 / (1.0 + (scan_rad / sigma_rad) * (scan_rad / sigma_rad));
            noise.learn(
                &stated(),
                gain * innovation_rad,
                1.0 / (scan_rad * scan_rad),
            );
        }
        noise.factor()
    }

    #[test]
    fn the_factor_follows_the_median_of_the_innovations() {
        for share in [0.4, 0.7] {
            let factor = learned(share * MEDIAN * stated().sigma_rad, SCAN_RAD);
            // A tenth: the factor steps by 2 %, up to eight times in a row.
            assert!((factor / share - 1.0).abs() < 0.1, "{share}: {factor}");
        }
    }

    #[test]
    fn the_noise_neither_exceeds_the_stated_one_nor_vanishes() {
        assert!(learned(5.0 * stated().sigma_rad, SCAN_RAD) > 0.8);
        assert!(learned(5.0 * stated().sigma_rad, SCAN_RAD) <= 1.0);
        assert_eq!(learned(0.0, SCAN_RAD), LEAST_HEADING_NOISE);
    }

    #[test]
    fn scans_that_follow_the_odometry_teach_nothing() {
        // In a round room the heading stays where the odometry puts it.
        assert_eq!(learned(0.0, 2.0 * stated().sigma_rad), 1.0);
    }
}
