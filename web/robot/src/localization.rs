//! “Where am I?”: localizes another log on the current map, scan by scan.
//!
//! The update `where` contains seven numbers on the whole log ([`HEAD`]), then ten for each scan
//! ([`PLACE`]); its text is the log's name, followed by messages, one sentence per line.
//! Poses are stored relative to their nearest keyframes, and so move with them when the user edits the map.

use ch16_slam2d::localize::{LocalizeReport, StartPose, Verdict};
use ch16_slam2d::metrics::position_error_m;
use pr_geom::SE2;
use robot_io::localize::LocalizeRun;
use robot_io::log::{LogNotes, LogReader};
use robot_io::quality::KeyframeQuality;
use robot_io::run::late_scans;
use robot_io::session::Session;
use robot_io::trajectory::{StampedPose, Trajectory};

use crate::given::{Choices, Given, compared};
use crate::update::Update;

/// Share done, whether it is over, and the number of scans by verdict: found, tracking, doubtful, lost; then
/// the first localized scan, counted from 0, or NaN.
pub const HEAD: usize = 7;
/// Scan number, stamp (s), x, y (m), θ (rad), verdict, score, then the half axes of the
/// 1σ ellipse, long and short (m), and the heading of the long one (rad); NaN if unknown.
pub const PLACE: usize = 10;
/// Most scans in an update: of a longer log every n-th scan is sent.
const MAX_SENT: usize = 20_000;
/// An update is sent once the number of scans has grown by this factor.
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
        choices: &Choices,
        session: &Session,
        start: StartPose,
    ) -> Result<Self, String> {
        let reader = compared(&given, choices)?;
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
            self.problem = Some(match self.run.refused() {
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

    /// The update, if there is anything new.
    pub fn update(&mut self, map: &[SE2]) -> Option<Update> {
        if !core::mem::take(&mut self.is_new) {
            return None;
        }
        let reports = self.run.reports();
        self.sent = reports.len();
        let count = |verdict| {
            let of_it = reports.iter().filter(|report| report.verdict == verdict);
            of_it.count() as f64
        };
        let first = reports
            .iter()
            .position(|report| report.verdict.is_localized());
        let mut numbers = vec![
            self.share(),
            f64::from(u8::from(self.is_over)),
            count(Verdict::Found),
            count(Verdict::Tracking),
            count(Verdict::Doubtful),
            count(Verdict::Lost),
            first.map_or(f64::NAN, |first| first as f64),
        ];
        let stride = reports.len().div_ceil(MAX_SENT).max(1);
        let posed = reports.iter().zip(&self.poses).enumerate();
        for (number, (report, anchored)) in posed.step_by(stride) {
            let pose = anchored.and_then(|anchored| world_pose(map, anchored));
            numbers.extend(pose_numbers(number, report, pose));
        }
        let mut lines = vec![self.name.clone()];
        lines.extend(self.problem.clone());
        if self.is_over && !reports.is_empty() {
            lines.extend(self.remarks(self.reader.notes()));
        }
        Some(Update {
            text: lines.join("\n"),
            ..Update::numbers("where", numbers)
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

fn pose_numbers(number: usize, report: &LocalizeReport, pose: Option<SE2>) -> [f64; PLACE] {
    let [x, y, theta] = pose.map_or([f64::NAN; 3], |pose| pose.to_array());
    let ellipse = report.covariance.map(|known| {
        let known = KeyframeQuality {
            stamp_s: report.stamp_s,
            pose: [x, y, theta],
            covariance: core::array::from_fn(|i| core::array::from_fn(|j| known[(i, j)])),
        };
        known.ellipse()
    });
    let (long, short, heading) = ellipse.unwrap_or((f64::NAN, f64::NAN, f64::NAN));
    let verdict = match report.verdict {
        Verdict::Found => 0.0,
        Verdict::Tracking => 1.0,
        Verdict::Doubtful => 2.0,
        Verdict::Lost => 3.0,
    };
    let fit = report.score.unwrap_or(f64::NAN);
    [
        number as f64,
        report.stamp_s,
        x,
        y,
        theta,
        verdict,
        fit,
        long,
        short,
        heading,
    ]
}
