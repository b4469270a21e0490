//! A log through the pipeline, with what its owner should know of it.

use ch16_slam2d::loops::LoopVerification;
pub use ch16_slam2d::pipeline::OdometryUse;
use ch16_slam2d::pipeline::{Pipeline, ScanPose};
use ch16_slam2d::scan::{FrameError, LaserScan};
use ch16_slam2d::slam::{LoopAttempt, RobotConfig, Slam, SlamReport, SnapshotError};
use pr_geom::SE2;

use crate::evidence::{PoorFit, TriedLoop};
use crate::log::LogFrame;
use crate::quality::Quality;
use crate::session::{MappedGraph, Session, places_kept};
use crate::settings::Setting;
use crate::trajectory::{StampedPose, Trajectory};

/// What is said of a log in which no beam tells anything.
pub const NOTHING_SEEN: &str = "no beam of any keyframe has a range between the shortest and the longest that the sensor tells";

/// Wheels that stand still in a log of so many scans are told: they may not have been recorded.
const STILL_SCANS: usize = 20;

/// Scans of which less than this fits are told.
const POOR_SCORE: f64 = 0.5;

/// A log under way: the pipeline of the core, and the evidence for whoever judges its map.
pub struct LogRun {
    settings: Vec<(&'static Setting, f64)>,
    pipeline: Pipeline,
    /// How many of its scans are those of a session.
    resumed: usize,
    /// Where the beams point, without ranges.
    sensor: Option<LaserScan>,
    loops: Vec<TriedLoop>,
    links: Vec<LoopVerification>,
    poor: Vec<PoorFit>,
    late: usize,
    /// Scans for which the wheels told that they stand still; none once they moved.
    still: Option<usize>,
    refused: Option<FrameError>,
    /// Where the beams of the log point that a session goes on with, where it is not as in the session.
    other_sensor: Option<LaserScan>,
}

/// What is said of a log with scans that are not after the one before them; nothing where it has none.
#[must_use]
pub fn late_scans(name: &str, late: usize) -> Option<String> {
    match late {
        0 => None,
        1 => Some(format!(
            "{name}: one scan is not after the one before it and was left out"
        )),
        _ => Some(format!(
            "{name}: {late} scans are not after the one before them and were left out"
        )),
    }
}

impl LogRun {
    /// A run that has seen nothing.
    #[must_use]
    pub fn new(odometry_use: OdometryUse) -> Self {
        Self::with_pipeline(Pipeline::new(odometry_use))
    }

    fn with_pipeline(pipeline: Pipeline) -> Self {
        Self {
            settings: Vec::new(),
            resumed: pipeline.scans().len(),
            pipeline,
            sensor: None,
            loops: Vec::new(),
            links: Vec::new(),
            poor: Vec::new(),
            late: 0,
            still: Some(0),
            refused: None,
            other_sensor: None,
        }
    }

    /// The same run with another value of a setting, if it can take that value.
    #[must_use]
    pub fn with_setting(mut self, setting: &'static Setting, value: f64) -> Self {
        self.settings.push((setting, value));
        self
    }

    /// A run that goes on where a session ended, in the same odometry's frame: its first scan is the
    /// one after the session's last.
    ///
    /// # Errors
    /// Where the session contradicts itself.
    pub fn resume(session: &Session, odometry_use: OdometryUse) -> Result<Self, SnapshotError> {
        let slam = Slam::restore(&session.driven)?;
        Ok(Self::holding(session, slam, odometry_use))
    }

    /// A run that stands where a session was saved, with its map as it was linked at the end: to be looked
    /// at and changed by hand, not to be gone on with. What it is saved as, a run goes on with.
    ///
    /// # Errors
    /// Where the session contradicts itself.
    pub fn reopen(session: &Session) -> Result<Self, SnapshotError> {
        let mut slam = Slam::restore(&session.driven)?;
        *slam.graph_mut() = session.graph();
        let mut run = Self::holding(session, slam, OdometryUse::Log);
        run.pipeline = run.pipeline.resume_finished(session.driven.clone());
        Ok(run)
    }

