//! The reader's orders: `turn 3`, `add 120 14`, `pin 7 1.5 2 0.1`, `unpin`, `look 12`, `cancel`; and the
//! localization of another log.

use ch16_slam2d::localize::StartPose;
use ch16_slam2d::loops::LoopVerification;
use ch16_slam2d::metrics::position_error_m;
use pr_geom::SE2;
use robot_io::map_image::map_of;
use robot_io::report::Report;
use robot_io::session;

use super::{Engine, Work};
use crate::editing::{Solving, rebuilt, solve};
use crate::files::{self, MAP_CELL_M, NAMES, REPORT_CELL_M};
use crate::grade::Reference;
use crate::input::{Choices, LogInput};
use crate::links::{Link, Verdict};
use crate::other_log::OtherLog;
use crate::update::Update;

/// Solver settings for a graph from a file after a change.
const PLAIN: Solving = Solving {
    iterations: 30,
    tolerance: 1e-6,
    huber: f64::INFINITY,
};

impl<'a> Engine<'a> {
    /// Executes an order; the next updates contain the answer.
    pub fn order(&mut self, order: &str) {
        let mut words = order.split_ascii_whitespace();
        let name = words.next().unwrap_or_default();
        let numbers: Vec<f64> = words.filter_map(|word| word.parse().ok()).collect();
        let answered = match (name, numbers.as_slice()) {
            ("cancel", []) => self.cancel(),
            ("look", [keyframe]) => self.look(*keyframe as usize),
            ("turn", [link]) => self.turn(*link as usize),
            ("add", [a, b]) => self.add(*a as usize, *b as usize),
            ("pin", [keyframe, x, y, theta]) if x.is_finite() && y.is_finite() => {
                self.pin(*keyframe as usize, SE2::new(*x, *y, *theta))
            }
            ("unpin", []) => self.unpin(),
            _ => Err("this order is unknown".to_owned()),
        };
        let said = answered.unwrap_or_else(|problem| problem);
        if !said.is_empty() {
            self.waiting.push(Update::text("answer", said));
        }
    }

    /// Starts to localize the robot of another log on the finished map.
    ///
    /// # Errors
    /// One sentence if there is no map, or the file is no log; an earlier log then remains.
    pub fn locate(
        &mut self,
        given: LogInput<'a>,
        choices: &Choices,
        start: StartPose,
    ) -> Result<(), String> {
        if !self.has_scans {
            return Err("A graph has no scans, so nobody can be found on it.".to_owned());
        }
        self.may_edit().map_err(|_| {
            format!(
                "{} has to wait: the map does not stand yet; ask again once the log is read.",
                given.name
            )
        })?;
        let Some(session) = self.run.session() else {
            return Err("There is no map to be found on.".to_owned());
        };
        let opened = OtherLog::open(given, choices, &session, start)?;
        self.other_log = Some(opened);
        Ok(())
    }

    /// Ends the reading and keeps what was read.
    fn cancel(&mut self) -> Result<String, String> {
        if let Some(other_log) = self.other_log.as_mut().filter(|it| !it.is_over()) {
            other_log.end();
            return Ok("Stopped looking for the robot.".to_owned());
        }
        match core::mem::replace(&mut self.work, Work::Idle) {
            Work::Examining(examination) => {
                self.tell_diagnosis(&examination);
                self.end_of_log(&examination.reader, None);
                Ok(String::new())
            }
            Work::Reading(reader) => {
                self.end_of_log(reader.as_ref(), None);
                match self.work {
                    Work::Finishing => self.close_last_loops(),
                    // It reports itself that nothing was read.
                    _ => return Ok(String::new()),
                }
                Ok(format!("Stopped after {} scans.", self.run.scans()))
            }
            other => {
                self.work = other;
                Ok(String::new())
            }
        }
    }

