//! The estimator: a front end that registers scans, a map of keyframes, and loop closures that correct it.
//!
//! For each frame, odometry predicts and registration on the last few sweeps corrects. Every few frames a keyframe
//! joins the pose graph, and after a loop closure the graph is optimized. [`Slam::step`] takes one [`Frame`] and
//! reports the result.
//!
//! There are three parts with separate state. The [`FrontEnd`] estimates the pose of a frame from the
//! last few scans only. The [`Mapper`] holds keyframes and pose graph. The [`LoopCloser`] proposes and
//! verifies loops; it reads the map and its covariances, and does not change it. [`Slam`] connects them:
//! an accepted loop corrects the map, and the correction moves the front end.
//!
//! [`SlamConfig::chapter`] and the default follow the chapter, with the configured matcher, detector and gate;
//! [`SlamConfig::for_robot`] is for recorded logs.
//!
//! Limitations: drift that no loop observes, such as the bend of an outbound path before the first
//! loop, and a location that looks like another one within the gate.

mod finder;
mod front_end;
mod join;
mod loop_closer;
mod map_pruning;
mod mapper;
mod pending;
mod registrar;
mod report;
mod restore;
mod snapshot;
mod strategies;
#[cfg(test)]
pub(crate) mod test_room;
mod uncertainty;
mod window;

use std::sync::Arc;

use nalgebra::{Matrix2, Matrix3};
use pr_geom::SE2;
use pr_optim::OptimizeError;

pub use finder::{CloneFinder, LoopFinder, TriedLoops};
pub use front_end::FrontEnd;
pub use join::PiecePose;
pub use loop_closer::LoopCloser;
pub use map_pruning::{MapPruning, MapPruningConfig};
pub use mapper::{Consistency, LoopOutlierTest, Mapper};
pub use pending::PendingFrame;
pub use registrar::{CloneRegistrar, ExpectedMotion, Registration, ScanRegistrar};
pub use report::{Change, Conclusion, LoopAttempt, LoopEffect, SlamReport};
pub use snapshot::{FrontEndSnapshot, NamedNumbers, SlamSnapshot, SnapshotError, is_within_limits};
pub use strategies::Strategies;
pub use window::{ScanWindow, WindowScan};

pub use crate::config::{LoopClosure, MotionNoise, SlamConfig};
pub use crate::graph::Keyframe;
use crate::graph::PoseGraph;
use crate::loops::{LoopVerification, LoopWorkspace};
use crate::metrics::position_error_m;
use crate::scan::{Frame, FrameError, PreparedFrame, ScanPreparer};

/// The SLAM system, one frame at a time.
#[derive(Clone)]
pub struct Slam {
    config: SlamConfig,
    preparer: ScanPreparer,
    frames: usize,
    last_stamp_s: f64,
    front_end: FrontEnd,
    mapper: Mapper,
    loop_closer: LoopCloser,
}

impl Slam {
    /// An estimator with custom strategies.
    #[must_use]
    pub fn with(config: SlamConfig, strategies: Strategies) -> Self {
        Self {
            front_end: FrontEnd::new(&config, strategies.registrar),
            mapper: Mapper::new(&config, strategies.outlier_test),
            loop_closer: LoopCloser::new(strategies.finder),
            preparer: ScanPreparer::new(),
            frames: 0,
            last_stamp_s: f64::NEG_INFINITY,
            config,
        }
    }

    /// Takes one frame: prepares its scan, registers it, and closes loops.
    ///
    /// # Errors
    /// If the frame cannot be used; the estimator is unchanged.
    pub fn step(&mut self, frame: &Frame) -> Result<SlamReport, FrameError> {
        let prepared = self.prepare(frame)?;
        self.step_prepared(&prepared)
    }

    /// [`Slam::step`] with a prepared scan.
    ///
    /// # Errors
    /// If the frame cannot be used; the estimator is unchanged.
    pub fn step_prepared(&mut self, frame: &PreparedFrame) -> Result<SlamReport, FrameError> {
        let mut pending = self.begin(frame)?;
        self.verify_loops(&mut pending);
        self.close_loop(&mut pending);
        Ok(self.finish(pending))
    }

