//! Maps a log one piece of work at a time, and executes the user's orders.
//!
//! [`Engine::step`] reads a scan, links a keyframe or paints a few scans, and returns whether there is
//! more work; [`Engine::updates`] returns what changed. The file is read on demand, so its
//! size costs no memory. The engine reads no clock: the caller decides how long a time slice is.

mod checking;
mod driving;
mod edits;
mod examining;
mod orders;
mod updates;

use std::collections::{BTreeMap, VecDeque};
use std::io::{self, BufRead, Read};

use ch16_slam2d::graph::PoseGraph;
use log_messages::{MapperOrder, MapperReport, Stage};
use pr_geom::SE2;
use robot_io::doctor::Diagnosis;
use robot_io::graph_file::GraphFile;
use robot_io::log::{LogError, LogOptions, LogReader};
use robot_io::run::LogRun;
use robot_io::session::{self, Session};
use robot_io::trajectory::{StampedPose, Trajectory};

use crate::files;
use crate::given::Given;
use crate::grade::DroppedReference;
use crate::graph_log::{self, GraphSolving, loops_of};
use crate::links::Link;
use crate::localization::Localization;
use crate::picture::MapPicture;
use crate::update::Update;
use driving::Driving;
pub use driving::NoConnection;
use examining::Examination;

/// Current work.
enum Work<'a> {
    /// The doctor checks the whole log before it is mapped.
    Examining(Box<Examination<'a>>),
    Reading(Box<dyn LogReader + 'a>),
    /// No scan follows: the last loops are tested.
    Finishing,
    Solving(Box<GraphSolving>),
    Checking,
    Idle,
    Failed(String),
}

/// Parts that changed since the last update.
#[derive(Clone, Copy, Debug, Default)]
struct Changes {
    file: bool,
    keyframes: bool,
    loops: bool,
    doubts: bool,
    grade: bool,
}

/// A log with its map.
pub struct Engine<'a> {
    name: String,
    size_bytes: u64,
    work: Work<'a>,
    run: LogRun,
    /// The graph of a file without scans.
    graph: Option<PoseGraph>,
    /// Inlier share of each keyframe's scan; NaN if it was not registered.
    fits: Vec<f64>,
    /// Standard deviation of each keyframe, m, once it is computed.
    sigmas_m: Vec<f64>,
    /// Nodes that were fixed before any pin.
    fixed: Vec<bool>,
    links: Vec<Link>,
    /// Whether the loops are in their final order, in which orders refer to them.
    is_ranked: bool,
    pins: BTreeMap<usize, SE2>,
    picture: MapPicture,
    diagnosis: Option<Diagnosis>,
    remarks: Vec<String>,
    doubts: Vec<String>,
    look_into: Vec<usize>,
    reference: Option<(String, DroppedReference)>,
    /// The last saved picture of the map, to which `map.yaml` refers.
    image: &'static str,
    /// Another log on this map.
    localization: Option<Localization<'a>>,
    /// The robot that drives, or has driven.
    driving: Option<Driving>,
    has_scans: bool,
    /// Number of scans of an opened session.
    scans_before: usize,
    changes: Changes,
    /// The user's changes of the graph.
    edits: Vec<MapperOrder>,
    /// Changes of an earlier worker, made again on the complete map.
    to_repeat: VecDeque<MapperOrder>,
    /// Pending updates, including answers.
    waiting: Vec<Update>,
}

