//! The sweeps of the last metres, aligned by the front end alone.

use std::sync::Arc;

use pr_geom::SE2;

use super::LocalizeConfig;
use crate::cloud::PointCloud;
use crate::metrics::position_error_m;
use crate::scan::PreparedFrame;
use crate::slam::{FrontEnd, SlamConfig, Strategies};

/// A sweep with a lower score on the previous ones starts a new trail, 0 to 1.
const MIN_TRAIL_SCORE: f64 = 0.3;

/// Result of adding a sweep to the trail.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrailStep {
    /// Motion since the last frame by scans and odometry; `None` if the trail was interrupted.
    pub motion: Option<SE2>,
    /// Whether the sweep joined the trail.
    pub joined: bool,
}

/// A front end without a map, and some of its sweeps.
#[derive(Clone)]
pub struct Trail {
    config: SlamConfig,
    front_end: FrontEnd,
    frames: usize,
    sweeps: Vec<(SE2, Arc<PointCloud>)>,
}

impl Trail {
    pub fn new(config: SlamConfig) -> Self {
        Self {
            front_end: FrontEnd::new(&config, Strategies::from_config(&config).registrar),
            config,
            frames: 0,
            sweeps: Vec::new(),
        }
    }

    pub fn velocity(&self) -> nalgebra::Vector3<f64> {
        self.front_end.velocity()
    }

    /// Takes a frame `dt_s` seconds after the last one, and deskews it with the velocity found.
    pub fn step(
        &mut self,
        frame: &mut PreparedFrame,
        dt_s: f64,
        config: &LocalizeConfig,
    ) -> TrailStep {
        if self.frames == 0 {
            self.begin(frame);
            return TrailStep {
                motion: None,
                joined: true,
            };
        }
        let before = self.front_end.estimate();
        let number = self.frames;
        self.frames += 1;
        let found = self.front_end.register(frame, dt_s, number, &self.config);
        let is_interrupted = found
            .matched
            .score
            .is_some_and(|score| score < MIN_TRAIL_SCORE);
        if is_interrupted || !found.accepted {
            *self = Self::new(self.config.clone());
            self.begin(frame);
            return TrailStep {
                motion: None,
                joined: true,
            };
        }
        let here = self.front_end.estimate();
        let joined = self.sweeps.last().is_none_or(|(last, _)| {
            position_error_m(last, &here) >= config.trail_step_m
                || last.between(&here).theta().abs() >= config.trail_turn_rad
        });
        if joined {
            self.sweeps.push((here, Arc::clone(&frame.cloud)));
            let surplus = self.sweeps.len().saturating_sub(config.trail_sweeps);
            self.sweeps.drain(..surplus);
        }
        TrailStep {
            motion: Some(before.between(&here)),
            joined,
        }
    }

    /// All sweeps in the present body frame, including the newest scan, without points beyond `reach_m`, thinned to
    /// cells of `cell_m`.
    pub fn cloud(&self, newest: &PointCloud, reach_m: f64, cell_m: f64) -> PointCloud {
        thinned(&self.sweeps_of(newest, |_| true), reach_m, cell_m)
    }

    /// The newest scan and those sweeps that are chosen by their `body_from_sweep`, in the present body frame.
    pub fn sweeps_of(&self, newest: &PointCloud, is_chosen: impl Fn(&SE2) -> bool) -> PointCloud {
        let body_from_start = self.front_end.estimate().inverse();
        let mut all = newest.clone();
        for (pose, scan) in &self.sweeps {
            let body_from_sweep = body_from_start * *pose;
            if is_chosen(&body_from_sweep) {
                all.extend_transformed(scan, &body_from_sweep);
            }
        }
        all
    }

    /// Drops all sweeps before this frame's; the motion estimate continues.
    pub fn restart(&mut self, frame: &PreparedFrame, number: usize) {
        self.front_end.start(number, Arc::clone(&frame.cloud));
        self.sweeps = vec![(self.front_end.estimate(), Arc::clone(&frame.cloud))];
    }

    fn begin(&mut self, frame: &PreparedFrame) {
        self.restart(frame, 0);
        self.frames = 1;
    }
}

/// Points within `reach_m` of the origin, at most one in each cell of `cell_m`.
pub fn thinned(points: &PointCloud, reach_m: f64, cell_m: f64) -> PointCloud {
    let reach_m2 = reach_m * reach_m;
    let near = points
        .iter()
        .filter(|point| point.coords.norm_squared() <= reach_m2);
    let near: PointCloud = near.collect();
    near.downsample(cell_m)
}
