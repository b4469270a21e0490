//! Frames of a recording while it is made: one pass over an MCAP stream.
//!
//! A file is surveyed before its first frame is read. Here the first seconds are surveyed, up to the mounting of the laser
//! and odometry that moves, and the plan is that of these seconds. A scan then waits for the odometry of its time. What
//! only a whole recording shows comes in the notes at the end: topics and transforms that came too late, stamps that a
//! pass over all of them corrects. One laser is read.
//!
//! Scans and poses are decoded as those of a file: for a recording without such faults, the frames are the same bits.

mod clock;

use std::collections::VecDeque;
use std::io::BufRead;
use std::ops::Range;

use self::clock::{LiveClock, StreamStamps};
use super::container::{Container as _, ContainerError, Recorded, kind_of};
use super::cursor::StampedScan;
use super::mcap_file::{LASER_SCAN, McapFile};
use super::messages::header;
use super::plan::{OdometrySource, Plan};
use super::scan_decoder::ScanDecoder;
use super::survey::{BodyPoses, ODOMETRY, SCANS, Survey, is_transforms, named, reader};
use crate::lines::listed;
use crate::log::{FilePosition, LogError, LogFrame, LogNotes, LogOptions, LogReader};
use crate::odometry_poses::LivePoses;
use crate::remark::{Part, Remark};

/// Scans that the survey needs at least.
const FEWEST_SCANS: usize = 10;
/// The survey ends this long after the first scan if the mounting or odometry that moves is missing, s.
const LONGEST_SURVEY_S: f64 = 10.0;
/// Most bytes of messages that wait for the end of the survey.
const MAX_EARLY_BYTES: usize = 1 << 26;
/// A scan waits for its odometry until a stamp is this much later, s, and in periods of the odometry.
const PATIENCE_S: f64 = 1.0;
const PATIENCE_PERIODS: f64 = 2.0;
/// Most scans that wait for their odometry.
const MAX_WAITING: usize = 200;

/// What a topic is read for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MessageUse {
    /// Scans of a laser.
    Scan,
    /// Points of a 3-D sensor or a camera.
    Cloud,
    /// Odometry and transforms.
    Motion,
}

impl MessageUse {
    /// The use of messages of a type in an encoding; `None` if they are not read.
    #[must_use]
    pub fn of(schema: &str, encoding: &str) -> Option<Self> {
        let kind = kind_of(schema);
        if kind == LASER_SCAN {
            return Some(Self::Scan);
        }
        if !matches!(encoding, "cdr" | "ros1") {
            return None;
        }
        match SCANS.iter().position(|scans| *scans == kind) {
            Some(2) => Some(Self::Cloud),
            Some(_) => Some(Self::Scan),
            None if kind == ODOMETRY || is_transforms(&kind) => Some(Self::Motion),
            None => None,
        }
    }
}

/// Reads the frames of a recording that is being made.
pub struct LiveReader<'a> {
    messages: McapFile<Box<dyn BufRead + 'a>>,
    name: String,
    options: LogOptions,
    survey: Survey,
    /// Messages of scans that were surveyed and wait for the plan, and their bytes.
    early: Vec<Recorded>,
    early_bytes: usize,
    /// Time of recording of the first scan, s.
    first_s: Option<f64>,
    started: Option<Started>,
    is_over: bool,
    notes: LogNotes,
}

impl<'a> LiveReader<'a> {
    /// Creates from a stream of MCAP, whose reads wait for what comes next; errors contain `name`.
    #[must_use]
    pub fn new(stream: impl BufRead + 'a, name: &str, options: &LogOptions) -> Self {
        Self {
            messages: McapFile::new(Box::new(stream)),
            name: name.to_owned(),
            options: options.clone(),
            survey: Survey::default(),
            early: Vec::new(),
            early_bytes: 0,
            first_s: None,
            started: None,
            is_over: false,
            notes: LogNotes::default(),
        }
    }

