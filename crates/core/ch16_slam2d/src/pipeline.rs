//! Runs the estimator on a recorded log: scans with odometry in, trajectory and map out.
//!
//! [`Pipeline::step`] takes one scan, [`Pipeline::finish`] ends the log, [`Pipeline::trajectory`] returns the
//! pose of every scan. The command line, the page's worker and the examples all use it.
//!
//! Another day, a restart or a carried robot is one case: a scan that does not continue the run starts a piece, which is
//! mapped on its own and joins the map once the robot is found on it. A piece is never attached where the robot was last
//! seen.
//!
//! It reads no files and does not repair stamps: scans have to be in order of time.

mod continuity;
mod joining;
mod piece;
mod report;

use nalgebra::Vector3;
use pr_geom::{SE2, math};
use serde::{Deserialize, Serialize};

use self::continuity::{Continuity, Pace};
use self::piece::Piece;
use self::report::numbered_after;
pub use self::report::{BridgedGap, LeftOut, PieceFate, PieceReport};
use crate::local_map::LocalMapConfig;
use crate::localize::StartPose;
use crate::scan::{Frame, FrameError, LaserScan};
use crate::slam::{Conclusion, Slam, SlamConfig, SlamReport, SlamSnapshot};

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

impl LogFrame {
    /// Velocity of the body during the sweep by the odometry up to the next scan: that since the last one would be late.
    #[must_use]
    pub fn velocity_until(&self, next: &Self) -> Option<Vector3<f64>> {
        let motion = self.odometry?.between(&next.odometry?);
        let dt_s = next.stamp_s - self.stamp_s;
        (dt_s > 0.0).then(|| motion.log() / math::max(dt_s, self.scan.sweep_s()))
    }
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
///     odometry: Some(SE2::from_xy(0.1 * f64::from(k), 0.0)),
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
    robot: Option<LocalMapConfig>,
    slam: Option<Slam>,
    scans: Vec<ScanPose>,
    last_odometry: Option<SE2>,
    pace: Pace,
    /// The estimator after the last scan, before its keyframes were linked again.
    before_finish: Option<SlamSnapshot>,
    /// The scans since an interruption, until they are found on the map.
    piece: Option<Box<Piece>>,
    pieces: Vec<PieceReport>,
    bridged: Vec<BridgedGap>,
    left_out: Vec<LeftOut>,
    /// Whether the map is that of a session, without a scan of this log.
    is_session: bool,
    /// Where the robot is on the map at the next scan, by the user.
    start: Option<StartPose>,
}

impl Pipeline {
    /// The same pipeline with these settings.
    #[must_use]
    pub fn with_config(mut self, robot: LocalMapConfig) -> Self {
        self.robot = Some(robot);
        self
    }

    /// A pipeline that continues with an estimator, the poses of its scans and the last odometry.
    #[must_use]
    pub fn resume(slam: Slam, scans: Vec<ScanPose>, last_odometry: Option<SE2>) -> Self {
        Self {
            slam: Some(slam),
            scans,
            last_odometry,
            is_session: true,
            ..Self::default()
        }
    }

    /// The same pipeline with its log ended; `before_finish` is its estimator before the keyframes were linked
    /// again.
    #[must_use]
    pub fn resume_finished(mut self, before_finish: SlamSnapshot) -> Self {
        self.before_finish = Some(before_finish);
        self
    }

    /// The same pipeline, whose next scan does not continue the last one: the robot is searched for on the map.
    #[must_use]
    pub fn starting_at(mut self, start: StartPose) -> Self {
        self.start = Some(start);
        self
    }

