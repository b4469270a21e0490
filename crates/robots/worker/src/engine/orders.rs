//! The user's orders, and the localization of another log.

use ch16_slam2d::localize::StartPose;
use ch16_slam2d::loops::LoopVerification;
use ch16_slam2d::metrics::position_error_m;
use ch16_slam2d::scan::ScanPreparer;
use log_messages::{GradeReport, LoopDecision, MapperOrder, MapperReport, ScanReport};
use nalgebra::Vector3;
use pr_geom::SE2;
use robot_io::log::LogOptions;
use robot_io::map_image::NoReturn;
use robot_io::report::LogReport;
use robot_io::session;

use super::{Engine, Work};
use crate::editing::{Solving, rebuilt, solve};
use crate::files::{self, MAP_CELL_M, NAMES, REPORT_CELL_M};
use crate::given::Given;
use crate::grade::DroppedReference;
use crate::links::Link;
use crate::localization::Localization;

/// Settings for optimizing a graph file after a change.
const PLAIN: Solving = Solving {
    iterations: 30,
    tolerance: 1e-6,
    huber: f64::INFINITY,
};

impl<'a> Engine<'a> {
    /// Executes an order; the result is in the next updates.
    pub fn order(&mut self, order: MapperOrder) {
        let done = match order {
            MapperOrder::Look(keyframe) => {
                self.look(keyframe);
                return;
            }
            MapperOrder::Turn(link) => self.turn(link),
            MapperOrder::Accept(link) => self.accept(link),
            MapperOrder::Reject(link) => self.reject(link),
            MapperOrder::Add(a, b) => self.add(a, b),
            MapperOrder::Pin(keyframe, pose) => self.pin(keyframe, pose),
            MapperOrder::Unpin => self.unpin(),
        };
        if done.is_ok() {
            self.keep_edit(order);
        }
        self.answer(done.unwrap_or_else(|problem| problem));
    }

    fn answer(&mut self, reply: String) {
        if !reply.is_empty() {
            self.send(MapperReport::Answer(reply));
        }
    }

    /// Localizes another log on the map, once the map is complete.
    ///
    /// # Errors
    /// If there is no map, or the file is not a log; an earlier log is kept then.
    pub fn locate(
        &mut self,
        given: Given<'a>,
        options: &LogOptions,
        start: StartPose,
    ) -> Result<(), String> {
        if !self.has_scans {
            return Err("A graph has no scans, so a robot cannot be localized on it.".to_owned());
        }
        self.may_edit().map_err(|_| {
            format!(
                "{} needs a finished map. Try again once the log is read.",
                given.name
            )
        })?;
        let Some(session) = self.run.session() else {
            return Err("There is no map for localization.".to_owned());
        };
        let opened = Localization::open(given, options, &session, start)?;
        self.localization = Some(opened);
        Ok(())
    }

    /// Stops reading, and keeps what was read.
    pub fn cancel(&mut self) {
        let reply = self.stop();
        self.answer(reply);
    }

    fn stop(&mut self) -> String {
        if let Some(localization) = self.localization.as_mut().filter(|it| !it.is_over()) {
            localization.end();
            return "Stopped looking for the robot.".to_owned();
        }
        match core::mem::replace(&mut self.work, Work::Idle) {
            Work::Examining(examination) => {
                self.send_diagnosis(&examination);
                self.end_of_log(&examination.reader, None);
                String::new()
            }
            Work::Reading(reader) => {
                self.end_of_log(reader.as_ref(), None);
                match self.work {
                    Work::Finishing => self.close_last_loops(),
                    // Ending an empty log reports that itself.
                    _ => return String::new(),
                }
                format!("Stopped after {} scans.", self.run.scans())
            }
            other => {
                self.work = other;
                String::new()
            }
        }
    }

    /// Sends the scan of a keyframe, to be drawn over the map.
    fn look(&mut self, keyframe: usize) {
        let keyframes = self.run.slam().map_or(&[][..], |slam| slam.keyframes());
        let Some(at) = keyframes.get(keyframe) else {
            return;
        };
        self.send(MapperReport::Scan(ScanReport {
            keyframe,
            points: at.scan.iter().map(|point| [point.x, point.y]).collect(),
            sweep: self.sweep_of(keyframe),
        }));
    }

    /// The scan of a keyframe as it was measured; empty if it counts as one instant.
    fn sweep_of(&self, keyframe: usize) -> Vec<[f64; 2]> {
        let keyframe = self.run.keyframe_frames().get(keyframe);
        let Some(scan) = keyframe
            .map(|it| &it.scan)
            .filter(|scan| scan.beam_interval_s > 0.0)
        else {
            return Vec::new();
        };
        let mut preparer = ScanPreparer::new();
        let points = preparer.points(scan, &Vector3::zeros()).iter();
        points.map(|point| [point.x, point.y]).collect()
    }

    /// Removes a loop from the graph, or adds it.
    fn turn(&mut self, link: usize) -> Result<String, String> {
        self.may_edit()?;
        let Some(found) = self.links.get_mut(link) else {
            return Err(format!("there is no loop {link}"));
        };
        let (before, ends) = (found.decision, format!("{} to {}", found.new, found.old));
        found.decision = before.toggled();
        let reply = match found.decision {
            LoopDecision::Removed => format!("The loop {ends} was removed from the graph"),
            _ => format!("The loop {ends} was added to the graph"),
        };
        match self.resolve() {
            Ok(moved_m) => Ok(format!("{reply}; keyframes moved by up to {moved_m:.2} m.")),
            Err(problem) => {
                self.links[link].decision = before;
                Err(problem)
            }
        }
    }

