//! A log through the estimator, one scan at a time.

use ch16_slam2d::graph::PoseGraph;
use ch16_slam2d::loops::LoopVerification;
use ch16_slam2d::scan::{Frame, FrameError, LaserScan};
use ch16_slam2d::slam::{
    LoopAttempt, RobotConfig, Slam, SlamConfig, SlamReport, SlamSnapshot, SnapshotError,
};
use pr_geom::SE2;

use crate::evidence::{PoorFit, TriedLoop};
use crate::log::LogFrame;
use crate::quality::Quality;
use crate::session::{MappedGraph, ScanPlace, Session, places_kept};
use crate::settings::Setting;
use crate::trajectory::{StampedPose, Trajectory};

/// What is said of a log in which no beam tells anything.
pub const NOTHING_SEEN: &str = "no beam of any keyframe has a range between the shortest and the longest that the sensor tells";

/// Whether the wheels are listened to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum OdometryUse {
    /// The odometry of the log predicts each scan.
    #[default]
    Log,
    /// Scans alone: the velocity is expected to stay.
    None,
}

/// Wheels that stand still in a log of so many scans are told: they may not have been recorded.
const STILL_SCANS: usize = 20;

/// Scans of which less than this fits are told.
const POOR_SCORE: f64 = 0.5;

