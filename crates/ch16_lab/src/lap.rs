//! The lap: a front end that registers sweeps, a graph that remembers, and loops that correct.
//!
//! One tick: the wheels predict, ICP on the last six sweeps corrects, every 0.4 m or 0.35 rad a
//! keyframe enters the pose graph, and now and then an old keyframe is recognized and the graph
//! optimized. [`Slam::step`] does one tick and reports it, [`Slam::run`] all of them.
//! [`LapRunner`] runs a lap together with its front end alone and keeps what a timeline needs.
//!
//! What it cannot fix: drift that no loop sees, such as the bend of the outbound half before the
//! first loop, and a place that looks like another one within the gate.

mod config;
mod digest;
mod drive;
mod front_end;
mod loop_error;
mod loop_words;
mod record;
mod replay;
mod report;
mod runner;

use std::sync::Arc;

use pr_geom::SE2;

pub use config::{
    CANONICAL_SEED, DriveConfig, LAP_TICKS, LoopClosure, SlamConfig, ThresholdConfig,
};
pub use digest::lap_digest;
pub use drive::{Drive, DriveTick, Sweep};
pub use front_end::{FrontEnd, Registration, WindowSweep};
pub use loop_error::{FALSE_LOOP_DISTANCE_M, FALSE_LOOP_TURN_DEG, LoopError, LoopJudgement};
pub use record::{Epoch, LAST_KEYFRAMES, LapRecord, LapSummary, LapTrace, RecordedEdge};
pub use replay::RegistrationView;
pub use report::{Change, Keyframe, LoopAttempt, LoopEffect, SlamReport, TickMetrics};
pub use runner::LapRunner;

use ch16_slam2d::cloud::PointCloud;
use ch16_slam2d::graph::{EdgeKind, PoseGraph};
use ch16_slam2d::loops::{
    GateModel, KeyframeView, LoopVerification, LoopWorkspace, detect_loop_candidates,
    marginal_information, path_information, verify_loop,
};
use ch16_slam2d::metrics::{
    DisagreementConfig, MapDisagreement, position_error_m, trajectory_rms_m,
};

/// The SLAM system on its lap, one tick at a time.
#[derive(Clone)]
pub struct Slam {
    config: SlamConfig,
    drive: Arc<Drive>,
    tick: usize,
    front_end: FrontEnd,
    graph: PoseGraph,
    keyframes: Vec<Keyframe>,
    turn_node: Option<usize>,
    last_attempt_node: Option<usize>,
    loop_workspace: LoopWorkspace,
    disagreement: MapDisagreement,
    odometry_squares_m2: f64,
    chi2: f64,
}

impl Slam {
    /// Simulates the drive of `config` and stands at its start.
    #[must_use]
    pub fn new(config: SlamConfig) -> Self {
        let drive = Arc::new(Drive::simulate(&config.drive));
        Self::on_drive(config, drive)
    }

    /// Stands at the start of a drive that is already simulated; `config.drive` must describe it.
    #[must_use]
    pub fn on_drive(config: SlamConfig, drive: Arc<Drive>) -> Self {
        debug_assert_eq!(&config.drive, drive.config());
        let mut graph = PoseGraph::new();
        graph.add_fixed_node(config.drive.start);
        Self {
            front_end: FrontEnd::new(&config),
            graph,
            keyframes: vec![Keyframe {
                node: 0,
                tick: 0,
                truth: config.drive.start,
            }],
            turn_node: None,
            last_attempt_node: None,
            loop_workspace: LoopWorkspace::new(&config.loops.submap),
            disagreement: MapDisagreement::new(DisagreementConfig::default()),
            odometry_squares_m2: 0.0,
            chi2: 0.0,
            tick: 0,
            config,
            drive,
        }
    }

    /// Does one tick; nothing once the lap is finished.
    pub fn step(&mut self) -> Option<SlamReport> {
        let mut pending = self.advance()?;
        if let Some(verification) = self.verify_loop(&pending) {
            self.close_loop(&mut pending, verification);
        }
        Some(self.finish(pending))
    }

    /// Steps to the end of the lap and returns the reports of all ticks.
    pub fn run(&mut self) -> Vec<SlamReport> {
        let mut reports = Vec::with_capacity(self.drive.ticks().len() - self.tick);
        while let Some(report) = self.step() {
            reports.push(report);
        }
        reports
    }

