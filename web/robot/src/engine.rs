//! Maps a log one piece of work at a time, and executes the reader's orders.
//!
//! [`Engine::step`] reads a scan, links a keyframe or paints a few scans, and returns whether there is more
//! to do; [`Engine::updates`] returns the changes. The file is read only as far as a step needs it, so memory
//! does not depend on its size. The engine uses no clock: the caller decides on the length of a time slice.

mod checking;
mod examining;
mod orders;
mod reporting;

use std::collections::BTreeMap;
use std::io::{self, BufRead, Read};

use ch16_slam2d::graph::PoseGraph;
use pr_geom::SE2;
use robot_io::log::LogReader;
use robot_io::log_format::LogFormat;
use robot_io::recorder::RunRecorder;
use robot_io::run::{LogRun, NOTHING_SEEN, OdometryUse};
use robot_io::session::{self, Session};
use robot_io::trajectory::{StampedPose, Trajectory};

use crate::files;
use crate::grade::Reference;
use crate::graph_log::{self, GraphSolving, loops_of};
use crate::input::{Choices, LogInput};
use crate::links::Link;
use crate::other_log::OtherLog;
use crate::picture::MapPicture;
use crate::update::{Stage, Update};
use examining::Examination;

/// The current work.
enum Work<'a> {
    /// The doctor reads the complete log before it is mapped.
    Examining(Box<Examination<'a>>),
    Reading(Box<dyn LogReader + 'a>),
    /// All scans are read: the last loops are closed.
    Finishing,
    Solving(Box<GraphSolving>),
    Checking,
    Idle,
    Failed(String),
}

/// Parts that changed since their last update.
#[derive(Clone, Copy, Debug, Default)]
struct News {
    file: bool,
    keyframes: bool,
    loops: bool,
    doubts: bool,
    grade: bool,
}

/// A log that is being mapped.
pub struct Engine<'a> {
    name: String,
    size_bytes: u64,
    work: Work<'a>,
    run: LogRun,
    recorder: RunRecorder,
    /// The graph of a file without scans.
    graph: Option<PoseGraph>,
    /// Share of each keyframe's scan that fits; NaN if it was not registered.
    fits: Vec<f64>,
    /// σ of each keyframe, m; empty before it is computed.
    sigmas_m: Vec<f64>,
    /// The nodes that held the gauge before any pin.
    fixed: Vec<bool>,
    links: Vec<Link>,
    /// Whether the loops are sorted by doubt, which defines their numbers for the reader.
    is_ranked: bool,
    pins: BTreeMap<usize, SE2>,
    picture: MapPicture,
    remarks: Vec<String>,
    doubts: Vec<String>,
    look_into: Vec<usize>,
    reference: Option<(String, Reference)>,
    /// The image format that was saved last, to which `map.yaml` refers.
    image: &'static str,
    /// Another log on this map.
    other_log: Option<OtherLog<'a>>,
    has_scans: bool,
    /// Number of scans of the opened session.
    scans_before: usize,
    news: News,
    /// Updates for the next call, including answers.
    waiting: Vec<Update>,
}

impl<'a> Engine<'a> {
    /// Opens files with the selected options.
    ///
    /// # Errors
    /// One sentence if they can be neither mapped nor solved nor shown.
    pub fn open(given: LogInput<'a>, choices: &Choices) -> Result<Self, String> {
        let name = given.name.clone();
        let (name, size_bytes) = (name.as_str(), given.size_bytes);
        let Some(bytes) = given.parts.first() else {
            return Err("no file was given".to_owned());
        };
        let told = |problem: io::Error| match bytes.is_packed() {
            Ok(true) => format!("{name} does not unpack: {problem}; copy it once more"),
            _ => format!("{name} cannot be read: {problem}; it may have moved or changed"),
        };
        let mut source = bytes.stream().map_err(told)?;
        let start = source.fill_buf().map_err(told)?;
        let lower = name.to_ascii_lowercase();
        if Session::begins(start) || lower.ends_with(".slam2d") {
            if size_bytes > session::MOST_BYTES {
                let too_large = session::SessionError::TooLarge {
                    name: name.to_owned(),
                };
                return Err(too_large.to_string());
            }
            let session = Session::read(source, name).map_err(|problem| problem.to_string())?;
            return Self::of_session(&session, name, size_bytes);
        }
        let is_graph = [".g2o", ".graph", ".toro"]
            .iter()
            .any(|end| lower.ends_with(end));
        let work =
            if !start.is_empty() && (is_graph || LogFormat::detect(start) == LogFormat::Graph) {
                if size_bytes > graph_log::MOST_BYTES {
                    return Err(format!("{name} is larger than a pose graph of 256 MB"));
                }
                let mut bytes = Vec::new();
                source
                    .read_to_end(&mut bytes)
                    .map_err(|problem| format!("{name} cannot be read: {problem}"))?;
                Work::Solving(Box::new(GraphSolving::read(&bytes, name)?))
            } else {
                drop(source);
                let examination = Examination::begin(given.clone(), choices.clone())?;
                Work::Examining(Box::new(examination))
            };
        let run = LogRun::new(choices.odometry);
        Ok(Self {
            run,
            ..Self::beginning(work, name, size_bytes)
        })
    }

