//! Runs the pipeline on a log and collects messages for the user.

mod record;
mod robots;
mod sentences;
mod stuck;

pub use sentences::late_scans;

use ch16_slam2d::local_map::LocalMapConfig;
use ch16_slam2d::loops::{LoopRejection, LoopVerification};
use ch16_slam2d::pipeline::{BridgedGap, LeftOut, PieceFate, PieceReport, Pipeline, ScanPose};
use ch16_slam2d::scan::{FrameError, LaserScan};
use ch16_slam2d::slam::{LoopAttempt, Slam, SlamReport, SnapshotError};
use pr_geom::SE2;

use crate::evidence::{PoorFit, TriedLoop};
use crate::log::LogFrame;
use crate::path_lengths::PathLengths;
use crate::quality::Quality;
use crate::session::{MappedGraph, Session, selected_scan_poses};
use crate::settings::{Setting, SettingError};
use crate::trajectory::{StampedPose, Trajectory};
use record::Record;
use stuck::StuckOdometry;

/// Scans with a lower score are reported.
const POOR_SCORE: f64 = 0.5;

/// A run over a log: the pipeline of the core, the scans for its map, and the evidence for the quality report.
pub struct LogRun {
    settings: Vec<(&'static Setting, f64)>,
    pipeline: Pipeline,
    record: Record,
    /// Number of scans that belong to a resumed session.
    resumed: usize,
    /// The same before any was left out.
    session_scans: usize,
    /// Beam geometry, without ranges.
    sensor: Option<LaserScan>,
    loops: Vec<TriedLoop>,
    /// Attempts of a piece that is not on the map.
    held: Vec<LoopAttempt>,
    links: Vec<LoopVerification>,
    poor: Vec<PoorFit>,
    stuck: StuckOdometry,
    /// Why the map does not follow its newest loops.
    unsolved: Option<LoopRejection>,
    lengths: PathLengths,
    late: usize,
    /// Number of scans without a return before the first one that sees something.
    blind: usize,
    /// Number of scans with zero odometry motion; `None` once the robot moved.
    still: Option<usize>,
    rejected: Option<FrameError>,
    /// Beam geometry of a log that continues a session, if it differs from the session's.
    other_sensor: Option<LaserScan>,
    /// Beam geometry of this log, without ranges.
    own_sensor: Option<LaserScan>,
    /// The robots after the first one: their names, and the stamps of their first scans, s.
    robots: Vec<(String, f64)>,
    broken: Option<String>,
}

impl Default for LogRun {
    /// An empty run.
    fn default() -> Self {
        Self::with_pipeline(Pipeline::default())
    }
}

impl LogRun {
    fn with_pipeline(pipeline: Pipeline) -> Self {
        Self {
            settings: Vec::new(),
            resumed: pipeline.scans().len(),
            session_scans: pipeline.scans().len(),
            pipeline,
            record: Record::default(),
            sensor: None,
            loops: Vec::new(),
            held: Vec::new(),
            links: Vec::new(),
            poor: Vec::new(),
            stuck: StuckOdometry::default(),
            unsolved: None,
            lengths: PathLengths::default(),
            late: 0,
            blind: 0,
            still: Some(0),
            rejected: None,
            other_sensor: None,
            own_sensor: None,
            robots: Vec::new(),
            broken: None,
        }
    }

    /// Sets a parameter.
    ///
    /// # Errors
    /// If the value is out of range.
    pub fn with_setting(
        mut self,
        setting: &'static Setting,
        value: f64,
    ) -> Result<Self, SettingError> {
        setting.check(value)?;
        self.settings.push((setting, value));
        Ok(self)
    }

    /// Continues a session. If the first scan is the one after the session's last, the result is that of an
    /// uninterrupted run; otherwise the robot is searched for on the session's map, and until it is found, its scans are
    /// mapped on their own.
    ///
    /// # Errors
    /// If the session is inconsistent.
    pub fn resume(session: &Session) -> Result<Self, SnapshotError> {
        let slam = Slam::restore(&session.snapshot)?;
        Ok(Self::holding(session, slam))
    }

    /// Restores a session with its map as optimized at the end, for viewing and manual changes, not for further scans.
    /// A session saved from it can be continued.
    ///
    /// # Errors
    /// If the session is inconsistent.
    pub fn reopen(session: &Session) -> Result<Self, SnapshotError> {
        let mut slam = Slam::restore(&session.snapshot)?;
        *slam.graph_mut() = session.graph();
        let mut run = Self::holding(session, slam);
        run.pipeline = run.pipeline.resume_finished(session.snapshot.clone());
        Ok(run)
    }

