//! Logs of Carnegie Mellon's course 16-831: odometry and scans of a robot in Wean Hall, in centimetres.
//!
//! | line | content |
//! |---|---|
//! | `L x y θ x_l y_l θ_l r1 … r180 time` | odometry of the robot, the laser's pose in its frame, and ranges from the right to the left, one each degree |
//! | `O x y θ time` | odometry |
//!
//! Source: the description that comes with the logs `robotdata1.log` to `robotdata5.log`.

use core::f64::consts::FRAC_PI_2;

use ch16_slam2d::scan::LaserScan;
use pr_geom::SE2;

use crate::line_log::{LineFormat, LineReader};
use crate::lines::finite;
use crate::log::{LogFrame, LogNotes};
use crate::plausible::{plausible_pose, plausible_stamp_s};

/// Beams of a scan.
const BEAMS: usize = 180;
/// Metres per unit of the file.
const METRE: f64 = 0.01;
/// Readings at the sensor's limit are no returns, m.
const RANGE_MAX_M: f64 = 81.8;

/// Reads a log of the course, line by line.
pub type CourseReader<R> = LineReader<R, CourseLines>;

/// The format: each line is independent.
#[derive(Debug, Default)]
pub struct CourseLines;

impl CourseLines {
    /// Whether a file with this start is such a log.
    #[must_use]
    pub fn begins(start: &[u8]) -> bool {
        let mut lines = start.split(|&byte| byte == b'\n').take(20);
        lines.any(|line| {
            let words = line.split(u8::is_ascii_whitespace);
            let count = words.filter(|word| !word.is_empty()).count();
            line.starts_with(b"O ") && count == 5 || line.starts_with(b"L ") && count == BEAMS + 8
        })
    }
}

impl LineFormat for CourseLines {
    const NO_SCANS: &'static str = "no line starts with L";

    fn read_line(
        &mut self,
        line: &[u8],
        _frames: usize,
        notes: &mut LogNotes,
    ) -> Result<Option<LogFrame>, String> {
        let text = String::from_utf8_lossy(line);
        let mut words = text.split_ascii_whitespace();
        let kind = words.next().unwrap_or_default();
        if !matches!(kind, "L" | "O") {
            return match kind {
                "" | "#" => Ok(None),
                _ => Err("a line must start with L or O".to_owned()),
            };
        }
        *notes.records.entry(kind.to_owned()).or_default() += 1;
        if kind == "O" {
            return Ok(None);
        }
        let mut pose = || {
            let mut next = |name| finite(words.next(), name);
            let (x, y) = (METRE * next("x")?, METRE * next("y")?);
            plausible_pose(SE2::new(x, y, next("the heading")?))
        };
        let (robot, laser) = (pose()?, pose()?);
        let mut ranges_m = Vec::with_capacity(BEAMS);
        for _ in 0..BEAMS {
            ranges_m.push(METRE * finite(words.next(), "a range")?);
        }
        Ok(Some(LogFrame {
            stamp_s: plausible_stamp_s(finite(words.next(), "the time")?)?,
            odometry: Some(robot),
            scan: LaserScan {
                first_angle_rad: -FRAC_PI_2,
                angle_step_rad: 1.0_f64.to_radians(),
                range_max_m: RANGE_MAX_M,
                body_from_sensor: robot.between(&laser),
                ranges_m,
                ..LaserScan::default()
            },
        }))
    }
}

#[cfg(test)]
mod tests {
    use crate::log::LogOptions;
    use crate::log_format::LogFormat;

    #[test]
    fn centimetres_become_metres_and_the_laser_stands_ahead_of_the_robot() {
        let ranges: Vec<String> = (0..180).map(|beam| (100 + beam).to_string()).collect();
        let text = format!(
            "O 100 200 1.5 0.01\nL 100 200 1.5707963 100 225 1.5707963 {} 0.02\n",
            ranges.join(" ")
        );
        let options = LogOptions::default();
        let mut reader = LogFormat::open(text.as_bytes(), "wean.log", &options).unwrap();
        let frame = reader.next_frame().unwrap().unwrap();
        assert_eq!(frame.stamp_s, 0.02);
        assert_eq!(frame.odometry.unwrap().position().x, 1.0);
        let [x, y, turn] = frame.scan.body_from_sensor.to_array();
        // 25 cm ahead; 1e-6: the heading has eight digits.
        assert!((x - 0.25).abs() < 1e-6 && y.abs() < 1e-6 && turn == 0.0);
        assert_eq!(
            (frame.scan.ranges_m[0], frame.scan.ranges_m.len()),
            (1.0, 180)
        );
        assert_eq!(reader.next_frame().unwrap(), None);
    }
}