    /// Reads the next message.
    fn advance(&mut self) {
        let message = self.messages.next_message();
        self.notes.bytes = self.messages.offset();
        match message {
            Ok(Some(message)) => self.add(message),
            Ok(None) | Err(ContainerError::CutOff(_)) => self.is_over = true,
            Err(ContainerError::Skipped(problem)) => self.skip(problem),
            Err(ContainerError::Broken(problem)) => {
                self.skip(problem);
                self.is_over = true;
            }
            Err(ContainerError::Io(problem)) => {
                self.skip(problem.to_string());
                self.is_over = true;
            }
        }
        if self.is_over && self.started.is_none() {
            self.start();
        }
    }

    fn skip(&mut self, problem: String) {
        let position = FilePosition::Byte(self.messages.offset());
        self.notes.skip(position, problem);
    }

    fn add(&mut self, message: Recorded) {
        let source = self.started.as_ref().and_then(|live| live.source.clone());
        let known = source.as_ref().map_or(0, |source| {
            track(&self.survey, source).map_or(0, |track| track.poses.len())
        });
        if let Err(problem) = self.survey.add(&message, &self.options) {
            self.skip(problem);
        }
        let Some(live) = &mut self.started else {
            if SCANS.contains(&message.kind.as_str()) {
                self.first_s.get_or_insert(message.recorded_s);
                self.early_bytes += message.bytes.len();
                self.early.push(message);
                if self.is_surveyed() {
                    self.start();
                }
            }
            return;
        };
        let track = source.and_then(|source| track(&self.survey, &source));
        if let Some(track) = track {
            let count = track.poses.len();
            // Thinning has left the last one.
            let from = if count < known { count - 1 } else { known };
            live.add_poses(track, from..count);
        }
        if let Some(problem) = live.add_scan(&message) {
            self.skip(problem);
        }
    }

    /// Whether the messages so far are enough for a plan.
    fn is_surveyed(&self) -> bool {
        let scans = self.survey.scans.values();
        let most = scans.map(|stream| stream.stamps_s.len()).max();
        if most.unwrap_or(0) < FEWEST_SCANS {
            return self.early_bytes > MAX_EARLY_BYTES;
        }
        let last_s = self.early.last().map(|message| message.recorded_s);
        let surveyed_s = last_s.zip(self.first_s).map(|(last, first)| last - first);
        if self.early_bytes > MAX_EARLY_BYTES || surveyed_s.is_none_or(|s| s > LONGEST_SURVEY_S) {
            return true;
        }
        let plan = self.plan();
        let moves = plan.source.is_some_and(|source| source.moves);
        plan.is_mounted && moves && !plan.scans.is_empty()
    }

    /// The plan by the messages so far.
    fn plan(&self) -> Plan {
        let mut survey = self.survey.clone();
        survey.end();
        Plan::new(&survey, &self.options)
    }

    /// Starts with what was surveyed, if it has scans.
    fn start(&mut self) {
        let plan = self.plan();
        let early = std::mem::take(&mut self.early);
        (self.early_bytes, self.first_s) = (0, None);
        // Without scans that are read, the survey goes on: their topic may appear later.
        let Some(mut live) = Started::new(plan, &self.options) else {
            return;
        };
        let source = live.source.clone();
        if let Some(track) = source.and_then(|source| track(&self.survey, &source)) {
            live.add_poses(track, 0..track.poses.len());
        }
        let problems: Vec<String> = early
            .iter()
            .filter_map(|message| live.add_scan(message))
            .collect();
        problems.into_iter().for_each(|problem| self.skip(problem));
        live.plan.write_notes(&self.survey, &mut self.notes);
        self.notes.laser = Some(live.decoder.scans().mount);
        self.started = Some(live);
    }