    /// Takes the next scan.
    ///
    /// The report numbers keyframes as they are once a piece has joined the map. The estimate of a piece that has not
    /// is in its own frame.
    ///
    /// # Errors
    /// If it is not after the previous one, or if it is not a valid scan; the pipeline is unchanged.
    pub fn step(&mut self, recorded: &LogFrame) -> Result<SlamReport, FrameError> {
        let stamp_s = recorded.stamp_s;
        let mut frame = Frame {
            stamp_s,
            odometry: self.motion(recorded),
            scan: recorded.scan.clone(),
        };
        let gap_s = self.gap_s(recorded);
        let mut rough = None;
        match self.continuity(recorded, &frame, gap_s)? {
            Continuity::Predicted => {}
            Continuity::Roughly(found) if self.piece.is_none() => {
                frame.odometry = None;
                rough = Some(found);
                self.bridged.push(BridgedGap { stamp_s, gap_s });
            }
            Continuity::Found(motion) => {
                frame.odometry = Some(motion);
                self.bridged.push(BridgedGap { stamp_s, gap_s });
            }
            Continuity::Roughly(_) | Continuity::Interrupted => {
                frame.odometry = None;
                self.begin_piece(recorded, gap_s);
            }
        }
        let last = self.newest_slam().map(|slam| slam.front_end().estimate());
        let continued = match rough {
            Some(rough) => self.step_roughly(&frame, &rough)?,
            None => None,
        };
        let report = match (continued, &mut self.piece) {
            (Some(report), _) => report,
            (None, Some(piece)) => piece.step(&frame)?,
            (None, None) => {
                let robot = self.robot;
                let slam = self.slam.get_or_insert_with(|| {
                    let robot = robot.unwrap_or_else(|| LocalMapConfig::for_scan(&frame.scan));
                    Slam::new(SlamConfig::from_local_map(robot))
                });
                slam.step(&frame)?
            }
        };
        if gap_s > 0.0 {
            let last = last.filter(|_| report.closed_loop().is_none());
            let motion = last.map(|last| last.between(&report.estimate));
            let score = report
                .registration
                .as_ref()
                .and_then(|found| found.matched.score);
            self.pace.add(gap_s, motion, score);
        }
        self.last_odometry = recorded.odometry;
        self.before_finish = None;
        let (first, slam) = match &self.piece {
            Some(piece) => (self.map_keyframes(), Some(&piece.slam)),
            None => (0, self.slam.as_ref()),
        };
        let (keyframe, pose) = slam.map_or((0, SE2::identity()), |slam| {
            let newest = slam.keyframes().len() - 1;
            (newest, slam.graph().pose(newest))
        });
        self.scans.push(ScanPose {
            stamp_s,
            keyframe: first + keyframe,
            keyframe_from_body: pose.between(&report.estimate),
        });
        if self.piece.is_none() {
            self.is_session = false;
            return Ok(report);
        }
        if let Some(newest) = self.pieces.last_mut() {
            newest.scans += 1;
        }
        self.join(false);
        Ok(numbered_after(first, report))
    }

    /// The time since the last scan, s; zero before the first one.
    fn gap_s(&self, recorded: &LogFrame) -> f64 {
        let last = self.scans.last();
        last.map_or(0.0, |last| recorded.stamp_s - last.stamp_s)
    }

    /// The estimator that takes the next scan.
    fn newest_slam(&self) -> Option<&Slam> {
        match &self.piece {
            Some(piece) => Some(&piece.slam),
            None => self.slam.as_ref(),
        }
    }

    /// How this scan follows the last one.
    fn continuity(
        &self,
        recorded: &LogFrame,
        frame: &Frame,
        gap_s: f64,
    ) -> Result<Continuity, FrameError> {
        let Some(slam) = self.newest_slam().filter(|_| gap_s > 0.0) else {
            return Ok(Continuity::Predicted);
        };
        frame.validate()?;
        if self.start.is_some() {
            return Ok(Continuity::Interrupted);
        }
        let last = self.last_odometry;
        Ok(continuity::continuity(
            slam, last, recorded, gap_s, &self.pace,
        ))
    }

    /// Number of keyframes of the map, without those of a piece.
    fn map_keyframes(&self) -> usize {
        self.slam.as_ref().map_or(0, |slam| slam.keyframes().len())
    }

    /// The pieces so far, in order.
    #[must_use]
    pub fn pieces(&self) -> &[PieceReport] {
        &self.pieces
    }

    /// The gaps without odometry after which the robot was found on the map around its last pose, in order.
    #[must_use]
    pub fn bridged(&self) -> &[BridgedGap] {
        &self.bridged
    }

    /// What was left out since the last call, in order.
    pub fn take_left_out(&mut self) -> Vec<LeftOut> {
        core::mem::take(&mut self.left_out)
    }

    /// The motion since the previous scan by odometry; `None` if there is none.
    #[must_use]
    pub fn motion(&self, recorded: &LogFrame) -> Option<SE2> {
        let (last, now) = (self.last_odometry?, recorded.odometry?);
        Some(last.between(&now))
    }

    /// Ends the log: closes pending loops if nothing contradicts them, and links keyframes again. Returns `None` if
    /// there was no scan since the last call.
    ///
    /// A piece that nothing connects to the map is compared with it, and the shorter one is left out.
    pub fn finish(&mut self) -> Option<Conclusion> {
        self.join(true);
        self.leave_out_shorter();
        let slam = self
            .slam
            .as_mut()
            .filter(|_| self.before_finish.is_none())?;
        self.before_finish = Some(slam.snapshot());
        Some(slam.conclude())
    }

    /// The estimator of the map; `None` before the first scan.
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
    ///
    /// Those of a piece that has not joined the map are in its own frame.
    pub fn trajectory(&self) -> impl Iterator<Item = (f64, SE2)> + '_ {
        let of =
            |slam: Option<&'_ Slam>| slam.map_or(Vec::new(), |slam| slam.graph().poses().to_vec());
        let mut poses = of(self.slam.as_ref());
        poses.extend(of(self.piece.as_ref().map(|piece| &piece.slam)));
        let scans = self.scans.iter();
        scans.map(move |scan| (scan.stamp_s, poses[scan.keyframe] * scan.keyframe_from_body))
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
