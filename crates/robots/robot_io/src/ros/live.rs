//! Frames of a recording while it is made: one pass over an MCAP stream.
//!
//! A file is surveyed before its first frame is read. Here the first seconds are surveyed, up to the mounting of the laser
//! and odometry that moves, and the plan is that of these seconds. A scan then waits for the odometry of its time. What
//! only a whole recording shows comes in the notes at the end: topics and transforms that came too late, stamps that a
//! pass over all of them corrects. One laser is read.
//!
//! Scans and poses are decoded as those of a file: for a recording without such faults, the frames are the same bits.

mod clock;
mod started;

use std::io::{BufRead, ErrorKind};

use self::started::Started;
use super::container::{Container as _, ContainerError, Recorded, kind_of};
use super::mcap_file::{LASER_SCAN, McapFile};
use super::plan::Plan;
use super::survey::{BodyPoses, ODOMETRY, POINT_CLOUD, POSES, SCANS, Survey, is_transforms};
use crate::log::{FilePosition, LogError, LogFrame, LogNotes, LogOptions, LogReader};

/// Scans that the survey needs at least.
const FEWEST_SCANS: usize = 10;
/// The survey ends this long after the first scan if the mounting or odometry that moves is missing, s.
const LONGEST_SURVEY_S: f64 = 10.0;
/// Most bytes of messages that wait for the end of the survey.
const MAX_EARLY_BYTES: usize = 1 << 26;

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
        match kind.as_str() {
            POINT_CLOUD => Some(Self::Cloud),
            kind if SCANS.contains(&kind) => Some(Self::Scan),
            kind if kind == ODOMETRY || POSES.contains(&kind) || is_transforms(kind) => {
                Some(Self::Motion)
            }
            _ => None,
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
    /// Creates from a stream of MCAP, whose reads wait for what comes next, or fail with [`ErrorKind::WouldBlock`] between
    /// two records; errors contain `name`.
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

    /// Reads the next message; false if none has come yet.
    fn advance(&mut self) -> bool {
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
            // Nothing of a record has come: the writer passes whole ones.
            Err(ContainerError::Io(problem)) if problem.kind() == ErrorKind::WouldBlock => {
                return false;
            }
            Err(ContainerError::Io(problem)) => {
                self.skip(problem.to_string());
                self.is_over = true;
            }
        }
        if self.is_over && self.started.is_none() {
            self.start();
        }
        true
    }

    /// The poses of the odometry in use.
    fn track(&self) -> Option<&BodyPoses> {
        track(&self.survey, &self.started.as_ref()?.plan)
    }

    fn skip(&mut self, problem: String) {
        let position = FilePosition::Byte(self.messages.offset());
        self.notes.skip(position, problem);
    }

    fn add(&mut self, message: Recorded) {
        let known = self.track().map_or(0, |track| track.poses.len());
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
        if let Some(track) = track(&self.survey, &live.plan) {
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
        if let Some(track) = track(&self.survey, &live.plan) {
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
                if live.plan.missing.is_some() {
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
            if !self.advance() {
                return Err(LogError::Waiting);
            }
        }
    }

    fn notes(&self) -> &LogNotes {
        &self.notes
    }
}

/// The poses of the plan's source.
fn track<'s>(survey: &'s Survey, plan: &Plan) -> Option<&'s BodyPoses> {
    let source = plan.source.as_ref()?;
    if source.is_transform {
        let key = (source.above.clone(), source.body.clone());
        survey.tracks.get(&key)
    } else {
        survey.odometry.get(&source.topic)
    }
}