    /// Keeps a loop of the graph that the rest contradicts: it is to be checked no longer.
    fn accept(&mut self, link: usize) -> Result<String, String> {
        self.may_edit()?;
        let found = self.links.get_mut(link);
        let Some(found) = found.filter(|link| link.decision.is_in_graph()) else {
            return Err(format!("there is no loop {link} in the graph"));
        };
        found.decision = LoopDecision::Confirmed;
        self.work = Work::Checking;
        let (new, old) = (found.new, found.old);
        Ok(format!("The loop {new} to {old} stays in the graph."))
    }

    /// Removes a loop from the graph; unlike [`Engine::turn`] it never adds one, however often it is sent.
    fn reject(&mut self, link: usize) -> Result<String, String> {
        match self.links.get(link) {
            Some(found) if found.decision.is_in_graph() => self.turn(link),
            _ => Err(format!("there is no loop {link} in the graph")),
        }
    }

    /// Registers one keyframe on the submap around another, and adds the loop if it is accepted.
    fn add(&mut self, a: usize, b: usize) -> Result<String, String> {
        self.may_edit()?;
        let (old, new) = (a.min(b), a.max(b));
        let found = self.register(old, new)?;
        let mut link = Link::registered(&found, found.accepted());
        if found.accepted() {
            link.decision = LoopDecision::Added;
        }
        let reason = link.reason.clone();
        self.links.insert(0, link);
        self.changes.loops = true;
        if !found.accepted() {
            return Ok(format!(
                "Keyframe {new} does not close a loop with {old}: {reason}. The loop is in the list, and you can still add it."
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
            return Err("A loop needs two keyframes: mark one, then select the other.".to_owned());
        }
        let found = slam.register_loop(old, new);
        found.map_err(|problem| format!("The loop cannot be tested against this graph: {problem}."))
    }

    /// Fixes a keyframe at the user's pose.
    fn pin(&mut self, keyframe: usize, [x, y, theta]: [f64; 3]) -> Result<String, String> {
        self.may_edit()?;
        let pose = SE2::new(x, y, theta);
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
            "No keyframe is fixed any more; they moved by up to {moved_m:.2} m."
        ))
    }

    fn may_edit(&self) -> Result<(), String> {
        match self.work {
            Work::Checking | Work::Idle if self.is_ranked => Ok(()),
            Work::Failed(_) => Err("There is no graph to change.".to_owned()),
            _ => Err("The graph can be changed once the whole log is read.".to_owned()),
        }
    }

    /// Optimizes the graph of all decisions; returns the largest displacement of a keyframe, m.
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
            return Err(
                "The graph cannot be optimized with this change; it was left unchanged.".to_owned(),
            );
        }
        let moved = before.iter().zip(graph.poses());
        let moved_m = moved.map(|(old, new)| position_error_m(old, new));
        let moved_m = moved_m.fold(0.0, f64::max);
        match self.run.slam_mut() {
            Some(slam) if self.graph.is_none() => {
                *slam.graph_mut() = graph;
                let in_graph = self.links.iter().filter(|link| link.decision.is_in_graph());
                let found = in_graph.filter_map(|link| link.found);
                let accepted = found.map(|found| LoopVerification {
                    rejection: None,
                    waits: None,
                    ..found
                });
                self.run.set_links(accepted.collect());
            }
            _ => self.graph = Some(graph),
        }
        self.graph_changed();
        Ok(moved_m)
    }

    /// Reads a reference, and compares with it from now on.
    ///
    /// # Errors
    /// If it is not a reference; the message is one sentence.
    pub fn take_reference(&mut self, bytes: &[u8], name: &str) -> Result<(), String> {
        let reference = DroppedReference::read(bytes, name)?;
        self.reference = Some((name.to_owned(), reference));
        self.changes.grade = true;
        Ok(())
    }

    /// The errors against the reference, or why there are none; `None` without a reference.
    pub(super) fn grade(&self) -> Option<Result<GradeReport, String>> {
        let (name, reference) = self.reference.as_ref()?;
        Some(reference.grade(&self.trajectory(), &self.keyframes(), name))
    }

    /// The content of one of [`NAMES`].
    ///
    /// # Errors
    /// If there is nothing to write; the message is one sentence.
    pub fn file(&mut self, name: &str) -> Result<Vec<u8>, String> {
        let Some(graph) = self.graph() else {
            return Err("There is nothing to save yet.".to_owned());
        };
        match name {
            "graph.g2o" => Ok(files::graph_file(graph)),
            "trajectory.tum" => files::trajectory_file(&self.trajectory()),
            "report.html" => Ok(self.report().into_bytes()),
            "where.tum" => match &self.localization {
                Some(localization) => {
                    files::trajectory_file(&localization.trajectory(super::poses_of(&self.run)))
                }
                None => Err("No other log was localized on this map.".to_owned()),
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
                let map = self.run.map(MAP_CELL_M, NoReturn::Unknown);
                let map = map.map_err(|problem| problem.to_string())?;
                let saved = files::MAP_IMAGES.into_iter().find(|image| *image == name);
                self.image = saved.unwrap_or(self.image);
                files::map_file(&map, name, self.image)
            }
        }
    }

    fn report(&mut self) -> String {
        let quality = self.quality();
        let map = self.run.map(REPORT_CELL_M, NoReturn::Unknown);
        let mut remarks = self.remarks.clone();
        remarks.extend(self.grade().map(|grade| match grade {
            Ok(grade) => grade.words,
            Err(problem) => problem,
        }));
        LogReport {
            name: &self.name,
            scans: self.scans_before + self.run.scans(),
            quality: &quality,
            chi2_over_time: self.run.chi2_over_time(),
            map: map.as_ref(),
            remarks: &remarks,
        }
        .html()
    }
}