    /// The parameters.
    #[must_use]
    pub fn config(&self) -> &SlamConfig {
        &self.config
    }

    /// The drive under it.
    #[must_use]
    pub fn drive(&self) -> &Arc<Drive> {
        &self.drive
    }

    /// Ticks done.
    #[must_use]
    pub fn tick(&self) -> usize {
        self.tick
    }

    /// Whether the lap is finished.
    #[must_use]
    pub fn is_finished(&self) -> bool {
        self.tick == self.drive.ticks().len()
    }

    /// Local map, window, threshold and estimate.
    #[must_use]
    pub fn front_end(&self) -> &FrontEnd {
        &self.front_end
    }

    /// The pose graph; node k is keyframe k.
    #[must_use]
    pub fn graph(&self) -> &PoseGraph {
        &self.graph
    }

    /// The keyframes in order.
    #[must_use]
    pub fn keyframes(&self) -> &[Keyframe] {
        &self.keyframes
    }

    /// The newest keyframe's node when the way point was reached from which on places are seen again.
    #[must_use]
    pub fn turn_node(&self) -> Option<usize> {
        self.turn_node
    }

    /// Submap and pairs of the last attempt to close a loop.
    #[must_use]
    pub fn loop_workspace(&self) -> &LoopWorkspace {
        &self.loop_workspace
    }

