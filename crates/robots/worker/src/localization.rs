//! “Where am I?”: localizes another log on the current map, scan by scan.
//!
//! Poses are stored relative to their nearest keyframes, and so move with them when the user edits the map.

use ch16_slam2d::localize::{LocalizeReport, StartPose, Verdict};
use ch16_slam2d::metrics::position_error_m;
use log_messages::{LocalizationState, LocalizedScan, OtherLog};
use pr_geom::SE2;
use robot_io::localize::LocalizeRun;
use robot_io::log::{LogNotes, LogOptions, LogReader};
use robot_io::quality::KeyframeQuality;
use robot_io::run::late_scans;
use robot_io::session::Session;
use robot_io::trajectory::{StampedPose, Trajectory};

use crate::given::{Given, compared};

/// Most scans in a report: of a longer log every n-th scan is sent.
const MAX_SENT: usize = 20_000;
/// A report is sent once the number of scans has grown by this factor.
const RESEND_GROWTH: f64 = 1.02;

/// A pose relative to a keyframe of the map.
#[derive(Clone, Copy, Debug)]
struct AnchoredPose {
    keyframe: usize,
    keyframe_from_body: SE2,
}

/// Localization of another log on the map.
pub struct Localization<'a> {
    name: String,
    size_bytes: u64,
    reader: Box<dyn LogReader + 'a>,
    run: LocalizeRun,
    /// Poses of the keyframes at the start.
    map: Vec<SE2>,
    poses: Vec<Option<AnchoredPose>>,
    is_over: bool,
    problem: Option<String>,
    sent: usize,
    is_new: bool,
}

impl<'a> Localization<'a> {
    /// Opens a log; `session` is the map.
    ///
    /// # Errors
    /// If the file is not a log, or the session has no map; the message is one sentence.
    pub fn open(
        given: Given<'a>,
        options: &LogOptions,
        session: &Session,
        start: StartPose,
    ) -> Result<Self, String> {
        let reader = compared(&given, options).map_err(|problem| problem.to_string())?;
        let run = LocalizeRun::new(session, start)
            .map_err(|problem| format!("The map cannot be searched: {problem}."))?;
        Ok(Self {
            name: given.name,
            size_bytes: given.size_bytes,
            reader: Box::new(reader),
            run,
            map: session.poses(),
            poses: Vec::new(),
            is_over: false,
            problem: None,
            sent: 0,
            is_new: true,
        })
    }

    /// Localizes the next scan; returns false once there is none.
    pub fn step(&mut self) -> bool {
        if self.is_over {
            return false;
        }
        match self.reader.next_frame() {
            Ok(Some(frame)) => {
                if let Some(report) = self.run.step(frame) {
                    self.poses.push(anchored(&self.map, report));
                }
                let enough = RESEND_GROWTH * self.sent as f64;
                self.is_new |= self.poses.len() as f64 > enough;
            }
            Ok(None) => self.end(),
            Err(problem) => {
                self.problem = Some(problem.to_string());
                self.end();
            }
        }
        true
    }

    /// Ends the log, because no scan follows or the user stopped it.
    pub fn end(&mut self) {
        self.is_over = true;
        self.is_new = true;
        if self.poses.is_empty() && self.problem.is_none() {
            let name = &self.name;
            self.problem = Some(match self.run.rejected() {
                Some(why) => format!("{name}: no scan could be used: {why}"),
                None => format!("{name} was stopped before its first scan"),
            });
        }
    }

    /// Whether the log has ended.
    #[must_use]
    pub fn is_over(&self) -> bool {
        self.is_over
    }

    /// Marks all poses as changed, because the map has moved.
    pub fn moved(&mut self) {
        self.is_new = true;
    }

    /// The localized poses on the current map.
    #[must_use]
    pub fn trajectory(&self, map: &[SE2]) -> Trajectory {
        let posed = self.run.reports().iter().zip(&self.poses);
        let localized = posed.filter(|(report, _)| report.verdict.is_localized());
        let poses = localized.filter_map(|(report, anchored)| {
            Some(StampedPose {
                stamp_s: report.stamp_s,
                pose: anchored.and_then(|anchored| world_pose(map, anchored))?,
            })
        });
        Trajectory::new(poses.collect())
    }

    /// The report, if there is anything new.
    pub fn report(&mut self, map: &[SE2]) -> Option<OtherLog> {
        if !core::mem::take(&mut self.is_new) {
            return None;
        }
        let reports = self.run.reports();
        self.sent = reports.len();
        let count = |verdict| {
            let of_it = reports.iter().filter(|report| report.verdict == verdict);
            of_it.count()
        };
        let mut remarks: Vec<String> = self.problem.iter().cloned().collect();
        if self.is_over && !reports.is_empty() {
            remarks.extend(self.remarks(self.reader.notes()));
        }
        let stride = reports.len().div_ceil(MAX_SENT).max(1);
        let posed = reports.iter().zip(&self.poses).enumerate();
        let places = posed.step_by(stride).map(|(number, (report, anchored))| {
            let pose = anchored.and_then(|anchored| world_pose(map, anchored));
            localized_scan(number, report, pose)
        });
        Some(OtherLog {
            name: self.name.clone(),
            share: self.share(),
            is_over: self.is_over,
            counts: [
                Verdict::Found,
                Verdict::Tracking,
                Verdict::Doubtful,
                Verdict::Lost,
            ]
            .map(count),
            first: reports
                .iter()
                .position(|report| report.verdict.is_localized()),
            remarks,
            places: places.collect(),
        })
    }

    fn share(&self) -> f64 {
        if self.is_over {
            return 1.0;
        }
        let read = self.reader.notes().bytes as f64;
        (read / (self.size_bytes as f64).max(1.0)).min(1.0)
    }

    fn remarks(&self, notes: &LogNotes) -> Vec<String> {
        let mut sentences = notes.sentences(&self.name);
        sentences.extend(late_scans(&self.name, self.run.late()));
        sentences
    }
}

/// The pose relative to the nearest keyframe.
fn anchored(map: &[SE2], report: &LocalizeReport) -> Option<AnchoredPose> {
    let pose = report.pose?;
    let distances = map.iter().map(|at| position_error_m(at, &pose)).enumerate();
    let (keyframe, _) = distances.min_by(|a, b| a.1.total_cmp(&b.1))?;
    Some(AnchoredPose {
        keyframe,
        keyframe_from_body: map[keyframe].between(&pose),
    })
}

fn world_pose(map: &[SE2], anchored: AnchoredPose) -> Option<SE2> {
    Some(*map.get(anchored.keyframe)? * anchored.keyframe_from_body)
}

fn localized_scan(scan: usize, report: &LocalizeReport, pose: Option<SE2>) -> LocalizedScan {
    let pose = pose.map_or([f64::NAN; 3], |pose| pose.to_array());
    let ellipse = report.covariance.map(|known| {
        let known = KeyframeQuality {
            stamp_s: report.stamp_s,
            pose,
            covariance: core::array::from_fn(|i| core::array::from_fn(|j| known[(i, j)])),
        };
        known.ellipse()
    });
    LocalizedScan {
        scan,
        stamp_s: report.stamp_s,
        pose,
        state: match report.verdict {
            Verdict::Found => LocalizationState::Found,
            Verdict::Tracking => LocalizationState::Tracking,
            Verdict::Doubtful => LocalizationState::Doubtful,
            Verdict::Lost => LocalizationState::Lost,
        },
        fit: report.score.unwrap_or(f64::NAN),
        ellipse: ellipse.map_or([f64::NAN; 3], |(long, short, heading)| {
            [long, short, heading]
        }),
    }
}
