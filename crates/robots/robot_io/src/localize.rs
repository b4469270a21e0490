//! Localizes a log on the map of a session, one scan at a time.

use std::sync::Arc;

use ch16_slam2d::localize::{KnownMap, LocalizeConfig, LocalizeReport, Localizer, StartPose};
use ch16_slam2d::scan::{Frame, FrameError};
use ch16_slam2d::search::SearchError;
use pr_geom::SE2;

use crate::log::LogFrame;
use crate::session::Session;
use crate::trajectory::{StampedPose, Trajectory};

/// Localization of a log on a fixed map.
pub struct LocalizeRun {
    localizer: Localizer,
    last_odometry: Option<SE2>,
    last_stamp_s: f64,
    reports: Vec<LocalizeReport>,
    late: usize,
    rejected: Option<FrameError>,
}

impl LocalizeRun {
    /// Starts on the map of a session.
    ///
    /// # Errors
    /// If the session's scans have no points, or extend beyond the largest grid.
    pub fn new(session: &Session, start: StartPose) -> Result<Self, SearchError> {
        let config = LocalizeConfig::default();
        let keyframes = session.snapshot.keyframes.clone();
        let map = Arc::new(KnownMap::new(keyframes, session.poses(), &config)?);
        let slam = session.snapshot.config.clone();
        Ok(Self {
            localizer: Localizer::new(map, slam, config, start),
            last_odometry: None,
            last_stamp_s: f64::NEG_INFINITY,
            reports: Vec::new(),
            late: 0,
            rejected: None,
        })
    }

    /// Takes the next scan; returns `None` if the scan is skipped because its stamp is not later than the one before or
    /// because it is invalid.
    pub fn step(&mut self, log: LogFrame) -> Option<&LocalizeReport> {
        if log.stamp_s <= self.last_stamp_s {
            self.late += 1;
            return None;
        }
        let odometry = self.last_odometry.zip(log.odometry);
        let odometry = odometry.map(|(last, now): (SE2, SE2)| last.between(&now));
        let frame = Frame {
            stamp_s: log.stamp_s,
            odometry,
            scan: log.scan,
        };
        match self.localizer.step(&frame) {
            Ok(report) => self.reports.push(report),
            Err(problem) => {
                self.rejected.get_or_insert(problem);
                return None;
            }
        }
        self.last_stamp_s = log.stamp_s;
        self.last_odometry = log.odometry;
        self.reports.last()
    }

    /// Results, one per scan, in order.
    #[must_use]
    pub fn reports(&self) -> &[LocalizeReport] {
        &self.reports
    }

    /// Number of scans skipped because their stamp was not later than the one before.
    #[must_use]
    pub fn late(&self) -> usize {
        self.late
    }

    /// The reason why the first invalid scan was rejected.
    #[must_use]
    pub fn rejected(&self) -> Option<FrameError> {
        self.rejected
    }

    /// The localized poses, in the frame of the session's map.
    #[must_use]
    pub fn trajectory(&self) -> Trajectory {
        let localized = self
            .reports
            .iter()
            .filter(|report| report.verdict.is_localized());
        let poses = localized.filter_map(|report| {
            report.pose.map(|pose| StampedPose {
                stamp_s: report.stamp_s,
                pose,
            })
        });
        Trajectory::new(poses.collect())
    }
}