    /// The cloud that [`Slam::step`] makes of a frame.
    ///
    /// # Errors
    /// If the frame cannot be used.
    pub fn prepare(&mut self, frame: &Frame) -> Result<PreparedFrame, FrameError> {
        let velocity = self.front_end.velocity();
        self.preparer
            .prepare_frame(frame, self.last_stamp_s, velocity, &self.config.scan)
    }

    /// First part of a frame: predicts, registers, and takes a keyframe if one is due.
    ///
    /// The parts are for callers that need the intermediate states; [`Slam::step`] runs all of them in order.
    ///
    /// # Errors
    /// If the frame cannot be used; the estimator is unchanged.
    pub fn begin(&mut self, frame: &PreparedFrame) -> Result<PendingFrame, FrameError> {
        let dt_s = frame.seconds_after(self.last_stamp_s, &self.front_end.estimate())?;
        self.last_stamp_s = frame.stamp_s;
        self.frames += 1;
        let (registration, new_keyframe) = if self.mapper.newest().is_none() {
            self.front_end.start(0, Arc::clone(&frame.cloud));
            self.mapper.start(self.config.start, frame);
            (None, Some(0))
        } else {
            let mut frame = frame.clone();
            let registration =
                self.front_end
                    .register(&mut frame, dt_s, self.frames - 1, &self.config);
            (Some(registration), self.take_keyframe(&frame))
        };
        Ok(PendingFrame::new(frame.stamp_s, registration, new_keyframe))
    }

    /// Second part: searches for loops at a new keyframe.
    pub fn verify_loops(&mut self, pending: &mut PendingFrame) {
        if pending.new_keyframe().is_some() {
            let tried = self.loop_closer.find(&mut self.mapper, &self.config);
            pending.add(self.frames - 1, tried);
        }
    }