impl<'a> Engine<'a> {
    /// Opens the given files with the chosen options.
    ///
    /// # Errors
    /// If they cannot be mapped, optimized or viewed; the message is one sentence.
    pub fn open(given: Given<'a>, options: &LogOptions) -> Result<Self, String> {
        let name = given.name.clone();
        let (name, size_bytes) = (name.as_str(), given.size_bytes);
        let Some(bytes) = given.parts.first() else {
            return Err("no file was given".to_owned());
        };
        let describe = |problem: io::Error| match bytes.is_packed() {
            Ok(true) => format!("{name} cannot be decompressed: {problem}; copy it again"),
            _ => format!("{name} cannot be read: {problem}; it may have moved or changed"),
        };
        let mut source = bytes.stream().map_err(describe)?;
        let start = source.fill_buf().map_err(describe)?;
        let lower = name.to_ascii_lowercase();
        if Session::begins(start) || lower.ends_with(".slam2d") {
            if size_bytes > session::MAX_BYTES {
                let too_large = session::SessionError::TooLarge {
                    name: name.to_owned(),
                };
                return Err(too_large.to_string());
            }
            let session = Session::read(source, name).map_err(|problem| problem.to_string())?;
            return Self::from_session(&session, name, size_bytes);
        }
        let is_graph = [".g2o", ".graph", ".toro"]
            .iter()
            .any(|end| lower.ends_with(end));
        let work = if !start.is_empty() && (is_graph || GraphFile::begins(start)) {
            if size_bytes > graph_log::MAX_BYTES {
                return Err(format!(
                    "{name} is larger than 256 MB, the limit for a pose graph"
                ));
            }
            let mut bytes = Vec::new();
            source
                .read_to_end(&mut bytes)
                .map_err(|problem| format!("{name} cannot be read: {problem}"))?;
            Work::Solving(Box::new(GraphSolving::read(&bytes, name)?))
        } else {
            drop(source);
            let examination = Examination::begin(given.clone(), options.clone())?;
            Work::Examining(Box::new(examination))
        };
        let mut engine = Self::with_work(work, name, size_bytes);
        if let Work::Solving(solving) = &engine.work
            && !solving.remarks.is_empty()
        {
            engine.remarks.clone_from(&solving.remarks);
            engine.send(MapperReport::Remarks(engine.remarks.clone()));
        }
        Ok(engine)
    }

    /// Opens a session, which already has a map.
    fn from_session(session: &Session, name: &str, size_bytes: u64) -> Result<Self, String> {
        let run = LogRun::reopen(session).map_err(|problem| format!("{name}: {problem}"))?;
        let keyframes = session.snapshot.keyframes.len();
        if keyframes == 0 {
            return Err(format!(
                "{name} is the session of a run without a scan; map a log first"
            ));
        }
        let mut engine = Self {
            run,
            fits: vec![f64::NAN; keyframes],
            has_scans: true,
            scans_before: session.snapshot.frames,
            ..Self::with_work(Work::Idle, name, size_bytes)
        };
        engine.begin_editing(loops_of(&session.graph()));
        Ok(engine)
    }

