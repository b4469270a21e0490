//! From a sweep to a cloud: clean, deskew, thin, estimate normals.

use std::sync::Arc;

use nalgebra::{Point2, Vector3};
use pr_geom::{Rotation, SE2, math};

use super::sweep::TimedPoints;
use super::{Frame, FrameError, LaserScan, PreparedFrame, ScanConfig, Sweep};
use crate::cloud::{Downsampler, NormalEstimator, PointCloud};

/// Makes clouds from scans; keeps its buffers and the beams' directions.
#[derive(Clone, Debug, Default)]
pub struct ScanPreparer {
    /// The scan whose directions are cached; its ranges are not.
    beams: Option<(f64, f64)>,
    directions: Vec<Rotation>,
    points: PointCloud,
    downsampler: Downsampler,
    normals: NormalEstimator,
}

impl ScanPreparer {
    /// A preparer without cached directions.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// A frame with its scan as a cloud, after one at `last_stamp_s`, s. The motion during the sweep is the scan's
    /// own velocity, else that of the odometry since the last scan, else that of `velocity` (m/s, m/s, rad/s) until it is
    /// registered.
    ///
    /// # Errors
    /// If the frame cannot be used.
    pub fn prepare_frame(
        &mut self,
        frame: &Frame,
        last_stamp_s: f64,
        velocity: Vector3<f64>,
        config: &ScanConfig,
    ) -> Result<PreparedFrame, FrameError> {
        frame.validate()?;
        let dt_s = frame.stamp_s - last_stamp_s;
        let velocity = match (frame.scan.velocity, frame.odometry) {
            (Some(measured), _) => measured,
            (None, Some(odometry)) if dt_s > 0.0 && dt_s.is_finite() => {
                odometry.log() / math::max(dt_s, frame.scan.sweep_s())
            }
            (None, Some(_)) => Vector3::zeros(),
            (None, None) => velocity,
        };
        let cloud = self.prepare(&frame.scan, &velocity, config);
        let is_measured = frame.scan.velocity.is_some() || frame.odometry.is_some();
        let is_skewed = frame.scan.beam_interval_s > 0.0 && !is_measured;
        let sweep = is_skewed.then(|| self.sweep(&frame.scan, &cloud, &velocity, config));
        Ok(PreparedFrame {
            stamp_s: frame.stamp_s,
            odometry: frame.odometry,
            cloud: Arc::new(cloud),
            sweep: sweep.map(Arc::new),
        })
    }

    /// The sweep of `scan`, whose cloud with `velocity` was the last to be prepared.
    fn sweep(
        &mut self,
        scan: &LaserScan,
        cloud: &PointCloud,
        velocity: &Vector3<f64>,
        config: &ScanConfig,
    ) -> Sweep {
        let ranges = scan.ranges_m.iter().enumerate();
        let seen = ranges.filter(|(_, range_m)| scan.is_return(**range_m));
        let times_s: Vec<f64> = seen
            .map(|(beam, _)| beam as f64 * scan.beam_interval_s)
            .collect();
        // The mean of the times makes a mean of points move with the velocity as they do.
        let means_s = self
            .downsampler
            .means(&self.points, config.cell_m, &times_s);
        self.project(scan, &Vector3::zeros());
        let returns = TimedPoints::new(self.points.iter().collect(), times_s);
        let thinned = TimedPoints::skewed(cloud, means_s, velocity);
        Sweep::new(returns, thinned, scan.sweep_s(), *config)
    }

    /// The returns of `scan` in the body's frame at the first beam, thinned, with normals from
    /// this sweep alone; a map of several sweeps rotates the normals with the points.
    ///
    /// `velocity` is the body's twist during the sweep (m/s, m/s, rad/s). The point p of a beam t seconds
    /// after the first one was seen from `exp(velocity · t)`, and is transformed accordingly.
    #[must_use]
    pub fn prepare(
        &mut self,
        scan: &LaserScan,
        velocity: &Vector3<f64>,
        config: &ScanConfig,
    ) -> PointCloud {
        self.project(scan, velocity);
        let mut cloud = PointCloud::default();
        self.downsampler
            .downsample_into(&self.points, config.cell_m, &mut cloud);
        self.normals.estimate(&mut cloud, config.normal_radius_m);
        cloud
    }

    /// All returns of `scan` in the body's frame at the first beam, in the order of the beams.
    #[must_use]
    pub fn points(&mut self, scan: &LaserScan, velocity: &Vector3<f64>) -> &PointCloud {
        self.project(scan, velocity);
        &self.points
    }

