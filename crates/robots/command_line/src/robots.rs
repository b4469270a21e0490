//! The robots of a recording, one after the other: with `--all-robots` those after the first one, too.

use std::collections::VecDeque;
use std::path::Path;

use robot_io::log::{LogFrame, LogReader as _};
use robot_io::motion::ComparedReader;
use robot_io::run::LogRun;

use crate::log_file::{OdometryArgs, Progress, TopicArgs, open_compared};

/// Time between the last scan of a robot and the first one of the next, s.
const APART_S: f64 = 60.0;

/// Reads the frames of one robot, or of all.
pub struct Robots<'a> {
    path: &'a Path,
    topics: &'a TopicArgs,
    odometry: OdometryArgs,
    reader: ComparedReader<'static>,
    progress: Progress,
    /// Topics of the robots that follow; `None` until the first one was read.
    rest: Option<VecDeque<String>>,
    /// Added to the stamps of the present robot, s; `None` until its first scan.
    later_s: Option<f64>,
    last_s: f64,
    /// The present robot if it is not the first one.
    name: Option<String>,
    remarks: Vec<String>,
    about: Vec<String>,
}

impl<'a> Robots<'a> {
    /// Opens the log.
    ///
    /// # Errors
    /// If it cannot be opened or is not a log.
    pub fn open(
        path: &'a Path,
        topics: &'a TopicArgs,
        odometry: OdometryArgs,
    ) -> anyhow::Result<Self> {
        let (reader, progress) = open_compared(path, topics, odometry)?;
        Ok(Self {
            path,
            topics,
            odometry,
            reader,
            progress,
            rest: None,
            later_s: Some(0.0),
            last_s: 0.0,
            name: None,
            remarks: Vec::new(),
            about: Vec::new(),
        })
    }

    /// The next frame; `run` is told if it is the first one of another robot.
    ///
    /// # Errors
    /// If the log cannot be read further.
    pub fn next_frame(&mut self, run: &mut LogRun) -> anyhow::Result<Option<LogFrame>> {
        loop {
            if let Some(mut frame) = self.reader.next_frame()? {
                let later_s = *self
                    .later_s
                    .get_or_insert_with(|| (self.last_s - frame.stamp_s).max(0.0).ceil() + APART_S);
                if let Some(name) = self.name.take() {
                    run.next_robot(&name, frame.stamp_s + later_s);
                    self.remarks.push(format!(
                        "{}: the stamps of the robot of {name} are {later_s} s later in the results than in the recording, after those of the robots before it",
                        self.path.display()
                    ));
                }
                frame.stamp_s += later_s;
                self.last_s = frame.stamp_s;
                return Ok(Some(frame));
            }
            self.keep_notes();
            let robots = || self.reader.notes().robots.clone();
            let rest = self.rest.get_or_insert_with(|| robots().into());
            let Some(next) = rest.pop_front().filter(|_| self.topics.all_robots) else {
                return Ok(None);
            };
            let topics = self.topics.of_scans(&next);
            (self.reader, self.progress) = open_compared(self.path, &topics, self.odometry)?;
            (self.name, self.later_s) = (Some(next), None);
        }
    }

    fn keep_notes(&mut self) {
        let notes = self.reader.notes();
        let sentences = notes.sentences(&self.path.display().to_string());
        let new = sentences
            .into_iter()
            .filter(|said| !self.remarks.contains(said));
        self.remarks.extend(new.collect::<Vec<_>>());
        self.about.extend(notes.about.iter().cloned());
    }

    /// Shows the number of scans done.
    pub fn report(&mut self, scans: usize) {
        self.progress.report(scans);
    }

    /// Ends the reading: what was corrected, and what was found.
    pub fn end(mut self, is_whole: bool) -> (Vec<String>, Vec<String>) {
        self.progress.end();
        if !is_whole {
            self.keep_notes();
        }
        (self.remarks, self.about)
    }
}