    fn with_work(work: Work<'a>, name: &str, size_bytes: u64) -> Self {
        Self {
            name: name.to_owned(),
            size_bytes,
            has_scans: matches!(work, Work::Examining(_)),
            scans_before: 0,
            localization: None,
            driving: None,
            work,
            run: LogRun::default(),
            graph: None,
            fits: Vec::new(),
            sigmas_m: Vec::new(),
            fixed: Vec::new(),
            links: Vec::new(),
            is_ranked: false,
            pins: BTreeMap::new(),
            picture: MapPicture::default(),
            diagnosis: None,
            remarks: Vec::new(),
            doubts: Vec::new(),
            look_into: Vec::new(),
            reference: None,
            image: files::MAP_IMAGES[0],
            changes: Changes {
                file: true,
                ..Changes::default()
            },
            edits: Vec::new(),
            to_repeat: VecDeque::new(),
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

    /// Does the next piece of work; returns false if there is none until the next order.
    pub fn step(&mut self) -> bool {
        match core::mem::replace(&mut self.work, Work::Idle) {
            Work::Examining(examination) => self.examine(examination),
            Work::Reading(reader) => return self.read(reader),
            Work::Finishing => self.close_last_loops(),
            Work::Solving(solving) => self.solve(solving),
            Work::Checking => self.check(),
            Work::Idle => return self.repeat_next() || self.paint() || self.localize_next(),
            Work::Failed(problem) => {
                self.work = Work::Failed(problem);
                return false;
            }
        }
        true
    }

    /// Reads the next scan; returns false if it has to come first, and nothing is to be painted.
    fn read(&mut self, mut reader: Box<dyn LogReader + 'a>) -> bool {
        match self.run.next_frame(reader.as_mut()) {
            Ok(Some(frame)) => {
                let is_first = self.run.scans() == 0;
                if let Some(report) = self.run.step(frame) {
                    if is_first {
                        self.send_offers(&reader.notes().offers);
                    }
                    if report.new_keyframe.is_some() {
                        let matched = report.registration.map(|found| found.matched);
                        let fit = matched.and_then(|matched| matched.score);
                        self.fits.push(fit.unwrap_or(f64::NAN));
                        self.changes.keyframes = true;
                    }
                    if !report.loop_attempts.is_empty() {
                        self.changes.loops = true;
                    }
                    if report.closed_loop().is_some() {
                        self.picture.follow(poses_of(&self.run));
                    }
                }
                self.paint();
                self.work = Work::Reading(reader);
            }
            Ok(None) => {
                let problem = self.run.broken().map(str::to_owned);
                self.end_of_log(reader.as_ref(), problem);
            }
            Err(LogError::Waiting) => {
                self.work = Work::Reading(reader);
                return self.paint();
            }
            Err(problem) => self.end_of_log(reader.as_ref(), Some(problem.to_string())),
        }
        true
    }

    /// Ends the log: links what was read, or reports why there are no scans.
    fn end_of_log(&mut self, reader: &dyn LogReader, problem: Option<String>) {
        let notes = reader.notes();
        self.send_offers(&notes.offers);
        self.remarks.clone_from(&notes.about);
        let mut sentences = notes.sentences(&self.name);
        let drive = self.end_of_drive();
        let problem = problem.map(|problem| drive.without_scans.unwrap_or(problem));
        // A map of a part of the file must not look complete.
        let is_cut = notes.truncated.is_some() || notes.ended_early.is_some();
        let missing = problem.as_ref().or(sentences.first().filter(|_| is_cut));
        let missing = missing.or(drive.remarks.last().filter(|_| drive.is_cut));
        let missing = missing.map_or(String::new(), |missing| format!("{missing}."));
        sentences.extend(drive.remarks);
        self.remarks.extend(sentences);
        let unused = self.run.no_map();
        let unused = unused.map(|why| format!("{}: no scan could be used: {why}", self.name));
        match (self.run.slam(), unused) {
            (Some(_), Some(why)) => self.work = Work::Failed(why),
            (Some(_), None) => {
                self.remarks.extend(problem);
                self.remarks.extend(self.run.sentences(&self.name));
                if !missing.is_empty() {
                    self.send(MapperReport::Answer(missing));
                }
                self.work = Work::Finishing;
            }
            (None, unused) => {
                let stopped = || format!("{} was stopped before its first scan", self.name);
                self.work = Work::Failed(problem.or(unused).unwrap_or_else(stopped));
            }
        }
        self.send(MapperReport::Remarks(self.remarks.clone()));
    }

    fn close_last_loops(&mut self) {
        self.run.finish();
        self.diagnose_map();
        self.begin_editing(links_of(&self.run));
    }

    fn solve(&mut self, mut solving: Box<GraphSolving>) {
        let has_more = solving.step();
        let graph = solving.graph();
        self.changes.keyframes = true;
        if has_more {
            self.graph = Some(graph);
            self.work = Work::Solving(solving);
            return;
        }
        let links = loops_of(&graph);
        self.graph = Some(graph);
        self.begin_editing(links);
    }

    /// Allows the user to edit the graph from now on.
    fn begin_editing(&mut self, links: Vec<Link>) {
        self.links = links;
        self.fixed = self.graph().map_or_else(Vec::new, |graph| {
            graph.nodes().map(|(_, node)| node.fixed).collect()
        });
        self.graph_changed();
    }

    /// Recomputes and reports what depends on the graph.
    fn graph_changed(&mut self) {
        self.changes.keyframes = true;
        self.changes.loops = true;
        self.changes.grade = true;
        if self.has_scans {
            self.picture.follow(poses_of(&self.run));
        }
        if let Some(localization) = &mut self.localization {
            localization.moved();
        }
        self.work = Work::Checking;
    }

    /// Paints the next scans; returns false if all are painted.
    fn paint(&mut self) -> bool {
        let frames = self.run.keyframe_frames();
        self.picture.step(frames, poses_of(&self.run))
    }

    /// Localizes the next scan of another log; returns false if there is none.
    fn localize_next(&mut self) -> bool {
        self.localization.as_mut().is_some_and(Localization::step)
    }

    fn graph(&self) -> Option<&PoseGraph> {
        let of_run = || self.run.slam().map(|slam| slam.graph());
        self.graph.as_ref().or_else(of_run)
    }

    /// The keyframes with their stamps; nodes of a graph file are a second apart.
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

    /// The pose of every scan; the nodes if there are no scans.
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

/// The loops that were tested, or those that the user left in the graph.
fn links_of(run: &LogRun) -> Vec<Link> {
    if run.links().is_empty() {
        let tried = run.loops().iter();
        return tried
            .map(|tried| Link::registered(&tried.verification, run.has_loop(tried)))
            .collect();
    }
    let links = run.links().iter();
    links
        .map(|link| Link::registered(link, link.accepted()))
        .collect()
}
