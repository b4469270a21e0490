//! What a recording shows about its own scans and its own odometry while it is mapped.
//!
//! A scan at its right pose misfits its local map by an amount that depends on the recording: on its sensor, on the
//! distance between scans, and on what moves. In a dense recording a misfit of a tenth contradicts a pose; where a scan
//! sees a third of unknown space, it does not. The mean misfit of the chosen poses is the scale. Odometry slips rarely
//! on one robot and often on another; the rate is counted the same way.

use pr_geom::{SE2, math};

use super::tuning::{SLIP, STATED_MOTIONS, STATED_SCANS, SURFACES};
use super::{MISS_COST, Slip};

/// Misfit of the scans and slips of the odometry so far.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct RecordingStatistics {
    /// Sum of the misfits at the chosen poses, each 0 to 1.
    misfit: f64,
    /// Number of scans.
    scans: f64,
    /// Sum of the probabilities that the odometry slipped.
    slips: f64,
    /// Number of motions by odometry.
    motions: f64,
}

impl RecordingStatistics {
    /// The number of independent points by which a scan's misfit costs [`SURFACES`] on average, at most that stated.
    pub(super) fn independent_points(&self, stated: f64) -> f64 {
        let misfit_stated = SURFACES / (MISS_COST * stated);
        let mean = (STATED_SCANS * misfit_stated + self.misfit) / (STATED_SCANS + self.scans);
        let learned = SURFACES / (MISS_COST * mean);
        math::min(math::max(learned, SURFACES), stated)
    }

    /// The slip of a motion whose deviations are these if it did not slip, m and rad.
    pub(super) fn slip(&self, motion: &SE2, (sigma_m, sigma_rad): (f64, f64)) -> Slip {
        let ((floor_m, floor_rad), share) = SLIP;
        let driven_m = math::norm2(motion.x(), motion.y());
        Slip {
            rate: (1.0 + self.slips) / (STATED_MOTIONS + self.motions),
            sigma_m: math::max(sigma_m, floor_m + share * driven_m),
            sigma_rad: math::max(sigma_rad, floor_rad + share * motion.theta().abs()),
        }
    }

    /// Counts the misfit of a scan, and the probability of a slip if there was odometry.
    pub(super) fn count(&mut self, misfit: Option<f64>, slip_probability: Option<f64>) {
        if let Some(misfit) = misfit {
            self.misfit += misfit;
            self.scans += 1.0;
        }
        if let Some(probability) = slip_probability {
            self.slips += probability;
            self.motions += 1.0;
        }
    }

    /// The numbers for a snapshot.
    pub(super) fn to_array(self) -> [f64; 4] {
        [self.misfit, self.scans, self.slips, self.motions]
    }

    /// The statistics of a snapshot; `None` if a sum is impossible for its number of scans.
    pub(super) fn from_array([misfit, scans, slips, motions]: [f64; 4]) -> Option<Self> {
        // A sum of ones may be a rounding above their number.
        let is_sum = |sum: f64, count: f64| (0.0..=count + 1e-6 * count).contains(&sum);
        (is_sum(misfit, scans) && is_sum(slips, motions)).then_some(Self {
            misfit,
            scans,
            slips,
            motions,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scans_that_misfit_more_at_their_poses_count_as_fewer_points() {
        let points = |misfit: f64| {
            let mut statistics = RecordingStatistics::default();
            (0..2000).for_each(|_| statistics.count(Some(misfit), None));
            statistics.independent_points(28.0)
        };
        let fresh = RecordingStatistics::default();
        assert!((fresh.independent_points(28.0) - 28.0).abs() < 1e-12);
        assert_eq!(points(0.01), 28.0);
        // 8 / (4.5 · 0.15), and 30 scans of the stated misfit.
        assert!((points(0.15) - 8.0 / (4.5 * 0.15)).abs() < 0.2);
        assert_eq!(points(0.7), SURFACES);
    }

    #[test]
    fn odometry_that_never_slipped_is_believed_more() {
        let rate = |slipped: f64| {
            let mut statistics = RecordingStatistics::default();
            (0..450).for_each(|_| statistics.count(None, Some(slipped)));
            statistics.slip(&SE2::identity(), (0.01, 0.01)).rate
        };
        // 1 of 500 motions, and 46 of them.
        assert!((rate(0.0) - 1.0 / 500.0).abs() < 1e-12);
        assert!((rate(0.1) - 46.0 / 500.0).abs() < 1e-12);
    }

    #[test]
    fn more_slips_than_motions_are_no_statistics() {
        let mut seen = RecordingStatistics::default();
        seen.count(Some(0.1), Some(1.0));
        assert_eq!(RecordingStatistics::from_array(seen.to_array()), Some(seen));
        assert_eq!(RecordingStatistics::from_array([0.1, 1.0, 2.0, 1.0]), None);
        assert_eq!(RecordingStatistics::from_array([-0.1, 1.0, 0.0, 1.0]), None);
    }
}
