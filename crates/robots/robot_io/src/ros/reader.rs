//! Frames of a ROS recording, for all containers.

use std::io::ErrorKind;

use ch16_slam2d::scan::LaserScan;
use pr_geom::{Point2, math};

use super::binned::binned;
use super::container::{Container, ContainerError};
use super::cursor::{ScanCursor, StampedScan};
use super::file::{Messages, RosFiles};
use super::plan::Plan;
use super::survey::Survey;
use crate::log::{BrokenRecord, FilePosition, LogError, LogFrame, LogNotes, LogOptions, LogReader};
use crate::log_bytes::LogBytes;
use crate::remark::{Part, Remark};

/// Scans of two lasers are merged if their stamps differ by less than this share of a period.
const TOGETHER: f64 = 0.6;

/// Reads a recording in two passes: a survey, and the scans.
pub struct RosReader<'a> {
    files: RosFiles<'a>,
    name: String,
    options: LogOptions,
    notes: LogNotes,
    reading: Option<Reading<'a>>,
    frames: usize,
}

/// The second pass.
struct Reading<'a> {
    plan: Plan,
    anchor: ScanCursor<'a>,
    others: Vec<Companion<'a>>,
}

/// Another laser, and its scans nearest in time to those of the first.
struct Companion<'a> {
    cursor: ScanCursor<'a>,
    last: Option<StampedScan>,
    next: Option<StampedScan>,
}

impl<'a> RosReader<'a> {
    /// Creates a reader of the files of a recording; errors contain `name`.
    #[must_use]
    pub fn new(files: Vec<LogBytes<'a>>, name: &str, options: &LogOptions) -> Self {
        Self {
            files: RosFiles::new(files),
            name: name.to_owned(),
            options: options.clone(),
            notes: LogNotes::default(),
            reading: None,
            frames: 0,
        }
    }

    /// Surveys all messages.
    fn look_through(&mut self) -> Result<(Survey, Messages<'a>), LogError> {
        let mut survey = Survey::default();
        let mut messages = self.files.messages();
        loop {
            match messages.next_message() {
                Ok(Some(message)) => {
                    if let Err(problem) = survey.add(&message, &self.options) {
                        let position = FilePosition::Byte(messages.offset());
                        self.notes.skip(position, problem);
                    }
                }
                Ok(None) => break,
                Err(error) => {
                    let position = FilePosition::Byte(messages.offset());
                    if !self.handle_error(error, position)? {
                        break;
                    }
                }
            }
        }
        survey.end();
        Ok((survey, messages))
    }

    /// Surveys the recording and selects from it.
    fn survey(&mut self) -> Result<Reading<'a>, LogError> {
        self.files.sort_by_time();
        let (mut survey, mut messages) = self.look_through()?;
        if messages.has_late_topics() {
            // Damage hid topics; now that they are known, the messages around it can be read.
            self.notes = LogNotes::default();
            (survey, messages) = self.look_through()?;
        }
        self.notes.bytes = messages.offset();
        let plan = Plan::new(&survey, &self.options);
        plan.write_notes(&survey, &mut self.notes);
        if let Some((option, wanted)) = plan.missing.clone().filter(|_| !plan.scans.is_empty()) {
            return Err(LogError::Missing {
                name: self.name.clone(),
                option: option.name(),
                wanted,
                advice: plan.instead_of(option),
            });
        }
        let mut cursors = plan.scans.iter().map(|scans| {
            let messages = Box::new(self.files.messages());
            ScanCursor::new(messages, scans.clone(), self.options.heights_m)
        });
        let Some(anchor) = cursors.next() else {
            let instead = messages.instead();
            return Err(self.no_scans_error(instead.as_deref().unwrap_or(plan.without_scans())));
        };
        let others = cursors.map(|cursor| Companion {
            cursor,
            last: None,
            next: None,
        });
        let others = others.collect();
        Ok(Reading {
            plan,
            anchor,
            others,
        })
    }

    /// Handles an error of a container: a system error ends the reading, others become notes. Returns whether messages
    /// may follow.
    fn handle_error(
        &mut self,
        error: ContainerError,
        position: FilePosition,
    ) -> Result<bool, LogError> {
        match error {
            // Truncated compressed data is not a system error.
            ContainerError::Io(source)
                if matches!(
                    source.kind(),
                    ErrorKind::UnexpectedEof | ErrorKind::InvalidData
                ) =>
            {
                let problem = source.to_string();
                self.notes.truncated = Some(BrokenRecord { position, problem });
            }
            ContainerError::Io(source) => {
                return Err(LogError::Io {
                    name: self.name.clone(),
                    position,
                    source,
                });
            }
            ContainerError::CutOff(problem) => {
                self.notes.truncated = Some(BrokenRecord { position, problem });
            }
            ContainerError::Broken(problem) => {
                self.notes.skip(position, problem);
                let rest = "the rest of the file was not read".to_owned();
                self.notes.ended_early = Some(rest);
            }
            ContainerError::Skipped(problem) => {
                self.notes.skip(position, problem);
                return Ok(true);
            }
        }
        Ok(false)
    }

    fn no_scans_error(&self, instead: &str) -> LogError {
        let broken = self.notes.first_broken.as_ref();
        let broken = broken.or(self.notes.truncated.as_ref());
        LogError::NoScans {
            name: self.name.clone(),
            detail: match broken {
                Some(broken) => format!("{}: {}", broken.position, broken.problem),
                None => instead.to_owned(),
            },
        }
    }
}