    /// Why there is no frame.
    fn problem(&self) -> LogError {
        let plan = self.plan();
        let asked = plan.missing.clone().filter(|_| !plan.scans.is_empty());
        if let Some((option, wanted)) = asked {
            return LogError::Missing {
                name: self.name.clone(),
                option: option.name(),
                wanted,
                advice: plan.instead_of(option),
            };
        }
        let broken = self.notes.first_broken.as_ref();
        LogError::NoScans {
            name: self.name.clone(),
            detail: match broken {
                Some(broken) => format!("{}: {}", broken.position, broken.problem),
                None => plan.without_scans().to_owned(),
            },
        }
    }

    /// Completes the notes with what the whole recording shows.
    fn end(&mut self) {
        self.survey.end();
        let whole = Plan::new(&self.survey, &self.options);
        let (about, laser) = (std::mem::take(&mut self.notes.about), self.notes.laser);
        whole.write_notes(&self.survey, &mut self.notes);
        (self.notes.about, self.notes.laser) = (about, laser);
        if let Some(live) = &self.started {
            let remarks = live.remarks(&whole);
            self.notes.warnings.extend(remarks);
        }
    }
}

impl LogReader for LiveReader<'_> {
    fn next_frame(&mut self) -> Result<Option<LogFrame>, LogError> {
        loop {
            if let Some(live) = &mut self.started {
                if live.is_unusable {
                    return Err(self.problem());
                }
                if let Some(frame) = live.next(self.is_over) {
                    return Ok(Some(frame));
                }
            }
            if self.is_over {
                return match &self.started {
                    Some(live) if live.frames > 0 => {
                        self.end();
                        Ok(None)
                    }
                    _ => Err(self.problem()),
                };
            }
            self.advance();
        }
    }

    fn notes(&self) -> &LogNotes {
        &self.notes
    }
}

/// The poses of a source.
fn track<'s>(survey: &'s Survey, source: &OdometrySource) -> Option<&'s BodyPoses> {
    if source.is_transform {
        let key = (source.above.clone(), source.body.clone());
        survey.tracks.get(&key)
    } else {
        survey.odometry.get(&source.topic)
    }
}

/// The second part: scans and odometry by the plan.
struct Started {
    plan: Plan,
    /// Whether an option asks for a name that does not exist.
    is_unusable: bool,
    decoder: ScanDecoder,
    source: Option<OdometrySource>,
    odometry: LivePoses,
    clock: LiveClock,
    stamps: StreamStamps,
    pose_stamps: StreamStamps,
    /// Scans in the order of their stamps.
    waiting: VecDeque<StampedScan>,
    /// Latest stamp so far, s.
    newest_s: f64,
    frames: usize,
    /// Number of scans without odometry although there is a source.
    bare: usize,
}

impl Started {
    /// Starts by a plan; `None` if it has no scans.
    fn new(plan: Plan, options: &LogOptions) -> Option<Self> {
        let scans = plan.scans.first()?.clone();
        let source = plan.source.clone();
        let period_s = source.as_ref().map_or(0.0, |source| source.period_s);
        Some(Self {
            is_unusable: plan.missing.is_some(),
            decoder: ScanDecoder::new(scans, options.heights_m),
            source,
            odometry: LivePoses::new(if period_s.is_finite() { period_s } else { 0.0 }),
            clock: LiveClock::default(),
            stamps: StreamStamps::default(),
            pose_stamps: StreamStamps::default(),
            waiting: VecDeque::new(),
            newest_s: f64::NEG_INFINITY,
            frames: 0,
            bare: 0,
            plan,
        })
    }

    fn add_poses(&mut self, track: &BodyPoses, range: Range<usize>) {
        let by_s = self.source.as_ref().map_or(0.0, |source| source.by_s);
        for at in range {
            let (stated_s, recorded_s) = (track.stamps_s[at], track.recorded_s[at]);
            let stamp_s = self
                .clock
                .stamp_s(&mut self.pose_stamps, stated_s, recorded_s);
            self.odometry.push(stamp_s + by_s, track.poses[at]);
            self.newest_s = self.newest_s.max(stamp_s + by_s);
        }
    }