    /// A run with the state of a session.
    fn holding(session: &Session, slam: Slam) -> Self {
        let keyframes = session.snapshot.keyframes.iter().enumerate();
        let of_keyframes = keyframes.map(|(number, keyframe)| ScanPose {
            stamp_s: keyframe.stamp_s,
            keyframe: number,
            keyframe_from_body: SE2::identity(),
        });
        let scans = if session.scan_poses.is_empty() {
            of_keyframes.collect()
        } else {
            session.scan_poses.clone()
        };
        let pipeline = Pipeline::resume(slam, scans, session.last_odometry);
        Self {
            sensor: session.sensor.clone(),
            record: Record::resume(session),
            ..Self::with_pipeline(pipeline)
        }
    }

    /// Takes the next scan; returns `None` if the scan is skipped because its stamp is not later than the one before or
    /// because it is invalid.
    pub fn step(&mut self, log: LogFrame) -> Option<SlamReport> {
        if self.pipeline.slam().is_none() && !self.settings.is_empty() {
            let mut robot = LocalMapConfig::for_scan(&log.scan);
            for (setting, value) in &self.settings {
                setting.apply(&mut robot, *value);
            }
            self.pipeline = std::mem::take(&mut self.pipeline).with_config(robot);
        }
        // Without odometry nothing tells how the robot moved before it saw something.
        if self.pipeline.slam().is_none()
            && log.odometry.is_none()
            && !log.scan.ranges_m.iter().any(|&m| log.scan.is_return(m))
        {
            self.blind += 1;
            return None;
        }
        let motion = self.pipeline.motion(&log);
        let pieces = self.pieces().len();
        let report = match self.pipeline.step(&log) {
            Ok(report) => report,
            Err(FrameError::Stamp { stamp_s, .. }) if stamp_s.is_finite() => {
                self.late += 1;
                return None;
            }
            Err(problem) => {
                self.rejected.get_or_insert(problem);
                return None;
            }
        };
        self.record.add(&log, &report);
        self.forget_left_out();
        if let Some(number) = report.new_keyframe {
            // The motion to the first keyframe of a piece is unknown.
            let continues = self.pieces().len() == pieces;
            self.lengths.add(number, log.odometry.filter(|_| continues));
        }
        if let Some(motion) = motion {
            let stands = motion == SE2::identity();
            self.still = self.still.filter(|_| stands).map(|scans| scans + 1);
        }
        let sensor = LaserScan {
            ranges_m: Vec::new(),
            velocity: None,
            ..log.scan
        };
        self.own_sensor.get_or_insert_with(|| sensor.clone());
        match &self.sensor {
            Some(known) if self.scans() == 1 && !has_same_beams(known, &sensor) => {
                self.other_sensor = Some(sensor);
            }
            Some(_) => {}
            None => self.sensor = Some(sensor),
        }
        let score = report.registration.and_then(|found| found.matched.score);
        let poor = score.filter(|score| *score < POOR_SCORE);
        let stands = motion.is_some_and(|motion| motion == SE2::identity());
        self.stuck.add(log.stamp_s, stands, poor.is_some());
        if let Some(score) = poor {
            self.poor.push(PoorFit {
                stamp_s: log.stamp_s,
                score,
            });
        }
        self.held.extend_from_slice(&report.loop_attempts);
        if !self.is_apart() {
            self.note_held();
        }
        Some(report)
    }

    /// Whether the newest scans are mapped on their own and not yet on the map.
    fn is_apart(&self) -> bool {
        let newest = self.pieces().last();
        newest.is_some_and(|piece| piece.fate == PieceFate::Alone)
    }

    fn note_held(&mut self) {
        let held = std::mem::take(&mut self.held);
        self.note(&held);
    }

    /// Ends the run: pending loops are accepted unless something contradicts them.
    pub fn finish(&mut self) {
        let concluded = self.pipeline.finish();
        self.forget_left_out();
        self.record.keep_mapped(self.pipeline.slam());
        self.note_held();
        if let Some(concluded) = concluded {
            self.links = concluded.links;
            self.unsolved = concluded.unsolved;
            self.note(&concluded.tried);
        }
    }

    /// Removes the loops of keyframes that were left out, and renumbers the others.
    fn forget_left_out(&mut self) {
        for LeftOut { keyframes, scans } in self.pipeline.take_left_out() {
            self.note_held();
            self.lengths.forget(&keyframes);
            self.resumed -= scans.end.min(self.resumed) - scans.start.min(self.resumed);
            self.loops.retain(|tried| {
                let found = &tried.verification;
                !keyframes.contains(&found.from_node) && !keyframes.contains(&found.candidate.node)
            });
            for tried in &mut self.loops {
                let found = &mut tried.verification;
                for node in [&mut found.from_node, &mut found.candidate.node] {
                    if *node >= keyframes.end {
                        *node -= keyframes.len();
                    }
                }
            }
            if keyframes.start == 0 {
                self.sensor.clone_from(&self.own_sensor);
                self.other_sensor = None;
            }
        }
    }

