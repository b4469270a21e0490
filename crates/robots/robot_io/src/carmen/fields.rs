//! Typed fields of a CARMEN line.

use ch16_slam2d::scan::LaserScan;
use pr_geom::SE2;

use crate::lines::{decimal_comma, finite, printable};
use crate::log::LogFrame;
use crate::plausible::{MAX_BEAMS, plausible_pose, plausible_stamp_s};

/// The words of a line, one after the other.
pub struct Fields<'a> {
    words: std::str::SplitAsciiWhitespace<'a>,
}

impl<'a> Fields<'a> {
    /// The words of `text`.
    pub fn parse(text: &'a str) -> Self {
        Self {
            words: text.split_ascii_whitespace(),
        }
    }

    /// The next word; empty at the end.
    pub fn word(&mut self) -> &'a str {
        self.words.next().unwrap_or_default()
    }

    /// The next word as a finite number.
    pub fn number(&mut self, name: &str) -> Result<f64, String> {
        finite(self.words.next(), name)
    }

    /// The next three words as a pose.
    pub fn pose(&mut self, names: [&str; 3]) -> Result<SE2, String> {
        let [x, y, theta] = names;
        plausible_pose(SE2::new(
            self.number(x)?,
            self.number(y)?,
            self.number(theta)?,
        ))
    }

    /// A count followed by that many numbers; NaN is allowed and is no return.
    pub fn list(&mut self, name: &str) -> Result<Vec<f64>, String> {
        let text = self.word();
        let count = match text.parse::<usize>() {
            Ok(count) if count <= MAX_BEAMS => count,
            _ => {
                return Err(format!(
                    "the number of {name} must be an integer up to {MAX_BEAMS}, not ‘{}’",
                    printable(text)
                ));
            }
        };
        let mut values = Vec::with_capacity(count);
        for index in 0..count {
            let text = self.word();
            if text.is_empty() {
                return Err(format!("expected {count} {name}, found {index}"));
            }
            let value = text.parse::<f64>().map_err(|_| {
                format!(
                    "number {} of the {name} must be a number, not ‘{}’{}",
                    index + 1,
                    printable(text),
                    decimal_comma(text)
                )
            })?;
            values.push(value);
        }
        Ok(values)
    }

    /// `ipc_time host logger_time`: the first time that is set, else the number of the frame.
    pub fn stamp_s(&mut self, frames: usize) -> Result<f64, String> {
        let ipc_s = self.number("ipc_time")?;
        self.word();
        let logger_s = self.number("logger_time")?;
        plausible_stamp_s(if ipc_s > 0.0 {
            ipc_s
        } else if logger_s > 0.0 {
            logger_s
        } else {
            frames as f64
        })
    }
}

/// Time and pose of an ODOM line. If the log has no times, the time is `scans`, that of the next scan.
pub fn odometry_message(fields: &mut Fields<'_>, scans: usize) -> Result<(f64, SE2), String> {
    let pose = fields.pose(["x", "y", "theta"])?;
    for name in ["tv", "rv", "accel"] {
        fields.number(name)?;
    }
    Ok((fields.stamp_s(scans)?, pose))
}

/// Reads a ROBOTLASER1 line, or a RAWLASER1 line, which has no poses.
pub fn laser_message(
    fields: &mut Fields<'_>,
    has_poses: bool,
    frames: usize,
) -> Result<LogFrame, String> {
    fields.number("laser_type")?;
    let first_angle_rad = fields.number("start_angle")?;
    let field_of_view_rad = fields.number("field_of_view")?;
    let angle_step_rad = fields.number("angular_resolution")?;
    let range_max_m = fields.number("maximum_range")?;
    fields.number("accuracy")?;
    fields.number("remission_mode")?;
    let ranges_m = fields.list("readings")?;
    fields.list("remissions").map_err(|problem| {
        let stated = ranges_m.len();
        format!(
            "{problem}; the line may have fewer or more than the {stated} readings that it states"
        )
    })?;
    if ranges_m.is_empty() {
        return Err("a scan must have readings, and this one has none".to_owned());
    }
    let steps = (ranges_m.len() - 1).max(1) as f64;
    let angle_step_rad = if angle_step_rad == 0.0 {
        field_of_view_rad / steps
    } else {
        angle_step_rad
    };
    if angle_step_rad == 0.0 {
        return Err("angular_resolution must not be 0".to_owned());
    }
    let mut scan = LaserScan {
        first_angle_rad,
        angle_step_rad,
        range_max_m: if range_max_m > 0.0 {
            range_max_m
        } else {
            f64::INFINITY
        },
        ranges_m,
        ..LaserScan::default()
    };
    let odometry = if has_poses {
        let laser = fields.pose(["laser_pose_x", "laser_pose_y", "laser_pose_theta"])?;
        let robot = fields.pose(["robot_pose_x", "robot_pose_y", "robot_pose_theta"])?;
        for name in [
            "laser_tv",
            "laser_rv",
            "forward_safety_dist",
            "side_safety_dist",
            "turn_axis",
        ] {
            fields.number(name)?;
        }
        scan.body_from_sensor = robot.between(&laser);
        Some(robot)
    } else {
        None
    };
    Ok(LogFrame {
        stamp_s: fields.stamp_s(frames)?,
        odometry,
        scan,
    })
}