    /// A run with what a session has seen.
    fn holding(session: &Session, slam: Slam, odometry_use: OdometryUse) -> Self {
        let keyframes = session.driven.keyframes.iter().enumerate();
        let of_keyframes = keyframes.map(|(number, keyframe)| ScanPose {
            stamp_s: keyframe.stamp_s,
            keyframe: number,
            keyframe_from_body: SE2::identity(),
        });
        let scans = if session.places.is_empty() {
            of_keyframes.collect()
        } else {
            session.places.clone()
        };
        let pipeline = Pipeline::resume(slam, scans, session.last_odometry, odometry_use);
        Self {
            sensor: session.sensor.clone(),
            ..Self::with_pipeline(pipeline)
        }
    }

    /// Takes the next scan; none where it is left out, because it is not after the one before it or
    /// because its numbers are no scan.
    pub fn step(&mut self, log: LogFrame) -> Option<SlamReport> {
        if self.pipeline.slam().is_none() && !self.settings.is_empty() {
            let mut robot = RobotConfig::for_scan(&log.scan);
            for (setting, value) in &self.settings {
                robot = setting.set(&robot, *value).unwrap_or(robot);
            }
            self.pipeline = std::mem::take(&mut self.pipeline).with_config(robot);
        }
        let motion = self.pipeline.motion(&log);
        let report = match self.pipeline.step(&log) {
            Ok(report) => report,
            Err(FrameError::Stamp { stamp_s, .. }) if stamp_s.is_finite() => {
                self.late += 1;
                return None;
            }
            Err(problem) => {
                self.refused.get_or_insert(problem);
                return None;
            }
        };
        if let Some(motion) = motion {
            let stands = motion == SE2::identity();
            self.still = self.still.filter(|_| stands).map(|scans| scans + 1);
        }
        let sensor = LaserScan {
            ranges_m: Vec::new(),
            ..log.scan
        };
        match &self.sensor {
            Some(known) if self.scans() == 1 && !has_same_beams(known, &sensor) => {
                self.other_sensor = Some(sensor);
            }
            Some(_) => {}
            None => self.sensor = Some(sensor),
        }
        let score = report.registration.and_then(|found| found.matched.score);
        if let Some(score) = score.filter(|score| *score < POOR_SCORE) {
            self.poor.push(PoorFit {
                stamp_s: log.stamp_s,
                score,
            });
        }
        self.note(&report.loop_attempts);
        Some(report)
    }

    /// Says that no scan follows: loops that wait are closed where nothing contradicts them.
    pub fn finish(&mut self) {
        if let Some(concluded) = self.pipeline.finish() {
            self.links = concluded.links;
            self.note(&concluded.tried);
        }
    }

    /// Keeps what became of loops; one that waited is the same loop once it is closed.
    fn note(&mut self, attempts: &[LoopAttempt]) {
        for attempt in attempts {
            let found = &attempt.verification;
            let is_it = |tried: &&mut TriedLoop| {
                let waited = &tried.verification;
                (waited.from_node, waited.registered) == (found.from_node, found.registered)
            };
            match self.loops.iter_mut().rev().find(is_it) {
                Some(tried) => *tried = TriedLoop::from(attempt),
                None => self.loops.push(TriedLoop::from(attempt)),
            }
        }
    }

    /// Whether the graph holds a loop: those that were closed may have been taken out by others since.
    #[must_use]
    pub fn holds(&self, tried: &TriedLoop) -> bool {
        let measured = tried.verification.registered;
        let graph = self.slam().map(Slam::graph);
        let mut edges = graph.into_iter().flat_map(|graph| graph.edges());
        tried.accepted && edges.any(|view| view.edge.measurement == measured)
    }

    /// The estimator; none before the first scan.
    #[must_use]
    pub fn slam(&self) -> Option<&Slam> {
        self.pipeline.slam()
    }

    /// The estimator, for who changes its graph by hand; none before the first scan.
    pub fn slam_mut(&mut self) -> Option<&mut Slam> {
        self.pipeline.slam_mut()
    }

    /// Says which links are in the graph, after it was changed by hand.
    pub fn set_links(&mut self, links: Vec<LoopVerification>) {
        self.links = links;
    }

