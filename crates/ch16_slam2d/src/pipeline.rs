//! Runs the estimator on a recorded log: scans with odometry in, trajectory and map out.
//!
//! [`Pipeline::step`] takes one scan, [`Pipeline::finish`] ends the log, [`Pipeline::trajectory`] returns the
//! pose of every scan. The command line, the page's worker and the examples all use it.
//!
//! It reads no files and does not repair stamps: scans have to be in order of time.

use pr_geom::SE2;
use serde::{Deserialize, Serialize};

use crate::scan::{Frame, FrameError, LaserScan};
use crate::slam::{Conclusion, RobotConfig, Slam, SlamConfig, SlamReport, SlamSnapshot};

/// A scan of a log, with the odometry at its time.
#[derive(Clone, Debug, PartialEq)]
pub struct LogFrame {
    /// Time of the scan, s; the index of the scan if the log has no times.
    pub stamp_s: f64,
    /// Pose of the body in the odometry's frame, if the log has one.
    pub odometry: Option<SE2>,
    /// The scan with its geometry.
    pub scan: LaserScan,
}

/// Pose of a scan in the frame of the previous keyframe, because loops move that.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ScanPose {
    /// Time of the scan, s.
    pub stamp_s: f64,
    /// The keyframe.
    pub keyframe: usize,
    /// Pose of the body in the keyframe's frame.
    pub keyframe_from_body: SE2,
}

/// Whether odometry predicts the motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum OdometryUse {
    /// The odometry of the log predicts each scan.
    #[default]
    Log,
    /// Scans alone: the prediction is constant velocity.
    None,
}

/// The estimator for recorded logs, with the pose of each scan.
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
    /// The estimator after the last scan, before its keyframes were linked again.
    before_finish: Option<SlamSnapshot>,
}

impl Pipeline {
    /// A pipeline without scans that derives its settings from the first scan.
    #[must_use]
    pub fn new(odometry_use: OdometryUse) -> Self {
        Self {
            odometry_use,
            ..Self::default()
        }
    }

    /// The same pipeline with these settings.
    #[must_use]
    pub fn with_config(mut self, robot: RobotConfig) -> Self {
        self.robot = Some(robot);
        self
    }

    /// A pipeline that continues with an estimator, the poses of its scans and the last odometry.
    #[must_use]
    pub fn resume(
        slam: Slam,
        scans: Vec<ScanPose>,
        last_odometry: Option<SE2>,
        odometry_use: OdometryUse,
    ) -> Self {
        Self {
            slam: Some(slam),
            scans,
            last_odometry,
            ..Self::new(odometry_use)
        }
    }

    /// The same pipeline with its log ended; `before_finish` is its estimator before the keyframes were linked
    /// again.
    #[must_use]
    pub fn resume_finished(mut self, before_finish: SlamSnapshot) -> Self {
        self.before_finish = Some(before_finish);
        self
    }

    /// Takes the next scan.
    ///
    /// # Errors
    /// If it is not after the previous one, or if it is not a valid scan; the pipeline is unchanged.
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
            Slam::new(SlamConfig::from_robot(robot))
        });
        let report = slam.step(&frame)?;
        self.last_odometry = recorded.odometry;
        self.before_finish = None;
        let keyframe = slam.keyframes().len() - 1;
        self.scans.push(ScanPose {
            stamp_s,
            keyframe,
            keyframe_from_body: slam.graph().pose(keyframe).between(&report.estimate),
        });
        Ok(report)
    }

    /// The motion since the previous scan by odometry; `None` if there is none, or if it is not used.
    #[must_use]
    pub fn motion(&self, recorded: &LogFrame) -> Option<SE2> {
        match (self.odometry_use, self.last_odometry, recorded.odometry) {
            (OdometryUse::Log, Some(last), Some(now)) => Some(last.between(&now)),
            _ => None,
        }
    }

    /// Ends the log: closes pending loops if nothing contradicts them, and links keyframes again. Returns `None` if
    /// there was no scan since the last call.
    pub fn finish(&mut self) -> Option<Conclusion> {
        let slam = self
            .slam
            .as_mut()
            .filter(|_| self.before_finish.is_none())?;
        self.before_finish = Some(slam.snapshot());
        Some(slam.conclude())
    }

    /// The estimator; `None` before the first scan.
    #[must_use]
    pub fn slam(&self) -> Option<&Slam> {
        self.slam.as_ref()
    }

    /// The estimator, mutable, for manual changes of its graph; `None` before the first scan.
    pub fn slam_mut(&mut self) -> Option<&mut Slam> {
        self.slam.as_mut()
    }

    /// The estimator after the last scan, before [`finish`](Self::finish) linked its keyframes again: the
    /// start for a later log. `None` before the first scan.
    #[must_use]
    pub fn snapshot_before_finish(&self) -> Option<SlamSnapshot> {
        let slam = self.slam.as_ref()?;
        Some(
            self.before_finish
                .clone()
                .unwrap_or_else(|| slam.snapshot()),
        )
    }

    /// Whether the log was ended.
    #[must_use]
    pub fn is_finished(&self) -> bool {
        self.before_finish.is_some()
    }

    /// The scans so far, in order.
    #[must_use]
    pub fn scans(&self) -> &[ScanPose] {
        &self.scans
    }

    /// The odometry of the last scan.
    #[must_use]
    pub fn last_odometry(&self) -> Option<SE2> {
        self.last_odometry
    }

    /// Time (s) and pose `world_from_body` of every scan, by the present graph.
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
    fn every_scan_has_a_pose_and_one_out_of_order_is_rejected() {
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
