//! The estimator: a front end that registers scans, a graph that remembers, and loops that correct.
//!
//! One frame: odometry predicts, a matcher on the last few sweeps corrects, every so often a
//! keyframe enters the pose graph, and now and then an old keyframe is recognized and the graph
//! optimized. [`Slam::step`] takes one [`Frame`] and reports what it did with it.
//!
//! It knows no truth and no world. Matcher, loop detector, gate and kernel are chosen in the
//! [`SlamConfig`] or handed to [`Slam::with_parts`].
//!
//! What it cannot fix: drift that no loop sees, such as the bend of a way out before the first
//! loop, and a place that looks like another one within the gate.

mod config;
mod front_end;
mod motion;
mod report;
mod scales;

use std::sync::Arc;

use nalgebra::Vector3;
use pr_geom::SE2;

pub use config::{LoopClosure, SlamConfig, ThresholdConfig};
pub use front_end::{FrontEnd, Registration, WindowSweep};
pub use motion::MotionNoise;
pub use report::{Change, Keyframe, LoopAttempt, LoopEffect, SlamReport};

use crate::graph::{EdgeKind, PoseGraph};
use crate::loops::{
    GateModel, KeyframeView, LoopCandidate, LoopDetector, LoopQuery, LoopRejection,
    LoopVerification, LoopWorkspace, NearbyDetector, marginal_information, path_information,
    verify_loop,
};
use crate::matching::Matcher;
use crate::metrics::position_error_m;
use crate::scan::{Frame, FrameError, PreparedFrame, ScanPreparer, is_finite};

/// The parts of the estimator that can be exchanged.
#[derive(Clone)]
pub struct SlamParts {
    /// Registers each scan on the local map.
    pub front_end: Box<dyn Matcher>,
    /// Registers a new keyframe on the submap of a loop's candidate.
    pub loops: Box<dyn Matcher>,
    /// Proposes loops.
    pub detector: Box<dyn LoopDetector>,
}

impl SlamParts {
    /// The parts that `config` names.
    #[must_use]
    pub fn of(config: &SlamConfig) -> Self {
        Self {
            front_end: config.matcher.build(&config.local_map),
            loops: config.loops.matcher.build(&config.loops.submap),
            detector: Box::new(NearbyDetector::new(config.loops)),
        }
    }
}

/// The SLAM system, one frame at a time.
#[derive(Clone)]
pub struct Slam {
    config: SlamConfig,
    preparer: ScanPreparer,
    frames: usize,
    last_stamp_s: f64,
    front_end: FrontEnd,
    graph: PoseGraph,
    keyframes: Vec<Keyframe>,
    last_attempt_node: Option<usize>,
    detector: Box<dyn LoopDetector>,
    loop_workspace: LoopWorkspace,
    chi2: f64,
}

/// A frame under way: registered, its loops not yet decided.
#[derive(Clone, Debug)]
pub struct PendingFrame {
    stamp_s: f64,
    registration: Option<Registration>,
    new_keyframe: Option<usize>,
    loop_attempts: Vec<LoopAttempt>,
}

impl PendingFrame {
    /// Node of the keyframe that was taken.
    #[must_use]
    pub fn new_keyframe(&self) -> Option<usize> {
        self.new_keyframe
    }

    /// Whether a loop passed its tests and will be closed.
    #[must_use]
    pub fn has_loop(&self) -> bool {
        let newest = self.loop_attempts.last();
        newest.is_some_and(|attempt| attempt.verification.accepted())
    }

    /// The same frame with its loops forgotten, as if none had been looked for.
    #[must_use]
    pub fn without_loops(mut self) -> Self {
        self.loop_attempts.clear();
        self
    }

    /// Poses of all nodes before a loop was closed in this frame.
    #[must_use]
    pub fn poses_before_loop(&self) -> Option<&[SE2]> {
        let effect = self.loop_attempts.last()?.effect.as_ref()?;
        Some(&effect.poses_before)
    }
}

impl Slam {
    /// An estimator that has seen nothing, with the parts that `config` names.
    #[must_use]
    pub fn new(config: SlamConfig) -> Self {
        let parts = SlamParts::of(&config);
        Self::with_parts(config, parts)
    }

    /// An estimator with matchers and a loop detector of one's own.
    #[must_use]
    pub fn with_parts(config: SlamConfig, parts: SlamParts) -> Self {
        Self {
            front_end: FrontEnd::new(&config, parts.front_end),
            loop_workspace: LoopWorkspace::new(parts.loops),
            detector: parts.detector,
            graph: PoseGraph::new(),
            keyframes: Vec::new(),
            preparer: ScanPreparer::new(),
            frames: 0,
            last_stamp_s: f64::NEG_INFINITY,
            last_attempt_node: None,
            chi2: 0.0,
            config,
        }
    }

