//! Writes frames as lines of CARMEN.

use std::io::{self, Write};

use pr_geom::SE2;

use crate::log::LogFrame;

/// Longest range that is written if the sensor states none, m.
const FARTHEST_M: f64 = 80.0;

/// Writes a frame as ROBOTLASER1 if it has odometry, else as RAWLASER1.
///
/// The format has no field for the shortest range or the time between beams. A range that is not a number becomes 0,
/// which is no return either.
///
/// # Errors
/// If `target` fails.
pub fn write_carmen(frame: &LogFrame, mut target: impl Write) -> io::Result<()> {
    let scan = &frame.scan;
    let kind = match frame.odometry {
        Some(_) => "ROBOTLASER1",
        None => "RAWLASER1",
    };
    let steps = scan.ranges_m.len().saturating_sub(1) as f64;
    let range_max_m = if scan.range_max_m.is_finite() {
        scan.range_max_m
    } else {
        FARTHEST_M
    };
    write!(
        target,
        "{kind} 0 {} {} {} {range_max_m} 0.01 0 {}",
        scan.first_angle_rad,
        scan.angle_step_rad * steps,
        scan.angle_step_rad,
        scan.ranges_m.len()
    )?;
    for &range_m in &scan.ranges_m {
        // A range beyond the limit stays beyond it; CARMEN has no shortest range.
        let written_m = match scan.is_return(range_m) {
            true => range_m,
            false if range_m >= scan.range_max_m => range_max_m,
            false => 0.0,
        };
        write!(target, " {written_m}")?;
    }
    write!(target, " 0")?;
    if let Some(robot) = frame.odometry {
        let laser: SE2 = robot * scan.body_from_sensor;
        for pose in [laser, robot] {
            let [x, y, theta] = pose.to_array();
            write!(target, " {x} {y} {theta}")?;
        }
        write!(target, " 0 0 0 0 0")?;
    }
    writeln!(target, " {} robot {}", frame.stamp_s, frame.stamp_s)
}

#[cfg(test)]
mod tests {
    use ch16_slam2d::scan::LaserScan;

    use super::*;
    use crate::carmen::CarmenReader;
    use crate::log::LogReader;

    #[test]
    fn what_is_written_reads_back() {
        let frame = |stamp_s: f64| LogFrame {
            stamp_s,
            odometry: Some(SE2::new(1.0, 2.0, 0.5)),
            scan: LaserScan {
                first_angle_rad: -1.5,
                angle_step_rad: 0.25,
                range_min_m: 0.1,
                range_max_m: 8.0,
                body_from_sensor: SE2::new(0.2, 0.0, 0.1),
                ranges_m: vec![0.05, f64::NAN, 3.25, 9.0],
                ..LaserScan::default()
            },
        };
        let mut bytes = Vec::new();
        for stamp_s in [1.5, 2.5] {
            write_carmen(&frame(stamp_s), &mut bytes).unwrap();
        }
        let mut reader = CarmenReader::new(&bytes[..], "x.clf");
        for stamp_s in [1.5, 2.5] {
            let (back, frame) = (reader.next_frame().unwrap().unwrap(), frame(stamp_s));
            assert_eq!((back.stamp_s, back.odometry), (stamp_s, frame.odometry));
            assert_eq!(back.scan.ranges_m, [0.0, 0.0, 3.25, 8.0]);
            assert!(back.scan.same_beams(&frame.scan));
            let [mount, expected] = [&back.scan, &frame.scan].map(|scan| scan.body_from_sensor);
            // 1e-12: the mounting is composed with the robot's pose and its inverse.
            assert!(mount.between(&expected).log().norm() < 1e-12);
        }
        assert_eq!(reader.next_frame().unwrap(), None);
    }
}