    /// The scan of a keyframe, to draw over the map.
    fn look(&mut self, keyframe: usize) -> Result<String, String> {
        let keyframes = self.run.slam().map_or(&[][..], |slam| slam.keyframes());
        if let Some(at) = keyframes.get(keyframe) {
            let mut numbers = vec![keyframe as f64];
            numbers.extend(at.scan.iter().flat_map(|point| [point.x, point.y]));
            self.waiting.push(Update::numbers("scan", numbers));
        }
        Ok(String::new())
    }

    /// Rejects a loop of the graph, or adds one.
    fn turn(&mut self, link: usize) -> Result<String, String> {
        self.may_edit()?;
        let Some(found) = self.links.get_mut(link) else {
            return Err(format!("there is no loop {link}"));
        };
        let (before, ends) = (found.verdict, format!("{} to {}", found.new, found.old));
        found.verdict = before.turned();
        let said = match found.verdict {
            Verdict::Removed => format!("The loop {ends} is out of the graph"),
            _ => format!("The loop {ends} is in the graph"),
        };
        match self.resolve() {
            Ok(moved_m) => Ok(format!("{said}; keyframes moved by up to {moved_m:.2} m.")),
            Err(problem) => {
                self.links[link].verdict = before;
                Err(problem)
            }
        }
    }

    /// Registers one keyframe on the surroundings of another, and closes the loop if it passes.
    fn add(&mut self, a: usize, b: usize) -> Result<String, String> {
        self.may_edit()?;
        let (old, new) = (a.min(b), a.max(b));
        let found = self.register(old, new)?;
        let mut link = Link::registered(&found, found.accepted());
        if found.accepted() {
            link.verdict = Verdict::Added;
        }
        let reason = link.reason.clone();
        self.links.insert(0, link);
        self.news.loops = true;
        if !found.accepted() {
            return Ok(format!(
                "Keyframe {new} does not close a loop with {old}: {reason}. It stands in the list; you may close it all the same."
            ));
        }
        match self.resolve() {
            Ok(moved_m) => Ok(format!(
                "Keyframe {new} closes a loop with {old}; keyframes moved by up to {moved_m:.2} m."
            )),
            Err(problem) => {
                self.links.remove(0);
                Err(problem)
            }
        }
    }

    fn register(&mut self, old: usize, new: usize) -> Result<LoopVerification, String> {
        let Some(slam) = self.run.slam_mut().filter(|_| self.graph.is_none()) else {
            return Err("A graph has no scans, so nothing can be registered.".to_owned());
        };
        if new >= slam.keyframes().len() || old == new {
            return Err("A loop needs two keyframes: mark one, then go to the other.".to_owned());
        }
        let found = slam.register_loop(old, new);
        found.map_err(|problem| format!("Nothing can be tested against this graph: {problem}."))
    }

    /// Fixes a keyframe at the reader's pose.
    fn pin(&mut self, keyframe: usize, pose: SE2) -> Result<String, String> {
        self.may_edit()?;
        if keyframe >= self.fixed.len() {
            return Err(format!("there is no keyframe {keyframe}"));
        }
        let before = self.pins.insert(keyframe, pose);
        let resolved = self.resolve();
        if resolved.is_err() {
            match before {
                Some(pin) => self.pins.insert(keyframe, pin),
                None => self.pins.remove(&keyframe),
            };
        }
        resolved.map(|_| String::new())
    }

    fn unpin(&mut self) -> Result<String, String> {
        self.may_edit()?;
        self.pins.clear();
        let moved_m = self.resolve()?;
        Ok(format!(
            "No keyframe is held any more; they moved by up to {moved_m:.2} m."
        ))
    }

    fn may_edit(&self) -> Result<(), String> {
        match self.work {
            Work::Checking | Work::Idle if self.is_ranked => Ok(()),
            Work::Failed(_) => Err("There is no graph to change.".to_owned()),
            _ => Err("The graph can be changed once the whole log is read.".to_owned()),
        }
    }