/// A log under way: the estimator, and where each scan was taken from.
///
/// The pose of a scan is kept in the frame of the keyframe before it, so that every loop moves the
/// scans in between as well.
pub struct LogRun {
    odometry_use: OdometryUse,
    settings: Vec<(&'static Setting, f64)>,
    slam: Option<Slam>,
    last_odometry: Option<SE2>,
    last_stamp_s: f64,
    scans: Vec<ScanPlace>,
    /// How many of them are those of a session.
    resumed: usize,
    /// Where the beams point, without ranges.
    sensor: Option<LaserScan>,
    /// The estimator after the last scan, once its map was linked anew.
    driven: Option<SlamSnapshot>,
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
        Self {
            odometry_use,
            settings: Vec::new(),
            slam: None,
            last_odometry: None,
            last_stamp_s: f64::NEG_INFINITY,
            scans: Vec::new(),
            resumed: 0,
            sensor: None,
            driven: None,
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
        let slam = Slam::restore(&session.driven)?.with_outlier_test(PoseGraph::believed);
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
        Ok(Self {
            driven: Some(session.driven.clone()),
            ..Self::holding(session, slam, OdometryUse::Log)
        })
    }

    /// A run with what a session has seen.
    fn holding(session: &Session, slam: Slam, odometry_use: OdometryUse) -> Self {
        let driven = &session.driven;
        let keyframes = driven.keyframes.iter().enumerate();
        let of_keyframes = keyframes.map(|(number, keyframe)| ScanPlace {
            stamp_s: keyframe.stamp_s,
            keyframe: number,
            keyframe_from_body: SE2::identity(),
        });
        let scans = if session.places.is_empty() {
            of_keyframes.collect()
        } else {
            session.places.clone()
        };
        Self {
            slam: Some(slam),
            last_odometry: session.last_odometry,
            last_stamp_s: driven.last_stamp_s,
            resumed: scans.len(),
            scans,
            sensor: session.sensor.clone(),
            ..Self::new(odometry_use)
        }
    }

    /// Takes the next scan; none where it is left out, because it is not after the one before it or
    /// because its numbers are no scan.
    pub fn step(&mut self, log: LogFrame) -> Option<SlamReport> {
        if log.stamp_s <= self.last_stamp_s {
            self.late += 1;
            return None;
        }
        let motion = match (self.odometry_use, self.last_odometry, log.odometry) {
            (OdometryUse::Log, Some(last), Some(now)) => Some(last.between(&now)),
            _ => None,
        };
        let frame = Frame {
            stamp_s: log.stamp_s,
            odometry: motion,
            scan: log.scan,
        };
        let slam = self.slam.get_or_insert_with(|| {
            let mut robot = RobotConfig::for_scan(&frame.scan);
            for (setting, value) in &self.settings {
                robot = setting.set(&robot, *value).unwrap_or(robot);
            }
            Slam::new(SlamConfig::from_robot(robot)).with_outlier_test(PoseGraph::believed)
        });
        let report = match slam.step(&frame) {
            Ok(report) => report,
            Err(problem) => {
                self.refused.get_or_insert(problem);
                return None;
            }
        };
        self.last_stamp_s = frame.stamp_s;
        self.last_odometry = log.odometry;
        if let Some(motion) = motion {
            let stands = motion == SE2::identity();
            self.still = self.still.filter(|_| stands).map(|scans| scans + 1);
        }
        self.driven = None;
        let sensor = LaserScan {
            ranges_m: Vec::new(),
            ..frame.scan
        };
        match &self.sensor {
            Some(known) if self.scans.len() == self.resumed && !has_same_beams(known, &sensor) => {
                self.other_sensor = Some(sensor);
            }
            Some(_) => {}
            None => self.sensor = Some(sensor),
        }
        let keyframe = slam.keyframes().len() - 1;
        self.scans.push(ScanPlace {
            stamp_s: frame.stamp_s,
            keyframe,
            keyframe_from_body: slam.graph().pose(keyframe).between(&report.estimate),
        });
        let score = report.registration.and_then(|found| found.matched.score);
        if let Some(score) = score.filter(|score| *score < POOR_SCORE) {
            self.poor.push(PoorFit {
                stamp_s: frame.stamp_s,
                score,
            });
        }
        self.note(&report.loop_attempts);
        Some(report)
    }

    /// Says that no scan follows: loops that wait are closed where nothing contradicts them.
    pub fn finish(&mut self) {
        let Some(slam) = self.slam.as_mut().filter(|_| self.driven.is_none()) else {
            return;
        };
        self.driven = Some(slam.snapshot());
        let concluded = slam.conclude();
        self.links = concluded.links;
        self.note(&concluded.tried);
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
        let graph = self.slam.as_ref().map(Slam::graph);
        let mut edges = graph.into_iter().flat_map(|graph| graph.edges());
        tried.accepted && edges.any(|view| view.edge.measurement == measured)
    }

    /// The estimator; none before the first scan.
    #[must_use]
    pub fn slam(&self) -> Option<&Slam> {
        self.slam.as_ref()
    }

    /// The estimator, for who changes its graph by hand; none before the first scan.
    pub fn slam_mut(&mut self) -> Option<&mut Slam> {
        self.slam.as_mut()
    }

    /// Says which links are in the graph, after it was changed by hand.
    pub fn set_links(&mut self, links: Vec<LoopVerification>) {
        self.links = links;
    }

    /// Scans taken, without those of a session that it goes on from.
    #[must_use]
    pub fn scans(&self) -> usize {
        self.scans.len() - self.resumed
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
        let slam = self.slam.as_ref()?;
        let is_finished = self.driven.is_some();
        Some(Session {
            driven: self.driven.clone().unwrap_or_else(|| slam.snapshot()),
            mapped: is_finished.then(|| MappedGraph::of(slam.graph())),
            places: places_kept(&self.scans),
            sensor: self.sensor.clone(),
            last_odometry: self.last_odometry,
        })
    }

    /// What is known of the map's quality.
    pub fn quality(&mut self) -> Quality {
        Quality::of(self.slam.as_mut(), &self.loops, &self.links, &self.poor)
    }

    /// Whether any keyframe's scan has a point.
    #[must_use]
    pub fn has_seen(&self) -> bool {
        let keyframes = self.slam.as_ref().map_or(&[][..], |slam| slam.keyframes());
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
        let Some(slam) = &self.slam else {
            return Trajectory::default();
        };
        let poses = slam.graph().poses();
        let places = self.scans.iter().map(|scan| StampedPose {
            stamp_s: scan.stamp_s,
            pose: poses[scan.keyframe] * scan.keyframe_from_body,
        });
        Trajectory::new(places.collect())
    }
}

/// Whether two sensors point their beams the same way, to a thousandth of a step.
fn has_same_beams(one: &LaserScan, other: &LaserScan) -> bool {
    let little_rad = 1e-3 * one.angle_step_rad.abs();
    (one.first_angle_rad - other.first_angle_rad).abs() <= little_rad
        && (one.angle_step_rad - other.angle_step_rad).abs() <= little_rad
}
