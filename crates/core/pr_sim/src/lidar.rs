//! A planar LiDAR: true ranges by ray casting, Gaussian range noise, and the projection of a scan
//! to points.

use core::f64::consts::{PI, TAU};

use pr_geom::{Point2, Rng, Rotation, SE2};

use crate::world::{Viewpoint, World};

/// A reading at or beyond this share of the maximum range is not a return.
const RETURN_SHARE: f64 = 0.995;

/// A field of view this close to 2π is a full circle, whose last beam must not repeat the first.
const FULL_CIRCLE_TOLERANCE: f64 = 1e-9;

/// The sensor's parameters; the default is that of the chapter's lap.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LidarConfig {
    /// Number of beams.
    pub beams: usize,
    /// Field of view in radians; 2π is the full circle.
    pub field_of_view_rad: f64,
    /// Longest range in metres.
    pub max_range_m: f64,
    /// Standard deviation of the range noise in metres.
    pub range_sigma_m: f64,
    /// Whether readings at the maximum range count as returns: a common mistake. Each of them becomes a point where
    /// nothing is, and these points move with the robot.
    pub keeps_misses: bool,
}

impl Default for LidarConfig {
    fn default() -> Self {
        Self {
            beams: 120,
            field_of_view_rad: TAU,
            max_range_m: 6.0,
            range_sigma_m: 0.05,
            keeps_misses: false,
        }
    }
}

impl LidarConfig {
    /// Bearing of the first beam relative to the heading, rad.
    #[must_use]
    pub fn first_angle_rad(&self) -> f64 {
        match self.beams {
            _ if self.is_full_circle() => -PI,
            0 | 1 => 0.0,
            _ => -self.field_of_view_rad / 2.0,
        }
    }

    /// Angle between consecutive beams, rad.
    #[must_use]
    pub fn angle_step_rad(&self) -> f64 {
        let n = self.beams as f64;
        match self.beams {
            _ if self.is_full_circle() => TAU / n,
            0 | 1 => self.field_of_view_rad,
            _ => self.field_of_view_rad / (n - 1.0),
        }
    }

    /// Readings at or beyond this range are not returns, m.
    #[must_use]
    pub fn return_limit_m(&self) -> f64 {
        if self.keeps_misses {
            f64::INFINITY
        } else {
            RETURN_SHARE * self.max_range_m
        }
    }

    fn is_full_circle(&self) -> bool {
        self.field_of_view_rad > TAU - FULL_CIRCLE_TOLERANCE
    }
}

/// A LiDAR with precomputed bearings and reused buffers.
#[derive(Clone, Debug)]
pub struct Lidar {
    config: LidarConfig,
    bearings_rad: Vec<f64>,
    directions: Vec<Rotation>,
    viewpoint: Viewpoint,
}

impl Lidar {
    /// Creates a sensor with these parameters.
    #[must_use]
    pub fn new(config: LidarConfig) -> Self {
        // A step times a number, in this order: the beams abeam hit an edge of the voxel grid, and the
        // last bit of their bearing decides the voxel.
        let (first, step) = (config.first_angle_rad(), config.angle_step_rad());
        let bearings_rad: Vec<f64> = (0..config.beams).map(|k| first + k as f64 * step).collect();
        let directions = bearings_rad.iter().map(|&b| Rotation::new(b)).collect();
        Self {
            config,
            bearings_rad,
            directions,
            viewpoint: Viewpoint::default(),
        }
    }

    /// The parameters.
    #[must_use]
    pub fn config(&self) -> &LidarConfig {
        &self.config
    }

    /// Bearing of every beam relative to the heading, in radians.
    #[must_use]
    pub fn bearings_rad(&self) -> &[f64] {
        &self.bearings_rad
    }

    /// Writes the noise-free ranges from `world_from_sensor` to `ranges_m`, one per beam, in metres.
    pub fn measure_into(
        &mut self,
        world: &World,
        world_from_sensor: &SE2,
        ranges_m: &mut Vec<f64>,
    ) {
        let Self {
            config,
            bearings_rad,
            viewpoint,
            ..
        } = self;
        let heading_rad = world_from_sensor.theta();
        viewpoint.stand_at(world, world_from_sensor.position(), config.max_range_m);
        ranges_m.clear();
        ranges_m.extend(
            bearings_rad
                .iter()
                .map(|bearing| viewpoint.cast(heading_rad + bearing)),
        );
    }

