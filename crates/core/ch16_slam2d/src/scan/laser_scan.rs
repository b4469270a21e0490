//! A sweep of a planar laser with its geometry.

use nalgebra::Vector3;
use pr_geom::SE2;
use serde::{Deserialize, Serialize};

use super::FrameError;

/// Ranges of one sweep and the geometry of its beams.
///
/// Beam k leaves the sensor at the bearing `first_angle_rad + k · angle_step_rad`. A range is a return
/// if it is above 0, at least `range_min_m` and below `range_max_m`; 0, NaN and infinite ranges
/// and those at the maximum are no return.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LaserScan {
    /// Bearing of the first beam in the sensor's frame, rad.
    pub first_angle_rad: f64,
    /// Bearing from one beam to the next, rad; negative if the sensor turns clockwise.
    pub angle_step_rad: f64,
    /// Shorter ranges are no return, m.
    pub range_min_m: f64,
    /// Ranges at or beyond this are no return, m.
    pub range_max_m: f64,
    /// Pose of the sensor on the body.
    pub body_from_sensor: SE2,
    /// Time from one beam to the next, s; 0 if all beams are simultaneous.
    pub beam_interval_s: f64,
    /// Velocity of the body during the sweep by odometry: m/s, m/s, rad/s. Without it, the motion since the last scan
    /// stands for it, or it is found together with the pose.
    #[serde(skip)]
    pub velocity: Option<Vector3<f64>>,
    /// One range for each beam, m.
    pub ranges_m: Vec<f64>,
}

impl Default for LaserScan {
    /// A full circle without beams, at the body's origin, of any range.
    fn default() -> Self {
        Self {
            first_angle_rad: -core::f64::consts::PI,
            angle_step_rad: core::f64::consts::TAU,
            range_min_m: 0.0,
            range_max_m: f64::INFINITY,
            body_from_sensor: SE2::identity(),
            beam_interval_s: 0.0,
            velocity: None,
            ranges_m: Vec::new(),
        }
    }
}

impl LaserScan {
    /// Bearing of beam `beam` in the sensor's frame, rad.
    #[inline]
    #[must_use]
    pub fn bearing_rad(&self, beam: usize) -> f64 {
        self.first_angle_rad + beam as f64 * self.angle_step_rad
    }

    /// Time from the first beam to the last, s.
    #[must_use]
    pub fn sweep_s(&self) -> f64 {
        self.ranges_m.len().saturating_sub(1) as f64 * self.beam_interval_s
    }

    /// Whether `range_m` is a return of this scan.
    #[inline]
    #[must_use]
    pub fn is_return(&self, range_m: f64) -> bool {
        range_m > 0.0
            && range_m >= self.range_min_m
            && range_m < self.range_max_m
            && range_m.is_finite()
    }

    /// Whether both scans have the same beam directions.
    #[must_use]
    pub fn same_beams(&self, other: &Self) -> bool {
        self.first_angle_rad == other.first_angle_rad
            && self.angle_step_rad == other.angle_step_rad
            && self.ranges_m.len() == other.ranges_m.len()
    }

    /// Validates the geometry; single ranges may have any value.
    ///
    /// # Errors
    /// The first invalid number, and what is expected.
    pub fn validate(&self) -> Result<(), FrameError> {
        let [x, y, theta] = self.body_from_sensor.to_array();
        let velocity = self.velocity.map_or(0.0, |velocity| velocity.norm());
        let rules = [
            (
                "first angle",
                self.first_angle_rad,
                self.first_angle_rad.is_finite(),
                "radians",
            ),
            (
                "angle step",
                self.angle_step_rad,
                self.angle_step_rad.is_finite() && self.angle_step_rad != 0.0,
                "radians other than 0",
            ),
            (
                "shortest range",
                self.range_min_m,
                self.range_min_m >= 0.0 && self.range_min_m.is_finite(),
                "metres, at least 0",
            ),
            (
                "longest range",
                self.range_max_m,
                self.range_max_m > self.range_min_m,
                "metres above the shortest range",
            ),
            (
                "beam interval",
                self.beam_interval_s,
                self.beam_interval_s >= 0.0 && self.beam_interval_s.is_finite(),
                "seconds, at least 0",
            ),
            ("velocity", velocity, velocity.is_finite(), "m/s and rad/s"),
            ("mounting in x", x, x.is_finite(), "metres"),
            ("mounting in y", y, y.is_finite(), "metres"),
            ("mounting angle", theta, theta.is_finite(), "radians"),
        ];
        match rules.into_iter().find(|(_, _, usable, _)| !usable) {
            Some((name, value, _, expected)) => Err(FrameError::Geometry {
                name,
                value,
                expected,
            }),
            None => Ok(()),
        }
    }
}
