//! Summary of a log, updated frame by frame.

use pr_geom::{SE2, math};
use serde::Serialize;

use crate::log::LogFrame;

/// Summary of a log.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
#[non_exhaustive]
pub struct LogInfo {
    /// Number of scans.
    pub scans: usize,
    /// Fewest beams of a scan.
    pub fewest_beams: usize,
    /// Most beams of a scan.
    pub most_beams: usize,
    /// From the first to the last beam of the first scan, degrees.
    pub field_of_view_deg: f64,
    /// Longest range that is a return, m.
    pub longest_return_m: f64,
    /// Returns of the median scan.
    pub median_returns: usize,
    /// From the first scan to the last, s.
    pub duration_s: f64,
    /// Scans whose stamp is not later than that of the scan before.
    pub late: usize,
    /// Path length by odometry, m; `None` without odometry.
    pub odometry_path_length_m: Option<f64>,
    /// Longest step between consecutive scans, m.
    pub longest_step_m: f64,
    /// Largest turn between consecutive scans, degrees.
    pub largest_turn_deg: f64,
    #[serde(skip)]
    first_s: f64,
    #[serde(skip)]
    newest_s: f64,
    #[serde(skip)]
    last_odometry: Option<SE2>,
    /// Histogram of the number of returns per scan.
    #[serde(skip)]
    scans_with: Vec<usize>,
}

impl LogInfo {
    /// Adds the next frame.
    pub fn add(&mut self, frame: &LogFrame) {
        let beams = frame.scan.ranges_m.len();
        if self.scans == 0 {
            self.fewest_beams = beams;
            self.first_s = frame.stamp_s;
            self.newest_s = frame.stamp_s;
            let span = frame.scan.angle_step_rad * beams.saturating_sub(1) as f64;
            self.field_of_view_deg = span.abs().to_degrees();
        } else if frame.stamp_s <= self.newest_s {
            self.late += 1;
        }
        self.scans += 1;
        self.fewest_beams = self.fewest_beams.min(beams);
        self.most_beams = self.most_beams.max(beams);
        self.newest_s = self.newest_s.max(frame.stamp_s);
        self.duration_s = self.newest_s - self.first_s;
        let ranges = frame.scan.ranges_m.iter().copied();
        let mut returns = 0;
        for range_m in ranges.filter(|&range_m| frame.scan.is_return(range_m)) {
            returns += 1;
            self.longest_return_m = self.longest_return_m.max(range_m);
        }
        if self.scans_with.len() <= returns {
            self.scans_with.resize(returns + 1, 0);
        }
        self.scans_with[returns] += 1;
        self.median_returns = self.median();
        if let Some(now) = frame.odometry {
            let path_length_m = self.odometry_path_length_m.get_or_insert(0.0);
            if let Some(last) = self.last_odometry {
                let step = last.between(&now);
                let step_m = math::norm2(step.x(), step.y());
                *path_length_m += step_m;
                self.longest_step_m = self.longest_step_m.max(step_m);
                let turn_deg = step.theta().abs().to_degrees();
                self.largest_turn_deg = self.largest_turn_deg.max(turn_deg);
            }
            self.last_odometry = Some(now);
        }
    }

    fn median(&self) -> usize {
        let mut before = 0;
        for (returns, &count) in self.scans_with.iter().enumerate() {
            before += count;
            if 2 * before >= self.scans {
                return returns;
            }
        }
        0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ch16_slam2d::scan::LaserScan;

    #[test]
    fn a_log_is_counted_frame_by_frame() {
        let mut info = LogInfo::default();
        for (stamp_s, x, range_m) in [(10.0, 0.0, 2.0), (11.0, 0.5, 0.0), (10.5, 1.0, 3.0)] {
            info.add(&LogFrame {
                stamp_s,
                odometry: Some(SE2::from_xy(x, 0.0)),
                scan: LaserScan {
                    angle_step_rad: core::f64::consts::FRAC_PI_2,
                    ranges_m: vec![range_m; 3],
                    ..LaserScan::default()
                },
            });
        }
        assert_eq!((info.scans, info.late, info.median_returns), (3, 1, 3));
        assert_eq!((info.duration_s, info.longest_return_m), (1.0, 3.0));
        assert_eq!(info.odometry_path_length_m, Some(1.0));
        assert!((info.field_of_view_deg - 180.0).abs() < 1e-12);
    }
}