    /// Writes one noisy scan from `world_from_sensor` to `ranges_m`: ranges in metres, one per beam.
    ///
    /// Each beam consumes three draws: one for a dropout or a random return (Chapter 9; both have
    /// probability 0 here) and two for the normal noise.
    pub fn sense_into(
        &mut self,
        world: &World,
        world_from_sensor: &SE2,
        rng: &mut Rng,
        ranges_m: &mut Vec<f64>,
    ) {
        self.measure_into(world, world_from_sensor, ranges_m);
        for range in ranges_m.iter_mut() {
            let _dropout_decision = rng.unit();
            *range = (*range + rng.normal(0.0, self.config.range_sigma_m))
                .clamp(0.0, self.config.max_range_m);
        }
    }

    /// Does the same as [`Lidar::sense_into`] and returns a new buffer.
    #[must_use]
    pub fn sense(&mut self, world: &World, world_from_sensor: &SE2, rng: &mut Rng) -> Vec<f64> {
        let mut ranges_m = Vec::with_capacity(self.config.beams);
        self.sense_into(world, world_from_sensor, rng, &mut ranges_m);
        ranges_m
    }

    /// Returns the points of a scan in the sensor frame, in beam order, without beams that have no
    /// return.
    pub fn project<'a>(&'a self, ranges_m: &'a [f64]) -> impl Iterator<Item = Point2<f64>> + 'a {
        let limit = self.config.return_limit_m();
        ranges_m
            .iter()
            .zip(&self.directions)
            .filter(move |(range, _)| **range < limit)
            .map(|(range, direction)| Point2::new(range * direction.cos, range * direction.sin))
    }
}

#[cfg(test)]
mod tests {
    use core::f64::consts::FRAC_PI_2;

    use super::*;

    #[test]
    fn a_full_circle_does_not_repeat_its_first_beam() {
        let lidar = Lidar::new(LidarConfig {
            beams: 4,
            ..LidarConfig::default()
        });
        assert_eq!(lidar.bearings_rad(), [-PI, -FRAC_PI_2, 0.0, FRAC_PI_2]);
    }

    #[test]
    fn a_part_of_the_circle_reaches_both_ends() {
        let lidar = Lidar::new(LidarConfig {
            beams: 3,
            field_of_view_rad: PI,
            ..LidarConfig::default()
        });
        assert_eq!(lidar.bearings_rad(), [-FRAC_PI_2, 0.0, FRAC_PI_2]);
    }

    #[test]
    fn projection_drops_beams_that_hit_nothing() {
        let lidar = Lidar::new(LidarConfig {
            beams: 4,
            ..LidarConfig::default()
        });
        // 0.995 · 6 = 5.97: the first and the last beam have no return.
        let points: Vec<_> = lidar.project(&[5.97, 2.0, 3.0, 6.0]).collect();
        assert_eq!(points.len(), 2);
        assert!((points[0] - Point2::new(0.0, -2.0)).norm() < 1e-12);
        assert!((points[1] - Point2::new(3.0, 0.0)).norm() < 1e-12);
    }

    #[test]
    fn projected_points_of_a_noise_free_sweep_lie_on_walls() {
        let world = World::apartment();
        let mut lidar = Lidar::new(LidarConfig::default());
        let world_from_sensor = SE2::new(2.0, 1.9, 0.3);
        let mut ranges_m = Vec::new();
        lidar.measure_into(&world, &world_from_sensor, &mut ranges_m);
        for point in lidar.project(&ranges_m) {
            let p = world_from_sensor.transform(point);
            let distance = world
                .walls()
                .iter()
                .map(|wall| {
                    let edge = wall.end - wall.start;
                    let along = ((p - wall.start).dot(&edge) / edge.norm_squared()).clamp(0.0, 1.0);
                    (p - wall.start - edge * along).norm()
                })
                .fold(f64::INFINITY, f64::min);
            assert!(distance < 1e-12, "{p} is {distance} m from a wall");
        }
    }
}
