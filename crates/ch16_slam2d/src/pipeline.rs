//! A recorded log through the estimator: scans with odometry in, trajectory and map out.
//!
//! [`Pipeline::step`] takes one scan, [`Pipeline::finish`] ends the log, [`Pipeline::trajectory`] says where
//! every scan was taken. The command, the page's worker and the recipes run this and nothing else.
//!
//! It reads no file, and it repairs no stamps: scans come in the order of time.

use pr_geom::SE2;

use crate::graph::PoseGraph;
use crate::scan::{Frame, FrameError, LaserScan};
use crate::slam::{Conclusion, RobotConfig, Slam, SlamConfig, SlamReport, SlamSnapshot};

/// A scan of a log, with the odometry at its time.
#[derive(Clone, Debug, PartialEq)]
pub struct LogFrame {
    /// Time of the scan, s; the number of the scan if the log has no times.
    pub stamp_s: f64,
    /// Pose of the body in the odometry's frame, if the log has one.
    pub odometry: Option<SE2>,
    /// The scan with its geometry.
    pub scan: LaserScan,
}

/// Where a scan was taken: in the frame of the keyframe before it, because loops move that.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScanPose {
    /// Time of the scan, s.
    pub stamp_s: f64,
    /// The keyframe.
    pub keyframe: usize,
    /// Pose of the body in the keyframe's frame.
    pub keyframe_from_body: SE2,
}

/// Whether the odometry predicts the motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum OdometryUse {
    /// The odometry of the log predicts each scan.
    #[default]
    Log,
    /// Scans alone: the velocity is expected to stay.
    None,
}

/// The estimator for recorded logs, with where each scan was taken.
///
/// ```
/// use ch16_slam2d::pipeline::{Pipeline, LogFrame};
/// use ch16_slam2d::scan::LaserScan;
/// use pr_geom::SE2;
///
/// // A robot in a round hall of 3 m, a scan every 10 cm.
/// let scans = (0..20).map(|k| LogFrame {
///     stamp_s: f64::from(k),
///     odometry: Some(SE2::translation(0.1 * f64::from(k), 0.0)),
///     scan: LaserScan {
///         angle_step_rad: 0.05,
///         ranges_m: vec![3.0; 120],
///         ..LaserScan::default()
///     },
/// });
/// let mut pipeline = Pipeline::default();
/// for scan in scans {
///     pipeline.step(&scan).unwrap();
/// }
/// pipeline.finish();
/// assert_eq!(pipeline.trajectory().count(), 20);
/// ```
#[derive(Clone, Default)]
pub struct Pipeline {
    odometry_use: OdometryUse,
    robot: Option<RobotConfig>,
    slam: Option<Slam>,
    scans: Vec<ScanPose>,
    last_odometry: Option<SE2>,
    /// The estimator after the last scan, before its keyframes were linked once more.
    driven: Option<SlamSnapshot>,
}

impl Pipeline {
    /// A pipeline that has seen nothing and takes its numbers from the first scan.
    #[must_use]
    pub fn new(odometry_use: OdometryUse) -> Self {
        Self {
            odometry_use,
            ..Self::default()
        }
    }

    /// The same pipeline with these numbers.
    #[must_use]
    pub fn with_config(mut self, robot: RobotConfig) -> Self {
        self.robot = Some(robot);
        self
    }

    /// A pipeline that goes on with an estimator, the poses of its scans and the last odometry.
    #[must_use]
    pub fn resume(
        slam: Slam,
        scans: Vec<ScanPose>,
        last_odometry: Option<SE2>,
        odometry_use: OdometryUse,
    ) -> Self {
        Self {
            slam: Some(slam.with_outlier_test(PoseGraph::inlier_edges)),
            scans,
            last_odometry,
            ..Self::new(odometry_use)
        }
    }

    /// The same pipeline with its log ended: its estimator was `driven` before its keyframes were linked once
    /// more.
    #[must_use]
    pub fn ended(mut self, driven: SlamSnapshot) -> Self {
        self.driven = Some(driven);
        self
    }

