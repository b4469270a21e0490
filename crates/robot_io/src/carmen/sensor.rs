//! The front laser of FLASER lines: its geometry is not on the line.

use ch16_slam2d::scan::LaserScan;
use pr_geom::SE2;

use super::fields::Fields;
use crate::log::LogFrame;
use crate::place::is_length;

/// Farther readings of the lasers that wrote these logs saw nothing, m.
const FARTHEST_M: f64 = 80.0;
/// A SICK LMS in its millimetres says by readings from here to 8.191 m that it saw nothing.
const CODES_M: [f64; 2] = [8.183, 8.1915];
/// A laser that stands farther from the robot's centre is another map's pose, m.
const FARTHEST_MOUNT_M: f64 = 1.5;
/// A front laser stands on the axis of its robot, m and rad.
const MOUNT_OFF_AXIS: [f64; 2] = [0.02, 0.01];

/// What PARAM lines and the first scan say of the front laser.
#[derive(Clone, Debug, Default)]
pub struct FrontLaser {
    range_max_m: Option<f64>,
    field_of_view_rad: Option<f64>,
    angle_step_rad: Option<f64>,
    forward_m: Option<f64>,
    sideways_m: Option<f64>,
    turned_rad: Option<f64>,
    mount: Option<SE2>,
}

impl FrontLaser {
    /// Takes a PARAM line; names that say nothing of the front laser are left.
    pub fn take_parameter(&mut self, fields: &mut Fields<'_>) {
        let name = fields.word();
        let value = fields.number(name).ok().filter(|value| is_length(*value));
        let Some(value) = value else {
            return;
        };
        match name {
            "robot_front_laser_max" | "robot_frontlaser_max" if value > 0.0 => {
                self.range_max_m = Some(value);
            }
            "laser_front_laser_fov" | "laser_laser1_fov" if value > 0.0 => {
                self.field_of_view_rad = Some(value.to_radians());
            }
            "laser_front_laser_resolution" | "laser_laser1_resolution" if value > 0.0 => {
                self.angle_step_rad = Some(value.to_radians());
            }
            "robot_frontlaser_offset" => self.forward_m = Some(value),
            "robot_frontlaser_side_offset" => self.sideways_m = Some(value),
            "robot_frontlaser_angular_offset" => self.turned_rad = Some(value),
            _ => {}
        }
    }

    /// The frame of a FLASER line.
    ///
    /// Beams stand from −90° counter-clockwise in steps of 180°/n where n is even, 180°/(n − 1) where
    /// it is odd, unless PARAM lines give field of view and step for this number of beams.
    pub fn frame(&mut self, fields: &mut Fields<'_>, frames: usize) -> Result<LogFrame, String> {
        let ranges_m = fields.list("readings")?;
        if ranges_m.len() < 2 {
            return Err("a scan has to have two readings at least".to_owned());
        }
        let laser = fields.pose(["laser_x", "laser_y", "laser_theta"])?;
        let odometry = fields.pose(["odom_x", "odom_y", "odom_theta"])?;
        let stamp_s = fields.stamp_s(frames)?;
        let (first_angle_rad, angle_step_rad) = self.beams(ranges_m.len());
        let scan = LaserScan {
            first_angle_rad,
            angle_step_rad,
            range_max_m: self.range_max_m.unwrap_or_else(|| farthest_m(&ranges_m)),
            body_from_sensor: self.mount(&odometry, &laser),
            ranges_m,
            ..LaserScan::default()
        };
        Ok(LogFrame {
            stamp_s,
            odometry: Some(odometry),
            scan,
        })
    }

    fn beams(&self, count: usize) -> (f64, f64) {
        let half_circle = core::f64::consts::PI;
        if let (Some(view), Some(step)) = (self.field_of_view_rad, self.angle_step_rad) {
            let beams = view / step;
            if (beams - count as f64).abs() < 1.5 {
                return (-view / 2.0, step);
            }
        }
        let steps = if count.is_multiple_of(2) {
            count
        } else {
            count - 1
        };
        (-half_circle / 2.0, half_circle / steps as f64)
    }

    /// Where the laser sits: by PARAM lines, or by the first line where its two poses agree to a
    /// mounting on the robot's axis. A log that was corrected has the map's pose in place of the
    /// laser's.
    fn mount(&mut self, odometry: &SE2, laser: &SE2) -> SE2 {
        if self.forward_m.is_some() || self.sideways_m.is_some() || self.turned_rad.is_some() {
            return SE2::new(
                self.forward_m.unwrap_or_default(),
                self.sideways_m.unwrap_or_default(),
                self.turned_rad.unwrap_or_default(),
            );
        }
        *self.mount.get_or_insert_with(|| {
            let mount = odometry.between(laser);
            let [off_m, off_rad] = MOUNT_OFF_AXIS;
            let is_mount = mount.y().abs() <= off_m
                && mount.theta().abs() <= off_rad
                && (0.0..=FARTHEST_MOUNT_M).contains(&mount.x());
            if is_mount { mount } else { SE2::identity() }
        })
    }
}

/// The longest range that is one, by what the scan itself says.
fn farthest_m(ranges_m: &[f64]) -> f64 {
    let farthest_m = ranges_m.iter().copied().fold(0.0, f64::max);
    let [first_m, last_m] = CODES_M;
    if (first_m..=last_m).contains(&farthest_m) {
        first_m
    } else {
        FARTHEST_M
    }
}