    /// Position errors of all keyframes at their present poses, m.
    pub fn keyframe_errors_m(&self) -> impl Iterator<Item = f64> + '_ {
        self.graph
            .poses()
            .iter()
            .zip(&self.keyframes)
            .map(|(pose, keyframe)| position_error_m(pose, &keyframe.truth))
    }

    /// First part of a tick: drive, predict, register, and take a keyframe where one is due.
    fn advance(&mut self) -> Option<PendingTick> {
        let driven = self.drive.ticks().get(self.tick)?;
        // The node to remember is the newest before this tick's keyframe.
        if driven.reached.is_some() && driven.reached == self.config.drive.turn {
            self.turn_node = Some(self.keyframes.len() - 1);
            self.restart_disagreement();
        }
        self.tick += 1;
        let registration = self
            .front_end
            .register(&self.drive, self.tick, &self.config);
        let new_keyframe = self.take_keyframe();
        Some(PendingTick {
            registration,
            new_keyframe,
            loop_attempt: None,
        })
    }

    /// Adds a node where the estimate is far enough from the last keyframe.
    fn take_keyframe(&mut self) -> Option<usize> {
        let last_node = self.keyframes.len() - 1;
        let last_pose = self.graph.pose(last_node);
        let estimate = self.front_end.estimate();
        let relative = last_pose.between(&estimate);
        let distance = position_error_m(&relative, &SE2::identity());
        if distance < self.config.keyframe_distance_m
            && relative.theta().abs() < self.config.keyframe_turn_rad
        {
            return None;
        }
        let information = self.front_end.information(last_pose.theta(), &self.config);
        let node = self.graph.add_node(estimate);
        self.graph
            .add_edge(last_node, node, relative, information, EdgeKind::Odometry);
        self.keyframes.push(Keyframe {
            node: node.index(),
            tick: self.tick,
            truth: self.drive.truth(self.tick),
        });
        self.chi2 = self.graph.chi2();
        if self.turn_node.is_some() {
            self.compare_keyframe(node.index());
        }
        Some(node.index())
    }

    /// Second part of a tick: looks for a loop at a new keyframe and verifies the best candidate.
    fn verify_loop(&mut self, pending: &PendingTick) -> Option<LoopVerification> {
        let node = pending.new_keyframe?;
        if self.config.loop_closure == LoopClosure::Off {
            return None;
        }
        let loops = &self.config.loops;
        if let Some(last) = self.last_attempt_node
            && node - last < loops.attempt_every_nodes
        {
            return None;
        }
        self.last_attempt_node = Some(node);
        let candidate = *detect_loop_candidates(self.graph.poses(), node, loops).first()?;
        let gate_information = match loops.gate_model {
            GateModel::PathApproximation => path_information(node - candidate.node, loops),
            GateModel::ExactMarginal => marginal_information(&mut self.graph, candidate.node, node),
        };
        let clouds: Vec<&PointCloud> = self
            .keyframes
            .iter()
            .map(|keyframe| &self.drive.sweep(keyframe.tick).cloud)
            .collect();
        let keyframes = KeyframeView {
            poses: self.graph.poses(),
            clouds: &clouds,
        };
        Some(verify_loop(
            keyframes,
            node,
            candidate,
            &gate_information,
            loops,
            &mut self.loop_workspace,
        ))
    }

    /// Third part: adds the edge of a loop that passed and spreads the correction.
    fn close_loop(&mut self, pending: &mut PendingTick, verification: LoopVerification) {
        let effect = verification
            .accepted()
            .then(|| self.optimize_with(&verification));
        pending.loop_attempt = Some(LoopAttempt {
            tick: self.tick,
            verification,
            effect,
        });
    }

    fn optimize_with(&mut self, verification: &LoopVerification) -> LoopEffect {
        let old_poses = self.graph.poses().to_vec();
        let rms_before = self.keyframe_rms_m();
        self.graph.add_edge(
            verification.candidate.node,
            verification.from_node,
            verification.registered,
            verification.information,
            EdgeKind::Loop,
        );
        let chi2_before = self.graph.chi2();
        let report = self.graph.optimize_robust(
            self.config.optimizer_iterations,
            self.config.optimizer_tolerance,
            self.config.huber,
        );
        self.chi2 = self.graph.chi2();
        let newest = verification.from_node;
        let correction = self.graph.pose(newest) * old_poses[newest].inverse();
        self.front_end.correct(&correction);
        self.restart_disagreement();
        let max_shift_m = old_poses
            .iter()
            .zip(self.graph.poses())
            .map(|(old, new)| position_error_m(new, old))
            .fold(0.0, f64::max);
        LoopEffect {
            correction,
            max_shift_m,
            iterations: report.iterations,
            chi2: Change {
                before: chi2_before,
                after: self.chi2,
            },
            keyframe_rms_m: Change {
                before: rms_before,
                after: self.keyframe_rms_m(),
            },
        }
    }

    /// Last part of a tick: the metrics and the report.
    fn finish(&mut self, pending: PendingTick) -> SlamReport {
        let driven = &self.drive.ticks()[self.tick - 1];
        let estimate = self.front_end.estimate();
        let odometry_error_m = position_error_m(&driven.dead_reckoning, &driven.truth);
        self.odometry_squares_m2 += odometry_error_m * odometry_error_m;
        let newest = self.keyframes[self.keyframes.len() - 1];
        SlamReport {
            tick: self.tick,
            time_s: self.tick as f64 * self.config.drive.dt_s,
            command: driven.command,
            truth: driven.truth,
            dead_reckoning: driven.dead_reckoning,
            registration: pending.registration,
            estimate,
            new_keyframe: pending.new_keyframe,
            loop_attempt: pending.loop_attempt,
            metrics: TickMetrics {
                odometry_error_m,
                estimate_error_m: position_error_m(&estimate, &driven.truth),
                odometry_rms_m: pr_geom::math::sqrt(self.odometry_squares_m2 / self.tick as f64),
                keyframe_rms_m: self.keyframe_rms_m(),
                keyframe_error_m: position_error_m(&self.graph.pose(newest.node), &newest.truth),
                map_disagreement_m: self.disagreement.value_m(),
                chi2: self.chi2,
            },
            finished: self.is_finished(),
        }
    }

    fn keyframe_rms_m(&self) -> f64 {
        let truths = self.keyframes.iter().map(|keyframe| &keyframe.truth);
        trajectory_rms_m(self.graph.poses(), truths)
    }

    /// Builds the map of the way out anew and compares all keyframes of the way back with it.
    fn restart_disagreement(&mut self) {
        let Some(turn_node) = self.turn_node else {
            return;
        };
        let poses = self.graph.poses();
        let cloud_of = |keyframe: &Keyframe| &self.drive.sweep(keyframe.tick).cloud;
        self.disagreement.start(
            poses
                .iter()
                .zip(self.keyframes[..=turn_node].iter().map(cloud_of)),
        );
        for node in turn_node + 1..self.keyframes.len() {
            self.compare_keyframe(node);
        }
    }

    fn compare_keyframe(&mut self, node: usize) {
        let cloud = &self.drive.sweep(self.keyframes[node].tick).cloud;
        self.disagreement.compare(&self.graph.pose(node), cloud);
    }
}

/// A tick under way.
#[derive(Clone)]
struct PendingTick {
    registration: Registration,
    new_keyframe: Option<usize>,
    loop_attempt: Option<LoopAttempt>,
}