    /// Solves the edited graph. Returns the largest movement of a keyframe, m.
    fn resolve(&mut self) -> Result<f64, String> {
        let Some(base) = self.graph() else {
            return Err("There is no graph to change.".to_owned());
        };
        let mut graph = rebuilt(base, &self.fixed, &self.links, &self.pins);
        let before = base.poses().to_vec();
        let how = self.run.slam().map_or(PLAIN, |slam| Solving {
            iterations: slam.config().optimizer_iterations,
            tolerance: slam.config().optimizer_tolerance,
            huber: slam.config().huber,
        });
        if !solve(&mut graph, &how) {
            return Err("The graph cannot be solved so; it stays as it was.".to_owned());
        }
        let moved = before.iter().zip(graph.poses());
        let moved_m = moved.map(|(old, new)| position_error_m(old, new));
        let moved_m = moved_m.fold(0.0, f64::max);
        match self.run.slam_mut() {
            Some(slam) if self.graph.is_none() => {
                *slam.graph_mut() = graph;
                let in_graph = self.links.iter().filter(|link| link.verdict.is_in_graph());
                let found = in_graph.filter_map(|link| link.found);
                let told = found.map(|found| LoopVerification {
                    rejection: None,
                    ..found
                });
                self.run.set_links(told.collect());
            }
            _ => self.graph = Some(graph),
        }
        self.changed();
        Ok(moved_m)
    }

    /// Sets a reference for the comparison.
    ///
    /// # Errors
    /// One sentence if it is invalid.
    pub fn take_reference(&mut self, bytes: &[u8], name: &str) -> Result<(), String> {
        let reference = Reference::read(bytes, name)?;
        self.reference = Some((name.to_owned(), reference));
        self.news.grade = true;
        Ok(())
    }

    /// The errors against the reference, if there is one.
    pub(super) fn grade_updates(&self) -> Vec<Update> {
        let Some((name, reference)) = &self.reference else {
            return Vec::new();
        };
        match reference.grade(&self.trajectory(), &self.keyframes(), name) {
            Ok((grade, errors)) => vec![grade, Update::numbers("errors", errors)],
            Err(problem) => vec![Update::text("answer", problem)],
        }
    }

    /// The bytes of one of [`NAMES`].
    ///
    /// # Errors
    /// One sentence if there is no data for it.
    pub fn file(&mut self, name: &str) -> Result<Vec<u8>, String> {
        let Some(graph) = self.graph() else {
            return Err("There is nothing to save yet.".to_owned());
        };
        match name {
            "graph.g2o" => Ok(files::graph_file(graph)),
            "trajectory.tum" => files::trajectory_file(&self.trajectory()),
            "report.html" => Ok(self.report().into_bytes()),
            "where.tum" => match &self.other_log {
                Some(other_log) => {
                    files::trajectory_file(&other_log.trajectory(super::poses_of(&self.run)))
                }
                None => Err("No other log was looked for on this map.".to_owned()),
            },
            _ if !NAMES.contains(&name) => Err(format!("there is no file {name} to save")),
            _ if !self.has_scans => {
                Err("A graph has no scans, so there is no map of it.".to_owned())
            }
            session::FILE_NAME => match self.run.session() {
                Some(session) => Ok(session.to_bytes()),
                None => Err("There is nothing to save yet.".to_owned()),
            },
            _ => {
                let lines = self.recorder.map_lines(&self.run);
                let map = map_of(&lines, MAP_CELL_M).map_err(|problem| problem.to_string())?;
                let saved = files::MAP_IMAGES.into_iter().find(|image| *image == name);
                self.image = saved.unwrap_or(self.image);
                files::map_file(&map, name, self.image)
            }
        }
    }

    fn report(&mut self) -> String {
        let quality = self.quality();
        let lines = self.recorder.map_lines(&self.run);
        let map = map_of(&lines, REPORT_CELL_M).ok();
        let mut remarks = self.remarks.clone();
        remarks.extend(self.grade_updates().into_iter().map(|update| update.text));
        remarks.retain(|remark| !remark.is_empty());
        Report {
            name: &self.name,
            scans: self.scans_before + self.run.scans(),
            quality: &quality,
            chi2_over_time: self.recorder.chi2_over_time(),
            map: map.as_ref(),
            remarks: &remarks,
        }
        .html()
    }
}