    /// Adds a message if it is a scan; returns why it is unusable.
    fn add_scan(&mut self, message: &Recorded) -> Option<String> {
        let scan = match self.decoder.read(message)? {
            Ok(scan) => scan,
            Err(problem) => return Some(named(message, problem)),
        };
        let mut fields = reader(message).ok()?;
        let stated_s = header(&mut fields).map_or(f64::NAN, |header| header.stamp_s);
        let stamp_s = self
            .clock
            .stamp_s(&mut self.stamps, stated_s, message.recorded_s)
            + self.plan.scans_by_s;
        if stamp_s.is_finite() {
            let at = self
                .waiting
                .partition_point(|other| other.stamp_s <= stamp_s);
            self.waiting.insert(at, StampedScan { stamp_s, scan });
            self.newest_s = self.newest_s.max(stamp_s);
        }
        None
    }

    /// The next frame, once the odometry of its time has come or is not waited for any longer.
    fn next(&mut self, is_over: bool) -> Option<LogFrame> {
        let stamp_s = self.waiting.front()?.stamp_s;
        let poses = self.odometry.poses();
        let is_ready = is_over
            || self.waiting.len() > MAX_WAITING
            || self.source.as_ref().is_none_or(|source| {
                let patience_s = PATIENCE_S.max(PATIENCE_PERIODS * source.period_s);
                poses.reaches(stamp_s) || self.newest_s - stamp_s > patience_s
            });
        let scan = self.waiting.pop_front_if(|_| is_ready)?;
        let odometry = poses.at(stamp_s);
        self.bare += usize::from(odometry.is_none() && self.source.is_some());
        self.frames += 1;
        Some(LogFrame {
            stamp_s,
            odometry,
            scan: scan.scan,
        })
    }

    /// What the whole recording shows that was unknown at the start.
    fn remarks(&self, whole: &Plan) -> Vec<Remark> {
        let mut remarks: Vec<Remark> = self
            .decoder
            .remarks()
            .iter()
            .map(|text| Remark::mended(Part::Sensor, text.clone()))
            .collect();
        let again = "map the recording again with slam2d run";
        let merged = self.plan.scans.iter().skip(1);
        let merged = listed(merged.map(|scans| scans.topic.clone()));
        let topic = &self.decoder.scans().topic;
        if !merged.is_empty() {
            let text = format!(
                "scans of {merged} are not merged with those of {topic} while the robot drives; choose with --scan-topic, or {again}"
            );
            remarks.push(Remark::mended(Part::Sensor, text));
        }
        if !self.plan.is_mounted && whole.is_mounted {
            let text = format!(
                "the transform to the laser came after mapping had begun, and the laser was taken at the body's origin, facing forward; {again}"
            );
            remarks.push(Remark::wrong(Part::Mounting, text));
        }
        let name = |source: &OdometrySource| {
            format!("{} from {} to {}", source.topic, source.above, source.body)
        };
        let (used, better) = (
            self.source.as_ref().map(name),
            whole.source.as_ref().map(name),
        );
        if used != better {
            let used = used.unwrap_or_else(|| "no odometry".to_owned());
            let better = better.unwrap_or_else(|| "none".to_owned());
            let text = format!(
                "{used} was used, but the odometry of the whole recording is {better}; {again}"
            );
            remarks.push(Remark::wrong(Part::Odometry, text));
        }
        let is_new = |remark: &&Remark| !self.plan.warnings.contains(remark);
        let new = whole.warnings.iter().filter(is_new);
        if new.filter(|remark| remark.part == Part::Clocks).count() > 0 {
            let text = format!(
                "stamps are corrected only with the whole recording; while the robot drove, they were used as they came. To correct them, {again}"
            );
            remarks.push(Remark::mended(Part::Clocks, text));
        }
        remarks
    }
}
