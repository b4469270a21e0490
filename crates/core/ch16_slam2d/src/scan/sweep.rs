//! A scan whose beams differ in time, as a function of the motion during its sweep.

use nalgebra::{Point2, Vector3};
use pr_geom::{SE2, math};

use super::ScanConfig;
use crate::cloud::{NormalEstimator, PointCloud};

/// Registrations of a sweep after its first one: an error decreases to a sixteenth or less.
const STEPS: usize = 4;

/// The points of a scan before deskewing, each with the time of its beam.
#[derive(Clone, Debug, PartialEq)]
pub struct Sweep {
    returns: TimedPoints,
    /// The means of `returns` in the cells of their first cloud.
    thinned: TimedPoints,
    duration_s: f64,
    config: ScanConfig,
}

/// Points in the body's frame at their own times, s after the first beam.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct TimedPoints {
    points: Vec<Point2<f64>>,
    times_s: Vec<f64>,
}

impl TimedPoints {
    pub fn new(points: Vec<Point2<f64>>, times_s: Vec<f64>) -> Self {
        Self { points, times_s }
    }

    /// The points of which `cloud` was deskewed with `velocity`.
    pub fn skewed(cloud: &PointCloud, times_s: Vec<f64>, velocity: &Vector3<f64>) -> Self {
        let timed = cloud.iter().zip(&times_s);
        let points = timed
            .map(|(point, time_s)| SE2::exp(&(velocity * *time_s)).inverse().transform(point))
            .collect();
        Self { points, times_s }
    }

    fn deskewed(&self, velocity: &Vector3<f64>) -> PointCloud {
        let timed = self.points.iter().zip(&self.times_s);
        timed
            .map(|(&point, &time_s)| SE2::exp(&(velocity * time_s)).transform(point))
            .collect()
    }
}

impl Sweep {
    pub(super) fn new(
        returns: TimedPoints,
        thinned: TimedPoints,
        duration_s: f64,
        config: ScanConfig,
    ) -> Self {
        Self {
            returns,
            thinned,
            duration_s,
            config,
        }
    }

    /// The cloud with this velocity of the body (m/s, m/s, rad/s), as [`ScanPreparer`](super::ScanPreparer) makes it.
    #[must_use]
    pub fn cloud(&self, velocity: &Vector3<f64>) -> PointCloud {
        let mut cloud = self
            .returns
            .deskewed(velocity)
            .downsample(self.config.cell_m);
        NormalEstimator::default().estimate(&mut cloud, self.config.normal_radius_m);
        cloud
    }
}

/// A sweep during which the body moves as it did since the last scan, so that its points depend on its pose.
#[derive(Clone, Copy, Debug)]
pub struct MovingSweep<'a> {
    /// The sweep.
    pub sweep: &'a Sweep,
    before: SE2,
    interval_s: f64,
}

impl<'a> MovingSweep<'a> {
    /// The sweep that begins `dt_s` after the body was at `before`.
    ///
    /// The stamps of a sensor with sweeps that fill its period are never closer than a sweep: closer ones are
    /// jitter of its driver.
    #[must_use]
    pub fn new(sweep: &'a Sweep, before: SE2, dt_s: f64) -> Self {
        Self {
            sweep,
            before,
            interval_s: math::max(dt_s, sweep.duration_s),
        }
    }

    /// Registers the sweep again with a method that solves for the pose alone, after the result `found` with
    /// `velocity`.
    ///
    /// Each time the sweep is deskewed halfway to the velocity found: an error e becomes e (1 − g)/2, where g is the
    /// effect of the velocity's error on the pose, at most the sweep's share of the period. It decreases for every
    /// share.
    pub fn register<T>(
        &self,
        velocity: &Vector3<f64>,
        mut found: T,
        pose: impl Fn(&T) -> SE2,
        mut register: impl FnMut(&PointCloud) -> T,
    ) -> T {
        let mut velocity = *velocity;
        for _ in 0..STEPS {
            velocity = (velocity + self.velocity(&pose(&found))) / 2.0;
            found = register(&self.sweep.cloud(&velocity));
        }
        found
    }

    /// The velocity if the sweep begins at `pose`.
    #[must_use]
    pub fn velocity(&self, pose: &SE2) -> Vector3<f64> {
        self.before.between(pose).log() / self.interval_s
    }

    /// The thinned points in the body's frame at `pose`, where the sweep begins.
    #[must_use]
    pub fn points(&self, pose: &SE2) -> PointCloud {
        self.sweep.thinned.deskewed(&self.velocity(pose))
    }

    /// Motion of thinned point `index` per motion of the pose: 1, and the share of the interval up to its beam.
    #[must_use]
    pub fn gain(&self, index: usize) -> f64 {
        1.0 + self.sweep.thinned.times_s[index] / self.interval_s
    }
}