    /// A session contains a finished map.
    fn of_session(session: &Session, name: &str, size_bytes: u64) -> Result<Self, String> {
        let run = LogRun::reopen(session).map_err(|problem| format!("{name}: {problem}"))?;
        let keyframes = session.driven.keyframes.len();
        if keyframes == 0 {
            return Err(format!(
                "{name} is the session of a run without a scan; map a log first"
            ));
        }
        let mut engine = Self {
            run,
            recorder: RunRecorder::resume(session),
            fits: vec![f64::NAN; keyframes],
            has_scans: true,
            scans_before: session.driven.frames,
            ..Self::beginning(Work::Idle, name, size_bytes)
        };
        engine.begin_editing(loops_of(&session.graph()));
        Ok(engine)
    }

    fn beginning(work: Work<'a>, name: &str, size_bytes: u64) -> Self {
        Self {
            name: name.to_owned(),
            size_bytes,
            has_scans: matches!(work, Work::Examining(_)),
            scans_before: 0,
            other_log: None,
            work,
            run: LogRun::new(OdometryUse::Log),
            recorder: RunRecorder::default(),
            graph: None,
            fits: Vec::new(),
            sigmas_m: Vec::new(),
            fixed: Vec::new(),
            links: Vec::new(),
            is_ranked: false,
            pins: BTreeMap::new(),
            picture: MapPicture::default(),
            remarks: Vec::new(),
            doubts: Vec::new(),
            look_into: Vec::new(),
            reference: None,
            image: files::MAP_IMAGES[0],
            news: News {
                file: true,
                ..News::default()
            },
            waiting: Vec::new(),
        }
    }

    /// The current stage.
    #[must_use]
    pub fn stage(&self) -> Stage {
        match self.work {
            Work::Examining(_) | Work::Reading(_) => Stage::Reading,
            Work::Finishing => Stage::Finishing,
            Work::Solving(_) => Stage::Solving,
            Work::Checking => Stage::Checking,
            Work::Idle => Stage::Done,
            Work::Failed(_) => Stage::Failed,
        }
    }

    /// Does the next piece of work. Returns false if there is none until the next order.
    pub fn step(&mut self) -> bool {
        match core::mem::replace(&mut self.work, Work::Idle) {
            Work::Examining(examination) => self.examine(examination),
            Work::Reading(reader) => self.read(reader),
            Work::Finishing => self.close_last_loops(),
            Work::Solving(solving) => self.solve(solving),
            Work::Checking => self.check(),
            Work::Idle => return self.paint() || self.localize_next(),
            Work::Failed(problem) => {
                self.work = Work::Failed(problem);
                return false;
            }
        }
        true
    }

    fn read(&mut self, mut reader: Box<dyn LogReader + 'a>) {
        match reader.next_frame() {
            Ok(Some(frame)) => {
                let is_first = self.run.scans() == 0;
                if let Some(report) = self.run.step(frame.clone()) {
                    if is_first {
                        self.report_offers(&reader.notes().offers);
                    }
                    self.recorder.take(&frame, &report);
                    if report.new_keyframe.is_some() {
                        let matched = report.registration.map(|found| found.matched);
                        let fit = matched.and_then(|matched| matched.score);
                        self.fits.push(fit.unwrap_or(f64::NAN));
                        self.news.keyframes = true;
                    }
                    if !report.loop_attempts.is_empty() {
                        self.news.loops = true;
                    }
                    if report.closed_loop().is_some() {
                        self.picture.follow(poses_of(&self.run));
                    }
                }
                self.paint();
                self.work = Work::Reading(reader);
            }
            Ok(None) => self.end_of_log(reader.as_ref(), None),
            Err(problem) => self.end_of_log(reader.as_ref(), Some(problem.to_string())),
        }
    }