    /// Scans taken, without those of a session that it goes on from.
    #[must_use]
    pub fn scans(&self) -> usize {
        self.pipeline.scans().len() - self.resumed
    }

    /// The loops that were looked at, in order.
    #[must_use]
    pub fn loops(&self) -> &[TriedLoop] {
        &self.loops
    }

    /// The links of the last pass after the end, accepted or not.
    #[must_use]
    pub fn links(&self) -> &[LoopVerification] {
        &self.links
    }

    /// The scans that hardly fit.
    #[must_use]
    pub fn poor(&self) -> &[PoorFit] {
        &self.poor
    }

    /// All that the run is, to be saved; none before the first scan.
    ///
    /// To go on from it is to go on from the last scan: what [`finish`](Self::finish) linked anew is
    /// kept beside it.
    #[must_use]
    pub fn session(&self) -> Option<Session> {
        let slam = self.slam().filter(|_| self.pipeline.is_finished());
        let graph = slam.map(Slam::graph);
        Some(Session {
            driven: self.pipeline.snapshot_before_finish()?,
            mapped: graph.map(MappedGraph::from_graph),
            places: places_kept(self.pipeline.scans()),
            sensor: self.sensor.clone(),
            last_odometry: self.pipeline.last_odometry(),
        })
    }

    /// What is known of the map's quality.
    pub fn quality(&mut self) -> Quality {
        Quality::new(
            self.pipeline.slam_mut(),
            &self.loops,
            &self.links,
            &self.poor,
        )
    }

    /// Whether any keyframe's scan has a point.
    #[must_use]
    pub fn has_seen(&self) -> bool {
        let keyframes = self.slam().map_or(&[][..], Slam::keyframes);
        keyframes.iter().any(|keyframe| !keyframe.scan.is_empty())
    }

    /// Scans left out because their stamp was not after the one before.
    #[must_use]
    pub fn late(&self) -> usize {
        self.late
    }

    /// Why the first scan was refused whose numbers are no scan.
    #[must_use]
    pub fn refused(&self) -> Option<FrameError> {
        self.refused
    }

    /// What the owner of a log should know of the scans that were taken from it, and of those left out.
    #[must_use]
    pub fn sentences(&self, name: &str) -> Vec<String> {
        let other = self.sensor.as_ref().zip(self.other_sensor.as_ref());
        let other = other.map(|(known, other)| {
            let [known, other] = [known, other].map(|sensor| {
                let degrees = |angle_rad: f64| angle_rad.to_degrees();
                format!(
                    "start at {:.1}° and stand {:.2}° apart",
                    degrees(sensor.first_angle_rad),
                    degrees(sensor.angle_step_rad)
                )
            });
            format!(
                "{name}: its beams {other}, and those of the session {known}; the values stay those for the \
                 session's scanner"
            )
        });
        let refused = self
            .refused
            .map(|problem| format!("{name}: scans were left out; the first because {problem}"));
        let late = late_scans(name, self.late);
        let still = self.still_wheels(name);
        [other, late, still, refused]
            .into_iter()
            .flatten()
            .collect()
    }

    /// What is said of wheels that never moved; nothing where they did.
    fn still_wheels(&self, name: &str) -> Option<String> {
        let scans = self.still.filter(|&scans| scans >= STILL_SCANS)?;
        Some(format!(
            "{name}: its odometry stands still for all {scans} scans; if the robot moved, leave it out with \
             slam2d run LOG --no-odometry"
        ))
    }

    /// Where every scan was taken, by the graph as it is now; those of a session come first.
    #[must_use]
    pub fn trajectory(&self) -> Trajectory {
        let poses = self.pipeline.trajectory();
        let poses = poses.map(|(stamp_s, pose)| StampedPose { stamp_s, pose });
        Trajectory::new(poses.collect())
    }
}

/// Whether two sensors point their beams the same way, to a thousandth of a step.
fn has_same_beams(one: &LaserScan, other: &LaserScan) -> bool {
    let little_rad = 1e-3 * one.angle_step_rad.abs();
    (one.first_angle_rad - other.first_angle_rad).abs() <= little_rad
        && (one.angle_step_rad - other.angle_step_rad).abs() <= little_rad
}
