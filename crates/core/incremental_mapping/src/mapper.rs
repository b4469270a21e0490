//! The incremental mapper, one frame at a time.

use std::sync::Arc;

use nalgebra::Vector3;
use pr_geom::SE2;

use super::{
    CycleTest, CycleVerdict, CycleWatch, IncrementalConfig, IncrementalReport, LikelihoodMap,
};
use crate::field::{Climb, PosePrior, ScanClimb};
use ch16_slam2d::cloud::PointCloud;
use ch16_slam2d::metrics::position_error_m;
use ch16_slam2d::scan::{Frame, FrameError, MovingSweep, PreparedFrame, ScanPreparer, is_finite};
use ch16_slam2d::slam::Keyframe;

/// Incremental maximum likelihood mapping over the frames of [`Slam`](ch16_slam2d::slam::Slam).
#[derive(Clone)]
pub struct IncrementalMapper {
    config: IncrementalConfig,
    preparer: ScanPreparer,
    frames: usize,
    last_stamp_s: f64,
    last_dt_s: f64,
    estimate: SE2,
    velocity: Vector3<f64>,
    map: LikelihoodMap,
    keyframes: Vec<Keyframe>,
    poses: Vec<SE2>,
    cycles: Option<CycleWatch>,
}

impl IncrementalMapper {
    /// A mapper without frames.
    #[must_use]
    pub fn new(config: IncrementalConfig) -> Self {
        Self {
            preparer: ScanPreparer::new(),
            frames: 0,
            last_stamp_s: f64::NEG_INFINITY,
            last_dt_s: f64::INFINITY,
            estimate: config.start,
            velocity: Vector3::zeros(),
            map: LikelihoodMap::new(config.map),
            keyframes: Vec::new(),
            poses: Vec::new(),
            cycles: config
                .cycles
                .map(|cycles| CycleWatch::new(cycles, config.start)),
            config,
        }
    }

    /// Takes one frame: prepares its scan, climbs, and adds it to the map if a keyframe is due.
    ///
    /// # Errors
    /// If the frame cannot be used; the mapper is unchanged.
    pub fn step(&mut self, frame: &Frame) -> Result<IncrementalReport, FrameError> {
        let prepared = self.preparer.prepare_frame(
            frame,
            self.last_stamp_s,
            self.velocity,
            &self.config.scan,
        )?;
        self.step_prepared(&prepared)
    }

    /// [`IncrementalMapper::step`] with a prepared scan.
    ///
    /// # Errors
    /// If the frame cannot be used; the mapper is unchanged.
    pub fn step_prepared(
        &mut self,
        frame: &PreparedFrame,
    ) -> Result<IncrementalReport, FrameError> {
        let dt_s = frame.seconds_after(self.last_stamp_s, &self.estimate)?;
        self.last_stamp_s = frame.stamp_s;
        self.frames += 1;
        let mut report = IncrementalReport {
            frame: self.frames - 1,
            stamp_s: frame.stamp_s,
            prediction: self.estimate,
            climb: None,
            estimate: self.estimate,
            new_keyframe: None,
            cycle: None,
        };
        if self.poses.is_empty() {
            self.take_keyframe(frame);
            report.new_keyframe = Some(0);
            return Ok(report);
        }
        let mut frame = frame.clone();
        let (prediction, climb) = self.climb(&mut frame, dt_s);
        report.prediction = prediction;
        report.climb = Some(climb);
        if self.is_keyframe_due() {
            self.take_keyframe(&frame);
            report.new_keyframe = Some(self.poses.len() - 1);
            report.cycle = self.test_cycle();
        }
        report.estimate = self.estimate;
        Ok(report)
    }

    /// The parameters.
    #[must_use]
    pub fn config(&self) -> &IncrementalConfig {
        &self.config
    }

    /// The estimated pose, `world_from_body`.
    #[must_use]
    pub fn estimate(&self) -> SE2 {
        self.estimate
    }

    /// The keyframes in order.
    #[must_use]
    pub fn keyframes(&self) -> &[Keyframe] {
        &self.keyframes
    }

    /// Their present poses, `world_from_body`.
    #[must_use]
    pub fn poses(&self) -> &[SE2] {
        &self.poses
    }

    /// The map.
    #[must_use]
    pub fn map(&self) -> &LikelihoodMap {
        &self.map
    }

    /// The detection of cycles; `None` without cycle closing.
    #[must_use]
    pub fn cycles(&self) -> Option<&CycleWatch> {
        self.cycles.as_ref()
    }

    /// Climbs from the motion prediction; returns prediction and result. A scan whose beams differ in time is deskewed
    /// with the velocity found.
    fn climb(&mut self, frame: &mut PreparedFrame, dt_s: f64) -> (SE2, Climb) {
        let config = &self.config;
        let before = self.estimate;
        let extrapolated_s = dt_s.min(config.extrapolation * self.last_dt_s);
        let motion = frame
            .odometry
            .unwrap_or_else(|| SE2::exp(&(self.velocity * extrapolated_s)));
        // A velocity from nearly equal stamps may be arbitrary: then it is ignored.
        let motion = if is_finite(&(before * motion)) {
            motion
        } else {
            SE2::identity()
        };
        let noise = match frame.odometry {
            Some(_) => &config.odometry_noise,
            None => &config.prediction_noise,
        };
        let prediction = before * motion;
        // Every motion noise has a floor, so only an overflow has no inverse.
        let information = noise.covariance(&motion).try_inverse().unwrap_or_default();
        let prior = PosePrior {
            pose: prediction,
            information,
        };
        let field = self.map.field(config.map.sigma_m);
        let run = |cloud: &PointCloud| {
            ScanClimb::new(&field, cloud, prediction, Some(prior), config.climb).run()
        };
        let mut climb = run(&frame.cloud);
        if let Some(sweep) = frame.sweep.clone() {
            let sweep = MovingSweep::new(&sweep, before, dt_s);
            climb = sweep.register(&self.velocity, climb, |climb| climb.pose, run);
            self.velocity = sweep.velocity(&climb.pose);
            frame.cloud = Arc::new(sweep.sweep.cloud(&self.velocity));
        } else {
            self.velocity = before.between(&climb.pose).log() / dt_s;
        }
        self.estimate = climb.pose;
        self.last_dt_s = dt_s;
        (prediction, climb)
    }

    fn is_keyframe_due(&self) -> bool {
        let last = self.poses[self.poses.len() - 1];
        position_error_m(&last, &self.estimate) >= self.config.keyframe_distance_m
            || last.between(&self.estimate).theta().abs() >= self.config.keyframe_turn_rad
    }

    fn take_keyframe(&mut self, frame: &PreparedFrame) {
        self.keyframes.push(Keyframe {
            node: self.poses.len(),
            frame: self.frames - 1,
            stamp_s: frame.stamp_s,
            scan: Arc::clone(&frame.cloud),
        });
        self.poses.push(self.estimate);
        self.map.insert(&frame.cloud, &self.estimate);
    }

    /// Tests for a cycle, and rebuilds the map if the path was corrected.
    fn test_cycle(&mut self) -> Option<CycleTest> {
        let watch = self.cycles.as_mut()?;
        let test = watch.test(&mut self.poses, &self.keyframes, &self.config);
        if let CycleVerdict::Closed(_) = test.verdict {
            self.estimate = self.poses[self.poses.len() - 1];
            self.map.clear();
            for (keyframe, pose) in self.keyframes.iter().zip(&self.poses) {
                self.map.insert(&keyframe.scan, pose);
            }
        }
        Some(test)
    }
}