    /// Third part: adds the edges of the accepted loops and optimizes; reverts them if the graph cannot be
    /// optimized with them.
    pub fn close_loop(&mut self, pending: &mut PendingFrame) {
        let accepted = pending.accepted();
        if accepted.is_empty() {
            return;
        }
        let closed = self.mapper.close(&accepted, pending.consistency());
        if let Some(effect) = &closed.effect {
            self.front_end.correct(&effect.correction);
        }
        pending.closed(closed);
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
            chi2: self.mapper.chi2(),
        }
    }

    /// Ends the run: closes pending loops, searches for loops at the last keyframe, and links all keyframes again
    /// with the visits around them.
    pub fn conclude(&mut self) -> Conclusion {
        let mut pending = PendingFrame::new(self.last_stamp_s, None, None);
        let tried = self.loop_closer.conclude(&mut self.mapper, &self.config);
        pending.add(self.frames.saturating_sub(1), tried);
        self.close_loop(&mut pending);
        let optimized = self.mapper.optimize_pending();
        if let Ok(correction) = &optimized {
            self.front_end.correct(correction);
        }
        let links = match self.config.loop_closure {
            LoopClosure::On => self.loop_closer.finder.link_all(&mut self.mapper),
            LoopClosure::Off => Vec::new(),
        };
        Conclusion {
            tried: pending.loop_attempts,
            links,
            // The links replace the loops, and may be solvable without them.
            unsolved: optimized.err().filter(|_| self.mapper.has_pending()),
        }
    }

    /// Removes points of objects that are gone and keyframes that were replaced around the newest keyframe; to be
    /// called after a frame that became one.
    pub fn prune_map(&mut self, config: &MapPruningConfig) -> MapPruning {
        let radius_m = self.config.scan.normal_radius_m;
        map_pruning::prune_map(&mut self.mapper, &mut self.loop_closer, config, radius_m)
    }

    /// The parameters.
    #[must_use]
    pub fn config(&self) -> &SlamConfig {
        &self.config
    }

    /// Switches loop closure on or off from now on.
    pub fn set_loop_closure(&mut self, loop_closure: LoopClosure) {
        self.config.loop_closure = loop_closure;
    }

    /// Number of frames.
    #[must_use]
    pub fn frames(&self) -> usize {
        self.frames
    }

    /// Window, local map and estimate.
    #[must_use]
    pub fn front_end(&self) -> &FrontEnd {
        &self.front_end
    }

    /// The pose graph; node k is keyframe k. It is empty before the first frame.
    #[must_use]
    pub fn graph(&self) -> &PoseGraph {
        self.mapper.graph()
    }

    /// The pose graph, mutable for covariance queries, which need the solver's memory.
    pub fn graph_mut(&mut self) -> &mut PoseGraph {
        self.mapper.graph_mut()
    }

    /// The keyframes in order.
    #[must_use]
    pub fn keyframes(&self) -> &[Keyframe] {
        self.mapper.keyframes()
    }

    /// The loop closer, with its pending loops.
    #[must_use]
    pub fn loop_closer(&self) -> &LoopCloser {
        &self.loop_closer
    }

    /// Submap and pairs of the last attempt to close a loop, if the finder keeps them.
    #[must_use]
    pub fn loop_workspace(&self) -> Option<&LoopWorkspace> {
        self.loop_closer.finder.workspace()
    }

    /// χ² of the graph.
    #[must_use]
    pub fn chi2(&self) -> f64 {
        self.mapper.chi2()
    }

    /// Covariance of every keyframe relative to the first one: see [`Mapper::keyframe_covariances`].
    ///
    /// # Errors
    /// If the normal equations are not positive definite.
    pub fn keyframe_covariances(&mut self) -> Result<Vec<Matrix3<f64>>, OptimizeError> {
        self.mapper.keyframe_covariances()
    }

    /// Covariance of every keyframe's position error after an alignment of the trajectory to the true one, body frame,
    /// m²: see [`PoseGraph::aligned_covariances`].
    ///
    /// # Errors
    /// If the normal equations are not positive definite.
    pub fn aligned_covariances(&mut self) -> Result<Vec<Matrix2<f64>>, OptimizeError> {
        self.mapper.aligned_covariances()
    }

    /// Covariance of keyframe `to` in the frame of `from`, scaled as those of [`Slam::keyframe_covariances`].
    ///
    /// # Errors
    /// If the normal equations are not positive definite.
    pub fn relative_covariance(
        &mut self,
        from: usize,
        to: usize,
    ) -> Result<Matrix3<f64>, OptimizeError> {
        self.mapper.relative_covariance(from, to)
    }

    /// Ratio of actual to stated variance of the graph's measurements.
    #[must_use]
    pub fn variance_factor(&self) -> f64 {
        uncertainty::variance_factor(self.mapper.graph())
    }

    /// Registers keyframe `new` on the surroundings of keyframe `old` and tests the result; the graph is
    /// unchanged.
    ///
    /// # Errors
    /// If the graph has no covariance for the test.
    ///
    /// # Panics
    /// If a keyframe does not exist, or `new` is not after `old`.
    pub fn register_loop(
        &mut self,
        old: usize,
        new: usize,
    ) -> Result<LoopVerification, OptimizeError> {
        self.loop_closer.finder.verify(&mut self.mapper, old, new)
    }

    /// Adds a keyframe if the estimate is far enough from the last one.
    fn take_keyframe(&mut self, frame: &PreparedFrame) -> Option<usize> {
        let last_pose = *self.mapper.poses().last()?;
        let estimate = self.front_end.estimate();
        let relative = last_pose.between(&estimate);
        let distance = position_error_m(&relative, &SE2::identity());
        if distance < self.config.keyframe_distance_m
            && relative.theta().abs() < self.config.keyframe_turn_rad
        {
            return None;
        }
        let information = self.front_end.information(last_pose.theta());
        let number = self.frames - 1;
        Some(
            self.mapper
                .add_keyframe(estimate, information, number, frame),
        )
    }
}
