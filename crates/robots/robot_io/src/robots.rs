//! The robots of a recording, one after the other: with [`LogOptions::all_robots`] those after the first one, too.

use std::collections::VecDeque;

use crate::log::{LogError, LogFrame, LogNotes, LogOptions, LogReader};
use crate::motion::ComparedReader;
use crate::remark::{Part, Remark};

/// Time between the last scan of a robot and the first one of the next, s.
const APART_S: f64 = 60.0;

/// Opens the log with options.
type Opener<'a> = Box<dyn FnMut(&LogOptions) -> Result<ComparedReader<'a>, LogError> + 'a>;

/// Reads the frames of one robot, or of all.
pub struct Robots<'a> {
    open: Opener<'a>,
    options: LogOptions,
    reader: ComparedReader<'a>,
    /// Topics of the robots that follow; `None` until the first one was read.
    rest: Option<VecDeque<String>>,
    /// Added to the stamps of the present robot, s; `None` until its first scan.
    later_s: Option<f64>,
    last_s: f64,
    /// The present robot if it is not the first one, until its first scan and until it is asked for.
    name: Option<String>,
    begun: Option<String>,
    /// What was said about the robots before.
    about: Vec<String>,
    warnings: Vec<Remark>,
    notes: LogNotes,
}

impl<'a> Robots<'a> {
    /// Opens the log.
    ///
    /// # Errors
    /// If it cannot be opened or is not a log.
    pub fn open(
        mut open: impl FnMut(&LogOptions) -> Result<ComparedReader<'a>, LogError> + 'a,
        options: &LogOptions,
    ) -> Result<Self, LogError> {
        let reader = open(options)?;
        Ok(Self {
            open: Box::new(open),
            options: options.clone(),
            reader,
            rest: None,
            later_s: Some(0.0),
            last_s: 0.0,
            name: None,
            begun: None,
            about: Vec::new(),
            warnings: Vec::new(),
            notes: LogNotes::default(),
        })
    }

    /// Number of frames that were read and wait for their turn.
    #[must_use]
    pub fn waiting(&self) -> usize {
        self.reader.waiting()
    }

    /// The next frame of the present robot, or the first one of the next.
    fn frame(&mut self) -> Result<Option<LogFrame>, LogError> {
        loop {
            if let Some(mut frame) = self.reader.next_frame()? {
                let later_s = *self
                    .later_s
                    .get_or_insert_with(|| (self.last_s - frame.stamp_s).max(0.0).ceil() + APART_S);
                if let Some(name) = self.name.take() {
                    self.warnings.push(Remark::mended(Part::Clocks, format!(
                        "the stamps of the robot of {name} are {later_s} s later in the results than in the recording, after those of the robots before it"
                    )));
                    self.begun = Some(name);
                }
                frame.stamp_s += later_s;
                self.last_s = frame.stamp_s;
                return Ok(Some(frame));
            }
            let robots = || self.reader.notes().robots.clone();
            let rest = self.rest.get_or_insert_with(|| robots().into());
            let Some(next) = rest.pop_front().filter(|_| self.options.all_robots) else {
                return Ok(None);
            };
            self.join_notes();
            self.about.clone_from(&self.notes.about);
            self.warnings.clone_from(&self.notes.warnings);
            let options = LogOptions {
                scan_topic: Some(next.clone()),
                ..self.options.clone()
            };
            self.reader = (self.open)(&options)?;
            (self.name, self.later_s) = (Some(next), None);
        }
    }

    /// Whether anything was said about robots before the present one; otherwise its reader has all notes, which need
    /// not be copied at every frame.
    fn follows_others(&self) -> bool {
        !(self.about.is_empty() && self.warnings.is_empty())
    }

    /// The notes of the present robot, after what was said about those before.
    fn join_notes(&mut self) {
        let Self {
            reader,
            notes,
            about,
            warnings,
            ..
        } = self;
        notes.clone_from(reader.notes());
        notes.about.splice(0..0, about.iter().cloned());
        notes.warnings.retain(|said| !warnings.contains(said));
        notes.warnings.splice(0..0, warnings.iter().cloned());
    }
}

impl LogReader for Robots<'_> {
    fn next_frame(&mut self) -> Result<Option<LogFrame>, LogError> {
        let frame = self.frame();
        if self.follows_others() {
            self.join_notes();
        }
        frame
    }

    fn notes(&self) -> &LogNotes {
        if self.follows_others() {
            &self.notes
        } else {
            self.reader.notes()
        }
    }

    fn next_robot(&mut self) -> Option<String> {
        self.begun.take()
    }
}
