//! The lap: a simulated drive, the estimator on its frames, and their comparison with the truth.
//!
//! [`Lap::step`] passes one tick of a [`Drive`] to the estimator and returns what it did, with its errors;
//! [`Lap::run`] loops over it. [`LapRunner`] runs a lap together with its front end alone and keeps what a
//! timeline needs. [`LapRun`] does so in pieces, and [`NewestLap`] serves a control that moves faster than
//! laps are computed.

mod choices;
mod config;
mod consistency;
mod digest;
mod drive;
mod innovations;
mod judge;
mod loop_error;
mod loop_words;
mod map;
mod newest;
mod own_loop;
mod path_errors;
mod ranges;
mod record;
mod replay;
mod report;
mod run;
mod runner;
mod settings;
mod soundness;
mod tested_loops;

use std::sync::Arc;

pub use ch16_slam2d::slam::{Change, LoopClosure, Registration, SlamConfig};
pub use choices::{
    BuiltInWorld, IncrementalKind, LapDetector, LapEstimator, LapFrontEnd, LapMatcher, LoopMatcher,
    NamedChoice,
};
pub use config::{CANONICAL_SEED, DriveConfig, GridExtent, LAP_TICKS, LapConfig};
pub use consistency::{HalfWay, LapConsistency};
pub use digest::lap_digest;
pub use drive::{Drive, DriveSimulation, DriveTick, SimulatedSweep};
pub use innovations::StepInnovations;
pub use judge::Judge;
pub use loop_error::{FALSE_LOOP_DISTANCE_M, FALSE_LOOP_TURN_DEG, LoopError, LoopJudgement};
pub use newest::{NewestLap, NewestStep};
pub use own_loop::{
    Claim, EdgeStrain, GateUse, OwnKernel, OwnLoop, OwnLoopError, OwnLoopRequest, edge_strain,
};
pub use path_errors::{PATH_SHARES, PathErrors};
pub use ranges::{ConfigRange, RANGES, random_config};
pub use record::{
    Epoch, GraphSummary, LAST_KEYFRAMES, LapRecord, LapSummary, LapTrace, RecordedEdge,
};
pub use replay::RegistrationView;
pub use report::{
    RecordedKeyframe, RecordedLoopAttempt, RecordedLoopEffect, RecordedWindowScan, TickMetrics,
    TickReport,
};
pub use run::LapRun;
pub use runner::LapRunner;
pub use settings::LapSettings;
pub use tested_loops::{AcceptedShares, TestedLoop};

use ch16_slam2d::chapter::ChapterParts;
use ch16_slam2d::graph::PoseGraph;
use ch16_slam2d::slam::{PendingFrame, Slam, SlamReport, Strategies};

/// The estimator on its lap, one tick at a time.
#[derive(Clone)]
pub struct Lap {
    config: LapConfig,
    drive: Arc<Drive>,
    tick: usize,
    slam: Slam,
    judge: Judge,
}

impl Lap {
    /// Simulates the drive of `config` and starts a lap on it.
    #[must_use]
    pub fn new(config: LapConfig) -> Self {
        let drive = Arc::new(Drive::simulate(&config.drive));
        Self::on_drive(config, drive)
    }

    /// Starts a lap on a simulated drive; `config.drive` must describe it.
    ///
    /// The estimator gets the first sweep and the drive's true start as the origin of its map.
    #[must_use]
    pub fn on_drive(config: LapConfig, drive: Arc<Drive>) -> Self {
        let strategies = Strategies::from_config(&config.slam);
        Self::with(config, drive, strategies)
    }

    /// The same with the chapter's estimator, custom matchers and a custom loop detector.
    #[must_use]
    pub fn with_parts(config: LapConfig, drive: Arc<Drive>, parts: ChapterParts) -> Self {
        let strategies = parts.into_strategies(&config.slam.chapter);
        Self::with(config, drive, strategies)
    }

    fn with(config: LapConfig, drive: Arc<Drive>, strategies: Strategies) -> Self {
        debug_assert_eq!(&config.drive, drive.config());
        let slam = SlamConfig {
            start: config.drive.start,
            scan: config.drive.scan,
            ..config.slam.clone()
        };
        let mut slam = Slam::with(slam, strategies);
        slam.step_prepared(&drive.prepared(0)).expect(USABLE);
        Self {
            judge: Judge::new(),
            tick: 0,
            slam,
            config,
            drive,
        }
    }

    /// Processes one tick; `None` once the lap is finished.
    pub fn step(&mut self) -> Option<TickReport> {
        let mut pending = self.begin()?;
        self.slam.verify_loops(&mut pending);
        self.slam.close_loop(&mut pending);
        Some(self.finish(pending))
    }

    /// Steps to the end of the lap. Returns the reports of all ticks.
    pub fn run(&mut self) -> Vec<TickReport> {
        let mut reports = Vec::with_capacity(self.drive.ticks().len() - self.tick);
        while let Some(report) = self.step() {
            reports.push(report);
        }
        reports
    }

    /// The parameters.
    #[must_use]
    pub fn config(&self) -> &LapConfig {
        &self.config
    }

    /// The simulated drive.
    #[must_use]
    pub fn drive(&self) -> &Arc<Drive> {
        &self.drive
    }

    /// The number of processed ticks.
    #[must_use]
    pub fn tick(&self) -> usize {
        self.tick
    }

    /// Whether the lap is finished.
    #[must_use]
    pub fn is_finished(&self) -> bool {
        self.tick == self.drive.ticks().len()
    }

    /// The estimator.
    #[must_use]
    pub fn slam(&self) -> &Slam {
        &self.slam
    }

    /// The estimator's pose graph; node k is keyframe k.
    #[must_use]
    pub fn graph(&self) -> &PoseGraph {
        self.slam.graph()
    }

    /// The keyframes with their truth.
    pub fn keyframes(&self) -> impl ExactSizeIterator<Item = RecordedKeyframe> + '_ {
        let keyframes = self.slam.keyframes().iter();
        keyframes.map(|keyframe| RecordedKeyframe {
            node: keyframe.node,
            tick: keyframe.frame,
            truth: self.drive.truth(keyframe.frame),
        })
    }

    /// The newest keyframe's node when the drive's turn was reached.
    #[must_use]
    pub fn turn_node(&self) -> Option<usize> {
        self.judge.turn_node()
    }

    /// Position errors of all keyframes at their present poses, m.
    pub fn keyframe_errors_m(&self) -> impl Iterator<Item = f64> + '_ {
        judge::keyframe_errors_m(
            self.slam.graph().poses(),
            self.slam.keyframes(),
            &self.drive,
        )
    }

    /// First part of a tick: registers the frame. The search for loops follows.
    fn begin(&mut self) -> Option<PendingFrame> {
        self.drive.ticks().get(self.tick)?;
        self.tick += 1;
        let frame = self.drive.prepared(self.tick);
        Some(self.slam.begin(&frame).expect(USABLE))
    }

    /// Last part of a tick: compares the estimator's report with the truth.
    fn finish(&mut self, pending: PendingFrame) -> TickReport {
        let report: SlamReport = self.slam.finish(pending);
        self.judge.judge(&report, &self.slam, &self.drive)
    }
}

/// A drive stamps its frames in order, with finite numbers.
const USABLE: &str = "frames of a drive are usable";
