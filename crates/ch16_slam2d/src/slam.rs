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
mod fusion;
mod guarding;
mod loop_closing;
mod motion;
pub mod parameters;
mod parts;
mod pending;
mod refinement;
mod report;
mod robots;
mod scales;
mod snapshot;
mod submap_loops;
#[cfg(test)]
pub(crate) mod test_room;
mod uncertainty;
mod upkeep;
mod wide_search;

use std::sync::Arc;

use pr_geom::SE2;

pub(crate) use fusion::fuse;

pub use config::{ContradictionConfig, LoopClosure, PredictionUse, SlamConfig, ThresholdConfig};
pub use front_end::{FrontEnd, Registration, WindowSweep};
pub use motion::MotionNoise;
pub use parts::SlamParts;
pub use pending::PendingFrame;
pub use refinement::{Refinement, RefinementConfig};
pub use report::{Change, Keyframe, LoopAttempt, LoopEffect, SlamReport};
pub use snapshot::{FrontEndSnapshot, SlamSnapshot, SnapshotError};
pub use upkeep::{Upkeep, UpkeepConfig};

use crate::graph::{EdgeKind, PoseGraph};
use crate::loops::{HeldLoop, LoopDetector, LoopWorkspace};
use crate::metrics::position_error_m;
use crate::scan::{Frame, FrameError, PreparedFrame, ScanPreparer};
use crate::submaps::{FrontEndKind, SubmapLoops};

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
    /// The newest node at which a loop was closed; the first before any was.
    last_loop_node: usize,
    /// The newest node at which the window of the drift was searched.
    last_search_node: Option<usize>,
    /// Loops that wait for others, in order.
    held: Vec<HeldLoop>,
    detector: Box<dyn LoopDetector>,
    loop_workspace: LoopWorkspace,
    /// The finished submaps, where the front end makes some.
    submap_loops: Option<SubmapLoops>,
    chi2: f64,
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
            submap_loops: match config.front_end {
                FrontEndKind::Window => None,
                FrontEndKind::Submaps(submaps) => Some(SubmapLoops::new(submaps)),
            },
            detector: parts.detector,
            graph: PoseGraph::with_jacobians(config.jacobians),
            keyframes: Vec::new(),
            preparer: ScanPreparer::new(),
            frames: 0,
            last_stamp_s: f64::NEG_INFINITY,
            last_attempt_node: None,
            last_loop_node: 0,
            last_search_node: None,
            held: Vec::new(),
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
        let velocity = self.front_end.velocity();
        self.preparer
            .prepare_frame(frame, self.last_stamp_s, velocity, &self.config.scan)
    }

    /// First part of a frame: predict, register, and take a keyframe where one is due.
    ///
    /// The parts are for callers that look in between; [`Slam::step`] does all of them in order.
    ///
    /// # Errors
    /// Where the frame cannot be used; the estimator stays as it was.
    pub fn begin(&mut self, frame: &PreparedFrame) -> Result<PendingFrame, FrameError> {
        let dt_s = frame.seconds_after(self.last_stamp_s, &self.front_end.estimate())?;
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
        self.keep_finished();
        Ok(PendingFrame {
            stamp_s: frame.stamp_s,
            registration,
            new_keyframe,
            loop_attempts: Vec::new(),
        })
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

    /// The finished submaps; none where the front end makes no submaps.
    #[must_use]
    pub fn submap_loops(&self) -> Option<&SubmapLoops> {
        self.submap_loops.as_ref()
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
        let is_registered = self.front_end.is_registered();
        let node = self.graph.add_node(estimate).index();
        let ties = self.front_end.tie(node, &frame.cloud);
        if ties.is_empty() || !is_registered {
            let information = self.front_end.information(last_pose.theta(), &self.config);
            let information = information * self.config.confidence;
            self.graph
                .add_edge(last_node, node, relative, information, EdgeKind::Odometry);
        } else {
            self.tie_to_submaps(last_node, node, relative, &ties);
        }
        self.keyframes.push(Keyframe {
            node,
            frame: self.frames - 1,
            stamp_s: frame.stamp_s,
            scan: Arc::clone(&frame.cloud),
        });
        self.chi2 = self.graph.chi2();
        Some(node)
    }
}