    /// Takes the next scan.
    ///
    /// # Errors
    /// If it is not after the one before it, or if its numbers are no scan; the pipeline stays as it was.
    pub fn step(&mut self, recorded: &LogFrame) -> Result<SlamReport, FrameError> {
        let stamp_s = recorded.stamp_s;
        let frame = Frame {
            stamp_s,
            odometry: self.motion(recorded),
            scan: recorded.scan.clone(),
        };
        let robot = self.robot;
        let slam = self.slam.get_or_insert_with(|| {
            let robot = robot.unwrap_or_else(|| RobotConfig::for_scan(&frame.scan));
            Slam::new(SlamConfig::from_robot(robot)).with_outlier_test(PoseGraph::inlier_edges)
        });
        let report = slam.step(&frame)?;
        self.last_odometry = recorded.odometry;
        self.driven = None;
        let keyframe = slam.keyframes().len() - 1;
        self.scans.push(ScanPose {
            stamp_s,
            keyframe,
            keyframe_from_body: slam.graph().pose(keyframe).between(&report.estimate),
        });
        Ok(report)
    }

    /// The motion since the scan before by the odometry; `None` if there is none, or if it is not used.
    #[must_use]
    pub fn motion(&self, recorded: &LogFrame) -> Option<SE2> {
        match (self.odometry_use, self.last_odometry, recorded.odometry) {
            (OdometryUse::Log, Some(last), Some(now)) => Some(last.between(&now)),
            _ => None,
        }
    }

    /// Ends the log: loops that wait are closed if nothing contradicts them, and keyframes are linked once
    /// more. What it did; `None` without a scan since the last time.
    pub fn finish(&mut self) -> Option<Conclusion> {
        let slam = self.slam.as_mut().filter(|_| self.driven.is_none())?;
        self.driven = Some(slam.snapshot());
        Some(slam.conclude())
    }

    /// The estimator; `None` before the first scan.
    #[must_use]
    pub fn slam(&self) -> Option<&Slam> {
        self.slam.as_ref()
    }

    /// The estimator, for whoever changes its graph by hand; `None` before the first scan.
    pub fn slam_mut(&mut self) -> Option<&mut Slam> {
        self.slam.as_mut()
    }

    /// The estimator after the last scan, before [`finish`](Self::finish) linked its keyframes once more: what a
    /// later log goes on with. None before the first scan.
    #[must_use]
    pub fn driven(&self) -> Option<SlamSnapshot> {
        let slam = self.slam.as_ref()?;
        Some(self.driven.clone().unwrap_or_else(|| slam.snapshot()))
    }

    /// Whether the log was ended.
    #[must_use]
    pub fn is_finished(&self) -> bool {
        self.driven.is_some()
    }

    /// The scans that were taken, in order.
    #[must_use]
    pub fn scans(&self) -> &[ScanPose] {
        &self.scans
    }

    /// The odometry of the last scan.
    #[must_use]
    pub fn last_odometry(&self) -> Option<SE2> {
        self.last_odometry
    }

    /// Time (s) and pose `world_from_body` of every scan, by the graph as it is now.
    pub fn trajectory(&self) -> impl Iterator<Item = (f64, SE2)> + '_ {
        let poses = self
            .slam
            .as_ref()
            .map_or(&[][..], |slam| slam.graph().poses());
        let scans = self.scans.iter();
        scans.map(|scan| (scan.stamp_s, poses[scan.keyframe] * scan.keyframe_from_body))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::metrics::position_error_m;
    use crate::slam::test_room::{frame, truth};

    fn recorded(step: usize) -> LogFrame {
        let frame = frame(step);
        LogFrame {
            stamp_s: frame.stamp_s,
            odometry: Some(truth(0).between(&truth(step))),
            scan: frame.scan,
        }
    }

    #[test]
    fn every_scan_has_a_pose_and_one_out_of_order_is_refused() {
        let mut pipeline = Pipeline::default();
        for step in 0..60 {
            pipeline.step(&recorded(step)).unwrap();
        }
        let late = pipeline.step(&recorded(10)).unwrap_err();
        assert!(matches!(late, FrameError::Stamp { .. }), "{late}");
        assert!(pipeline.finish().is_some() && pipeline.finish().is_none());
        let start = truth(0);
        for (step, (_, pose)) in pipeline.trajectory().enumerate() {
            let error_m = position_error_m(&pose, &start.between(&truth(step)));
            // 0.05: a cell of the thinned scans.
            assert!(error_m < 0.05, "{step}: {error_m}");
        }
    }
}