    fn project(&mut self, scan: &LaserScan, velocity: &Vector3<f64>) {
        self.point_beams(scan);
        let is_moved = scan.body_from_sensor != SE2::identity();
        let is_skewed = scan.beam_interval_s > 0.0 && *velocity != Vector3::zeros();
        self.points.clear();
        for (beam, (&range_m, direction)) in scan.ranges_m.iter().zip(&self.directions).enumerate()
        {
            if !scan.is_return(range_m) {
                continue;
            }
            let mut point = Point2::new(range_m * direction.cos, range_m * direction.sin);
            if is_moved {
                point = scan.body_from_sensor.transform(point);
            }
            if is_skewed {
                let time_s = beam as f64 * scan.beam_interval_s;
                point = SE2::exp(&(velocity * time_s)).transform(point);
            }
            self.points.push(point);
        }
    }

    fn point_beams(&mut self, scan: &LaserScan) {
        let beams = (scan.first_angle_rad, scan.angle_step_rad);
        if self.beams == Some(beams) && self.directions.len() == scan.ranges_m.len() {
            return;
        }
        self.beams = Some(beams);
        self.directions.clear();
        let bearings = (0..scan.ranges_m.len()).map(|beam| scan.bearing_rad(beam));
        self.directions.extend(bearings.map(Rotation::new));
    }
}

#[cfg(test)]
mod tests {
    use core::f64::consts::{FRAC_PI_2, PI};

    use super::*;

    fn cross(ranges_m: [f64; 4]) -> LaserScan {
        LaserScan {
            first_angle_rad: -PI,
            angle_step_rad: FRAC_PI_2,
            range_min_m: 0.5,
            range_max_m: 6.0,
            ranges_m: ranges_m.to_vec(),
            ..LaserScan::default()
        }
    }

    #[test]
    fn beams_without_a_return_give_no_point() {
        let mut preparer = ScanPreparer::new();
        let nothing = [0.0, f64::NAN, f64::INFINITY, 6.0];
        let still = Vector3::zeros();
        assert!(preparer.points(&cross(nothing), &still).is_empty());
        let near = [0.49, 0.5, -1.0, 5.99];
        let points = preparer.points(&cross(near), &still);
        let seen: Vec<_> = points.iter().collect();
        assert_eq!(seen.len(), 2);
        // 1e-12: the sine of a rounded quarter turn.
        assert!((seen[0] - Point2::new(0.0, -0.5)).norm() < 1e-12);
        assert!((seen[1] - Point2::new(0.0, 5.99)).norm() < 1e-12);
    }

    #[test]
    fn a_backward_sensor_puts_its_points_behind_the_body() {
        let mut scan = cross([0.0, 0.0, 2.0, 0.0]);
        scan.body_from_sensor = SE2::new(-0.3, 0.1, PI);
        let mut preparer = ScanPreparer::new();
        let point = preparer.points(&scan, &Vector3::zeros()).point(0);
        assert!((point - Point2::new(-2.3, 0.1)).norm() < 1e-12);
    }

    #[test]
    fn deskewing_straightens_a_wall_seen_in_motion() {
        // The body moves and turns; one beam after the other measures the wall x = 3.
        let velocity = Vector3::new(0.8, 0.0, 0.6);
        let (beams, interval_s) = (60_usize, 0.01);
        let (first, step) = (-0.5, 1.0 / 60.0);
        let ranges_m = (0..beams).map(|beam| {
            let body = SE2::exp(&(velocity * (beam as f64 * interval_s)));
            let heading = body.theta() + first + beam as f64 * step;
            (3.0 - body.x()) / Rotation::new(heading).cos
        });
        let mut scan = LaserScan {
            first_angle_rad: first,
            angle_step_rad: step,
            beam_interval_s: interval_s,
            ranges_m: ranges_m.collect(),
            ..LaserScan::default()
        };
        let mut preparer = ScanPreparer::new();
        let straight = preparer.points(&scan, &velocity);
        // 1e-12: a dozen roundings of numbers below 4.
        assert!(straight.xs().iter().all(|x| (x - 3.0).abs() < 1e-12));
        scan.beam_interval_s = 0.0;
        let bent = preparer.points(&scan, &velocity);
        assert!(bent.xs().iter().any(|x| (x - 3.0).abs() > 0.1));
    }
}