    /// Ends the reading: links what was read, or reports why there is nothing.
    fn end_of_log(&mut self, reader: &dyn LogReader, problem: Option<String>) {
        let notes = reader.notes();
        self.report_offers(&notes.offers);
        self.remarks.clone_from(&notes.about);
        let said = notes.sentences(&self.name);
        // A map of a part of the file must be distinguishable from one of all of it.
        let is_cut = notes.half_written.is_some() || notes.ended_early.is_some();
        let missing = problem.as_ref().or(said.first().filter(|_| is_cut));
        let missing = missing.map_or(String::new(), |missing| format!("{missing}."));
        self.remarks.extend(said);
        match self.run.slam() {
            Some(_) if !self.run.has_seen() => {
                let said = format!("{}: no scan could be used: {NOTHING_SEEN}", self.name);
                self.work = Work::Failed(said);
            }
            Some(_) => {
                self.remarks.extend(problem);
                self.remarks.extend(self.run.sentences(&self.name));
                if !missing.is_empty() {
                    self.waiting.push(Update::text("answer", missing));
                }
                self.work = Work::Finishing;
            }
            None => {
                let nothing = || match self.run.refused() {
                    Some(why) => format!("{}: no scan could be used: {why}", self.name),
                    None => format!("{} was stopped before its first scan", self.name),
                };
                self.work = Work::Failed(problem.unwrap_or_else(nothing));
            }
        }
        let remarks = self.remarks.join("\n");
        self.waiting.push(Update::text("remarks", remarks));
    }

    fn close_last_loops(&mut self) {
        self.run.finish();
        self.begin_editing(links_of(&self.run));
    }

    fn solve(&mut self, mut solving: Box<GraphSolving>) {
        let goes_on = solving.step();
        let graph = solving.graph();
        self.news.keyframes = true;
        if goes_on {
            self.graph = Some(graph);
            self.work = Work::Solving(solving);
            return;
        }
        let links = loops_of(&graph);
        self.graph = Some(graph);
        self.begin_editing(links);
    }

    /// The graph is finished; the reader may edit it from now on.
    fn begin_editing(&mut self, links: Vec<Link>) {
        self.links = links;
        self.fixed = self.graph().map_or_else(Vec::new, |graph| {
            graph.nodes().map(|(_, node)| node.fixed).collect()
        });
        self.changed();
    }

    /// Recomputes and reports everything that depends on the changed graph.
    fn changed(&mut self) {
        self.news.keyframes = true;
        self.news.loops = true;
        self.news.grade = true;
        if self.has_scans {
            self.picture.follow(poses_of(&self.run));
        }
        if let Some(other_log) = &mut self.other_log {
            other_log.moved();
        }
        self.work = Work::Checking;
    }

    /// Paints the next scans. Returns false if all are painted.
    fn paint(&mut self) -> bool {
        let frames = self.recorder.keyframes();
        self.picture.step(frames, poses_of(&self.run))
    }

    /// Localizes the robot of another log. Returns false if there is no log, or no scan left.
    fn localize_next(&mut self) -> bool {
        self.other_log.as_mut().is_some_and(OtherLog::step)
    }

    fn graph(&self) -> Option<&PoseGraph> {
        let of_run = || self.run.slam().map(|slam| slam.graph());
        self.graph.as_ref().or_else(of_run)
    }

    /// The keyframes with their times; nodes of a graph from a file are one second apart.
    fn keyframes(&self) -> Trajectory {
        let poses = self.graph().map_or(&[][..], |graph| graph.poses());
        let keyframes = self.run.slam().map_or(&[][..], |slam| slam.keyframes());
        let stamp_s = |k: usize| keyframes.get(k).map_or(k as f64, |k| k.stamp_s);
        let stamped = poses.iter().enumerate().map(|(k, &pose)| StampedPose {
            stamp_s: stamp_s(k),
            pose,
        });
        Trajectory::new(stamped.collect())
    }

    /// The pose of every scan, or of every node if there are no scans.
    fn trajectory(&self) -> Trajectory {
        if self.has_scans {
            self.run.trajectory()
        } else {
            self.keyframes()
        }
    }
}

fn poses_of(run: &LogRun) -> &[SE2] {
    run.slam().map_or(&[], |slam| slam.graph().poses())
}

/// The loops that were tried, or those of an edited graph.
fn links_of(run: &LogRun) -> Vec<Link> {
    if run.links().is_empty() {
        let tried = run.loops().iter();
        return tried
            .map(|tried| Link::registered(&tried.verification, run.holds(tried)))
            .collect();
    }
    let links = run.links().iter();
    links
        .map(|link| Link::registered(link, link.accepted()))
        .collect()
}
