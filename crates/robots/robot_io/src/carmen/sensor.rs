//! The front laser of FLASER lines, whose geometry is not on the line.

use std::collections::VecDeque;

use ch16_slam2d::scan::LaserScan;
use pr_geom::{SE2, math};

use super::fields::Fields;
use crate::log::LogFrame;
use crate::plausible::is_plausible_length;

/// Longer readings of the lasers that wrote these logs are no returns, m.
const FARTHEST_M: f64 = 80.0;
/// Readings from here to 8.191 m are codes for “no return” of a SICK LMS in millimetre mode.
const CODES_M: [f64; 2] = [8.183, 8.1915];
/// A larger offset from the robot's centre is not a mounting but a pose of another map, m.
const FARTHEST_MOUNT_M: f64 = 1.5;
/// Tolerances, m and rad: of a front laser from the robot's axis, and between the mountings of all lines.
const MOUNT_OFF_AXIS: [f64; 2] = [0.02, 0.01];
/// Path length and turn after which a map pose has visibly drifted from odometry, m and rad.
const MOUNT_TEST_MOTION: [f64; 2] = [0.3, 0.3];
/// Most scans that wait for the mounting.
const MAX_WAITING: usize = 512;

/// Geometry of the front laser by PARAM lines and the first scans.
#[derive(Clone, Debug, Default)]
pub struct FrontLaser {
    range_max_m: Option<f64>,
    field_of_view_rad: Option<f64>,
    angle_step_rad: Option<f64>,
    forward_m: Option<f64>,
    sideways_m: Option<f64>,
    turned_rad: Option<f64>,
    mount: Option<SE2>,
    waiting: VecDeque<WaitingScan>,
}

/// A scan that waits for the mounting, with the relative pose of its own line.
#[derive(Clone, Debug)]
struct WaitingScan {
    frame: LogFrame,
    odometry: SE2,
    mount: SE2,
}

impl FrontLaser {
    /// Takes a PARAM line; ignores names that do not concern the front laser.
    pub fn read_parameter(&mut self, fields: &mut Fields<'_>) {
        let name = fields.word();
        let value = fields
            .number(name)
            .ok()
            .filter(|value| is_plausible_length(*value));
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

    /// Adds a FLASER line; its frame is returned by [`pop`](Self::pop).
    ///
    /// Beams start at −90° and go counter-clockwise in steps of 180°/n if n is even and 180°/(n − 1) if it is odd,
    /// unless PARAM lines state the field of view and step for this number of beams.
    pub fn add_scan(&mut self, fields: &mut Fields<'_>, frames: usize) -> Result<(), String> {
        let ranges_m = fields.list("readings")?;
        if ranges_m.len() < 2 {
            return Err("a scan must have at least two readings".to_owned());
        }
        let laser = fields.pose(["laser_x", "laser_y", "laser_theta"])?;
        let odometry = fields.pose(["odom_x", "odom_y", "odom_theta"])?;
        let stamp_s = fields.stamp_s(frames + self.waiting.len())?;
        let (first_angle_rad, angle_step_rad) = self.beams(ranges_m.len());
        let scan = LaserScan {
            first_angle_rad,
            angle_step_rad,
            range_max_m: self.range_max_m.unwrap_or_else(|| farthest_m(&ranges_m)),
            ranges_m,
            ..LaserScan::default()
        };
        let frame = LogFrame {
            stamp_s,
            odometry: Some(odometry),
            scan,
        };
        self.hold(frame, &odometry, &laser);
        Ok(())
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

    /// The mounting that PARAM lines state.
    pub fn stated_mount(&self) -> Option<SE2> {
        let stated = [self.forward_m, self.sideways_m, self.turned_rad];
        stated.iter().any(Option::is_some).then(|| {
            let [x, y, theta] = stated.map(Option::unwrap_or_default);
            SE2::new(x, y, theta)
        })
    }

    /// The oldest waiting scan, once the mounting is known or no line follows.
    pub fn pop(&mut self, is_done: bool) -> Option<LogFrame> {
        if self.mount.is_none() && is_done && !self.waiting.is_empty() {
            self.choose_mount();
        }
        let mount = self.mount?;
        let mut frame = self.waiting.pop_front()?.frame;
        frame.scan.body_from_sensor = mount;
        Some(frame)
    }

    /// Takes a scan with the two poses of its line and determines the mounting if they allow it. PARAM lines decide,
    /// and so does a first line whose relative pose lies on the robot's axis. Otherwise the relative pose must stay
    /// constant while the robot drives and turns: a corrected log has a map pose in place of the laser's.
    fn hold(&mut self, frame: LogFrame, odometry: &SE2, laser: &SE2) {
        let mount = odometry.between(laser);
        let odometry = *odometry;
        self.waiting.push_back(WaitingScan {
            frame,
            odometry,
            mount,
        });
        if self.mount.is_some() {
            return;
        }
        if let Some(stated) = self.stated_mount() {
            self.mount = Some(stated);
        } else if self.waiting.len() == 1 {
            let [off_m, off_rad] = MOUNT_OFF_AXIS;
            let is_mount = mount.y().abs() <= off_m
                && mount.theta().abs() <= off_rad
                && (0.0..=FARTHEST_MOUNT_M).contains(&mount.x());
            self.mount = is_mount.then_some(mount);
        } else if !self.is_one_mount()
            || self.has_moved_enough()
            || self.waiting.len() >= MAX_WAITING
        {
            self.choose_mount();
        }
    }

    /// Whether the robot has driven and turned far enough to distinguish a mounting from a map pose.
    fn has_moved_enough(&self) -> bool {
        let (Some(first), Some(last)) = (self.waiting.front(), self.waiting.back()) else {
            return false;
        };
        let motion = first.odometry.between(&last.odometry);
        let [path_length_m, turn_rad] = MOUNT_TEST_MOTION;
        math::norm2(motion.x(), motion.y()) >= path_length_m && motion.theta().abs() >= turn_rad
    }

    /// Whether all waiting lines agree on one mounting.
    fn is_one_mount(&self) -> bool {
        let Some(first) = self.waiting.front() else {
            return false;
        };
        let is_same = |other: &WaitingScan| {
            let off = first.mount.between(&other.mount);
            let [off_m, off_rad] = MOUNT_OFF_AXIS;
            math::norm2(off.x(), off.y()) <= off_m && off.theta().abs() <= off_rad
        };
        math::norm2(first.mount.x(), first.mount.y()) <= FARTHEST_MOUNT_M
            && self.waiting.iter().all(is_same)
    }

    fn choose_mount(&mut self) {
        let is_mount = self.is_one_mount();
        let first = self.waiting.front().map(|scan| scan.mount);
        self.mount = first.filter(|_| is_mount).or(Some(SE2::identity()));
    }
}

/// The longest valid range, inferred from the scan.
fn farthest_m(ranges_m: &[f64]) -> f64 {
    let farthest_m = ranges_m.iter().copied().fold(0.0, f64::max);
    let [first_m, last_m] = CODES_M;
    if (first_m..=last_m).contains(&farthest_m) {
        first_m
    } else {
        FARTHEST_M
    }
}