    /// Takes one frame: cleans its scan, registers it, and closes what loop it finds.
    ///
    /// # Errors
    /// Where the frame cannot be used; the estimator stays as it was.
    pub fn step(&mut self, frame: &Frame) -> Result<SlamReport, FrameError> {
        let prepared = self.prepare(frame)?;
        self.step_prepared(&prepared)
    }

    /// [`Slam::step`] with a scan that is already a cloud.
    ///
    /// # Errors
    /// Where the frame cannot be used; the estimator stays as it was.
    pub fn step_prepared(&mut self, frame: &PreparedFrame) -> Result<SlamReport, FrameError> {
        let mut pending = self.begin(frame)?;
        self.verify_loops(&mut pending);
        self.close_loop(&mut pending);
        Ok(self.finish(pending))
    }

    /// The cloud that [`Slam::step`] makes of a frame.
    ///
    /// # Errors
    /// Where the frame cannot be used.
    pub fn prepare(&mut self, frame: &Frame) -> Result<PreparedFrame, FrameError> {
        frame.validate()?;
        let dt_s = frame.stamp_s - self.last_stamp_s;
        let velocity = match frame.odometry {
            Some(odometry) if dt_s > 0.0 && dt_s.is_finite() => odometry.log() / dt_s,
            Some(_) => Vector3::zeros(),
            None => self.front_end.velocity(),
        };
        let cloud = self
            .preparer
            .prepare(&frame.scan, &velocity, &self.config.scan);
        Ok(PreparedFrame {
            stamp_s: frame.stamp_s,
            odometry: frame.odometry,
            cloud: Arc::new(cloud),
        })
    }

    /// First part of a frame: predict, register, and take a keyframe where one is due.
    ///
    /// The parts are for callers that look in between; [`Slam::step`] does all of them in order.
    ///
    /// # Errors
    /// Where the frame cannot be used; the estimator stays as it was.
    pub fn begin(&mut self, frame: &PreparedFrame) -> Result<PendingFrame, FrameError> {
        frame.validate()?;
        let dt_s = frame.stamp_s - self.last_stamp_s;
        if dt_s <= 0.0 {
            return Err(FrameError::Stamp {
                stamp_s: frame.stamp_s,
                last_s: self.last_stamp_s,
            });
        }
        if frame
            .odometry
            .is_some_and(|motion| !is_finite(&(self.front_end.estimate() * motion)))
        {
            return Err(FrameError::Odometry {
                stamp_s: frame.stamp_s,
            });
        }
        self.last_stamp_s = frame.stamp_s;
        self.frames += 1;
        let (registration, new_keyframe) = if self.keyframes.is_empty() {
            self.start(frame);
            (None, Some(0))
        } else {
            let registration = self
                .front_end
                .register(frame, dt_s, self.frames - 1, &self.config);
            (Some(registration), self.take_keyframe(frame))
        };
        Ok(PendingFrame {
            stamp_s: frame.stamp_s,
            registration,
            new_keyframe,
            loop_attempts: Vec::new(),
        })
    }

    /// Second part: looks for loops at a new keyframe and verifies the candidates in order, until
    /// one passes or the limit is reached.
    pub fn verify_loops(&mut self, pending: &mut PendingFrame) {
        let Some(node) = pending.new_keyframe else {
            return;
        };
        // The first keyframe has none before it, and does not count as an attempt.
        if self.config.loop_closure == LoopClosure::Off || node == 0 {
            return;
        }
        let loops = self.config.loops;
        if let Some(last) = self.last_attempt_node
            && node - last < loops.attempt_every_nodes
        {
            return;
        }
        self.last_attempt_node = Some(node);
        let mut query = LoopQuery::new(&mut self.graph, &self.keyframes);
        let mut candidates = self.detector.detect(&mut query);
        candidates.retain(|candidate| candidate.node < node);
        for candidate in candidates.into_iter().take(loops.candidates_tried) {
            let verification = self.verify(node, candidate);
            let is_last = verification.accepted();
            pending.loop_attempts.push(LoopAttempt {
                frame: self.frames - 1,
                verification,
                effect: None,
            });
            if is_last {
                return;
            }
        }
    }

    /// Third part: adds the edge of a loop that passed and spreads the correction; takes it back where
    /// the graph does not bear it.
    pub fn close_loop(&mut self, pending: &mut PendingFrame) {
        let Some(attempt) = pending.loop_attempts.last_mut() else {
            return;
        };
        if !attempt.verification.accepted() {
            return;
        }
        match self.optimize_with(&attempt.verification) {
            Ok(effect) => attempt.effect = Some(effect),
            Err(rejection) => attempt.verification.rejection = Some(rejection),
        }
    }