impl LogReader for RosReader<'_> {
    fn next_frame(&mut self) -> Result<Option<LogFrame>, LogError> {
        let mut reading = match self.reading.take() {
            Some(reading) => reading,
            None => self.survey()?,
        };
        let scan = reading.next(&mut self.notes);
        self.notes.bytes = reading.anchor.offset();
        if scan.is_none() || self.frames == 0 {
            reading.write_field_remarks(&mut self.notes);
        }
        let without_scans = reading.plan.without_scans().to_owned();
        let odometry = |stamp_s| {
            reading
                .plan
                .odometry
                .as_ref()
                .and_then(|odometry| odometry.at(stamp_s))
        };
        let frame = scan.map(|scan| LogFrame {
            stamp_s: scan.stamp_s,
            odometry: odometry(scan.stamp_s),
            scan: scan.scan,
        });
        self.reading = Some(reading);
        match frame {
            Some(frame) => {
                self.frames += 1;
                Ok(Some(frame))
            }
            None if self.frames == 0 => Err(self.no_scans_error(&without_scans)),
            None => Ok(None),
        }
    }

    fn notes(&self) -> &LogNotes {
        &self.notes
    }
}

impl Reading<'_> {
    /// The next scan of the first laser, merged with those of the others at its time.
    fn next(&mut self, notes: &mut LogNotes) -> Option<StampedScan> {
        let mut scan = self.anchor.next(notes)?;
        if self.others.is_empty() {
            return Some(scan);
        }
        let most_apart_s = TOGETHER * self.anchor.scans().period_s;
        let odometry = self.plan.odometry.as_ref();
        let of_anchor = odometry.and_then(|odometry| odometry.at(scan.stamp_s));
        let mut points = points_of(&scan.scan);
        let mut step_rad = scan.scan.angle_step_rad.abs();
        for other in &mut self.others {
            let Some(near) = other.nearest(scan.stamp_s, notes) else {
                continue;
            };
            if (near.stamp_s - scan.stamp_s).abs() > most_apart_s {
                continue;
            }
            // Pose of the body at the other laser's scan, relative to the current body.
            let of_other = odometry.and_then(|odometry| odometry.at(near.stamp_s));
            let moved = of_anchor
                .zip(of_other)
                .map(|(now, then)| now.between(&then));
            let moved = moved.unwrap_or_default();
            let of_near = points_of(&near.scan).into_iter();
            points.extend(of_near.map(|point| moved.transform(point)));
            step_rad = step_rad.min(near.scan.angle_step_rad.abs());
        }
        scan.scan = binned(points.into_iter().map(|point| (point.x, point.y)), step_rad);
        Some(scan)
    }

    /// Adds problems in the fields of scans to the notes.
    fn write_field_remarks(&self, notes: &mut LogNotes) {
        let cursors =
            std::iter::once(&self.anchor).chain(self.others.iter().map(|other| &other.cursor));
        for sentence in cursors.flat_map(ScanCursor::remarks) {
            let remark = Remark::mended(Part::Sensor, sentence.clone());
            if !notes.warnings.contains(&remark) {
                notes.warnings.push(remark);
            }
        }
    }
}

/// The points of a scan in the body frame.
fn points_of(scan: &LaserScan) -> Vec<Point2<f64>> {
    let beams = scan.ranges_m.iter().enumerate();
    let seen = beams.filter(|&(_, &range_m)| scan.is_return(range_m));
    seen.map(|(beam, &range_m)| {
        let (sin, cos) = math::sin_cos(scan.bearing_rad(beam));
        scan.body_from_sensor
            .transform(Point2::new(range_m * cos, range_m * sin))
    })
    .collect()
}

impl Companion<'_> {
    /// The scan nearest to this time; never goes back.
    fn nearest(&mut self, stamp_s: f64, notes: &mut LogNotes) -> Option<&StampedScan> {
        while self
            .next
            .as_ref()
            .or(self.last.as_ref())
            .is_none_or(|scan| scan.stamp_s < stamp_s)
        {
            let Some(next) = self.cursor.next(notes) else {
                break;
            };
            if let Some(before) = self.next.replace(next) {
                self.last = Some(before);
            }
        }
        let apart_s = |scan: &StampedScan| (scan.stamp_s - stamp_s).abs();
        match (&self.last, &self.next) {
            (Some(last), Some(next)) if apart_s(last) <= apart_s(next) => Some(last),
            (_, Some(next)) => Some(next),
            (last, None) => last.as_ref(),
        }
    }
}