    /// Scans that did not continue those before them: of another day, after a restart, or of a robot that was carried.
    #[must_use]
    pub fn pieces(&self) -> &[PieceReport] {
        self.pipeline.pieces()
    }

    /// The gaps without odometry after which the robot was found around its last pose.
    #[must_use]
    pub fn bridged(&self) -> &[BridgedGap] {
        self.pipeline.bridged()
    }

    /// Records the results of loops; a pending loop is updated once it is accepted.
    fn note(&mut self, attempts: &[LoopAttempt]) {
        for attempt in attempts {
            let id = attempt.verification.id();
            let is_it = |tried: &&mut TriedLoop| tried.verification.id() == id;
            match self.loops.iter_mut().rev().find(is_it) {
                Some(tried) => *tried = TriedLoop::from(attempt),
                None => self.loops.push(TriedLoop::from(attempt)),
            }
        }
    }

    /// Whether the graph contains a loop: an accepted loop may have been removed since.
    #[must_use]
    pub fn has_loop(&self, tried: &TriedLoop) -> bool {
        let id = Some(tried.verification.id());
        let graph = self.slam().map(Slam::graph);
        let mut edges = graph.into_iter().flat_map(|graph| graph.edges());
        tried.accepted && edges.any(|view| view.loop_id() == id)
    }

    /// The estimator; `None` before the first scan.
    #[must_use]
    pub fn slam(&self) -> Option<&Slam> {
        self.pipeline.slam()
    }

    /// The estimator, for manual changes of its graph; `None` before the first scan.
    pub fn slam_mut(&mut self) -> Option<&mut Slam> {
        self.pipeline.slam_mut()
    }

    /// Sets the links of the graph after it was changed manually.
    pub fn set_links(&mut self, links: Vec<LoopVerification>) {
        self.links = links;
    }

    /// Number of scans taken, without those of a resumed session.
    #[must_use]
    pub fn scans(&self) -> usize {
        self.pipeline.scans().len() - self.resumed
    }

    /// The loops tested, in order.
    #[must_use]
    pub fn loops(&self) -> &[TriedLoop] {
        &self.loops
    }

    /// The links of the final pass, accepted or not.
    #[must_use]
    pub fn links(&self) -> &[LoopVerification] {
        &self.links
    }

    /// The scans with a poor fit.
    #[must_use]
    pub fn poor(&self) -> &[PoorFit] {
        &self.poor
    }

    /// The state of the run for saving; `None` before the first scan.
    ///
    /// A continued run starts from the last scan; the links of [`finish`](Self::finish) are kept separately.
    #[must_use]
    pub fn session(&self) -> Option<Session> {
        let slam = self.slam().filter(|_| self.pipeline.is_finished());
        let graph = slam.map(Slam::graph);
        let snapshot = self.pipeline.snapshot_before_finish()?;
        // Scans that are not yet on the map come last.
        let scans = self.pipeline.scans();
        let keyframes = snapshot.keyframes.len();
        let mapped_scans = scans.partition_point(|scan| scan.keyframe < keyframes);
        Some(Session {
            snapshot,
            mapped: graph.map(MappedGraph::from_graph),
            scan_poses: selected_scan_poses(&scans[..mapped_scans]),
            sensor: self.sensor.clone(),
            last_odometry: self.pipeline.last_odometry(),
        })
    }

    /// Evaluates the map's quality.
    pub fn quality(&mut self) -> Quality {
        Quality::new(
            self.pipeline.slam_mut(),
            &self.loops,
            &self.links,
            &self.poor,
            self.unsolved.as_ref(),
        )
    }

    /// The odometry at each keyframe, in its own frame, as far as it is known; none of a continued run's first part.
    #[must_use]
    pub fn odometry_at_keyframes(&self) -> &[Option<SE2>] {
        self.lengths.odometry()
    }

    /// Whether any keyframe's scan has a point.
    #[must_use]
    pub fn has_seen(&self) -> bool {
        let keyframes = self.slam().map_or(&[][..], Slam::keyframes);
        keyframes.iter().any(|keyframe| !keyframe.scan.is_empty())
    }

    /// Number of scans skipped because their stamp was not later than the one before.
    #[must_use]
    pub fn late(&self) -> usize {
        self.late
    }

    /// The pose of every scan by the current graph; those of a resumed session come first.
    #[must_use]
    pub fn trajectory(&self) -> Trajectory {
        let poses = self.pipeline.trajectory();
        let poses = poses.map(|(stamp_s, pose)| StampedPose { stamp_s, pose });
        Trajectory::new(poses.collect())
    }
}

/// Whether two sensors have the same beam geometry, to a thousandth of a step.
fn has_same_beams(one: &LaserScan, other: &LaserScan) -> bool {
    let little_rad = 1e-3 * one.angle_step_rad.abs();
    (one.first_angle_rad - other.first_angle_rad).abs() <= little_rad
        && (one.angle_step_rad - other.angle_step_rad).abs() <= little_rad
}