    /// Last part: the report.
    #[must_use]
    pub fn finish(&mut self, pending: PendingFrame) -> SlamReport {
        SlamReport {
            frame: self.frames - 1,
            stamp_s: pending.stamp_s,
            registration: pending.registration,
            estimate: self.front_end.estimate(),
            new_keyframe: pending.new_keyframe,
            loop_attempts: pending.loop_attempts,
            chi2: self.chi2,
        }
    }

    /// The parameters.
    #[must_use]
    pub fn config(&self) -> &SlamConfig {
        &self.config
    }

    /// Looks for loops from now on, or no longer.
    pub fn set_loop_closure(&mut self, loop_closure: LoopClosure) {
        self.config.loop_closure = loop_closure;
    }

    /// Frames taken.
    #[must_use]
    pub fn frames(&self) -> usize {
        self.frames
    }

    /// Local map, window, threshold and estimate.
    #[must_use]
    pub fn front_end(&self) -> &FrontEnd {
        &self.front_end
    }

    /// The pose graph; node k is keyframe k. It is empty before the first frame.
    #[must_use]
    pub fn graph(&self) -> &PoseGraph {
        &self.graph
    }

    /// The pose graph, to ask for covariances: they need the solver's memory.
    pub fn graph_mut(&mut self) -> &mut PoseGraph {
        &mut self.graph
    }

    /// The keyframes in order.
    #[must_use]
    pub fn keyframes(&self) -> &[Keyframe] {
        &self.keyframes
    }

    /// Submap and pairs of the last attempt to close a loop.
    #[must_use]
    pub fn loop_workspace(&self) -> &LoopWorkspace {
        &self.loop_workspace
    }

    /// χ² of the graph.
    #[must_use]
    pub fn chi2(&self) -> f64 {
        self.chi2
    }

    fn start(&mut self, frame: &PreparedFrame) {
        self.front_end.start(Arc::clone(&frame.cloud));
        self.graph.add_fixed_node(self.config.start);
        self.keyframes.push(Keyframe {
            node: 0,
            frame: 0,
            stamp_s: frame.stamp_s,
            scan: Arc::clone(&frame.cloud),
        });
    }

    /// Adds a node where the estimate is far enough from the last keyframe.
    fn take_keyframe(&mut self, frame: &PreparedFrame) -> Option<usize> {
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
            frame: self.frames - 1,
            stamp_s: frame.stamp_s,
            scan: Arc::clone(&frame.cloud),
        });
        self.chi2 = self.graph.chi2();
        Some(node.index())
    }

    fn verify(&mut self, node: usize, candidate: LoopCandidate) -> LoopVerification {
        let loops = &self.config.loops;
        let gate_information = match loops.gate_model {
            GateModel::PathApproximation => Ok(path_information(node - candidate.node, loops)),
            GateModel::ExactMarginal => marginal_information(&mut self.graph, candidate.node, node),
        };
        let view = KeyframeView {
            poses: self.graph.poses(),
            keyframes: &self.keyframes,
        };
        verify_loop(
            view,
            node,
            candidate,
            gate_information,
            self.config.information_frame,
            loops,
            &mut self.loop_workspace,
        )
    }

    fn optimize_with(
        &mut self,
        verification: &LoopVerification,
    ) -> Result<LoopEffect, LoopRejection> {
        let poses_before = self.graph.poses().to_vec();
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
        let cost_before = report
            .steps
            .first()
            .map_or(report.cost, |step| step.cost_before);
        let rejection = match report.stop {
            stop @ pr_optim::StopReason::Failed { .. } => {
                Some(LoopRejection::OptimizationFailed(stop))
            }
            _ if report.cost > cost_before || report.cost.is_nan() => {
                Some(LoopRejection::CostRose {
                    before: cost_before,
                    after: report.cost,
                })
            }
            _ => None,
        };
        if let Some(rejection) = rejection {
            self.graph.pop_edge();
            for (node, pose) in poses_before.iter().enumerate() {
                self.graph.set_pose(node, *pose);
            }
            return Err(rejection);
        }
        self.chi2 = self.graph.chi2();
        let newest = verification.from_node;
        let correction = self.graph.pose(newest) * poses_before[newest].inverse();
        self.front_end.correct(&correction);
        let max_shift_m = poses_before
            .iter()
            .zip(self.graph.poses())
            .map(|(old, new)| position_error_m(new, old))
            .fold(0.0, f64::max);
        Ok(LoopEffect {
            correction,
            max_shift_m,
            iterations: report.iterations,
            chi2: Change {
                before: chi2_before,
                after: self.chi2,
            },
            poses_before,
        })
    }
}
