//! A table of scans with its odometry in a second file.

use std::fmt::Write as _;

use pr_geom::SE2;
use robot_io::log::{LogFrame, LogOptions};
use robot_io::log_bytes::LogBytes;
use robot_io::log_format::LogFormat;

use super::base::{messages, truth};
use super::write::{Body, mcap};
use super::{Mapped, NEAR_M, PER_CHUNK, distance_m, mapped, path};

/// The frames of the recording without faults.
fn frames() -> Vec<LogFrame> {
    let bytes = mcap(&messages(), PER_CHUNK);
    let mut reader = LogFormat::open(&bytes[..], "x.mcap", &LogOptions::default()).unwrap();
    let mut frames = Vec::new();
    while let Some(frame) = reader.next_frame().unwrap() {
        frames.push(frame);
    }
    frames
}

/// A row per scan, with or without its odometry.
fn table(frames: &[LogFrame], has_odometry: bool) -> String {
    let odometry = if has_odometry { ",x,y,heading" } else { "" };
    let mut text = format!("time{odometry},angle_min,angle_increment,range_max,ranges\n");
    for LogFrame {
        stamp_s,
        odometry,
        scan,
    } in frames
    {
        write!(text, "{stamp_s}").unwrap();
        if let Some(pose) = odometry.filter(|_| has_odometry) {
            write!(text, ",{},{},{}", pose.x(), pose.y(), pose.theta()).unwrap();
        }
        let (angle, step, most) = (scan.first_angle_rad, scan.angle_step_rad, scan.range_max_m);
        write!(text, ",{angle},{step},{most}").unwrap();
        for range_m in &scan.ranges_m {
            write!(text, ",{range_m}").unwrap();
        }
        text.push('\n');
    }
    text
}

/// The odometry of the frames alone.
fn poses(header: &str, frames: &[LogFrame]) -> String {
    let rows = frames.iter().filter_map(|frame| {
        let (stamp_s, pose) = (frame.stamp_s, frame.odometry?);
        let [x, y, theta] = pose.to_array();
        Some(format!("{stamp_s},{x},{y},{theta}\n"))
    });
    format!("{header}{}", rows.collect::<String>())
}

fn together(files: &[&str], options: &LogOptions) -> Mapped {
    let parts = files.iter().map(|text| LogBytes::from(text.as_bytes()));
    mapped(parts.collect(), "x.csv", options)
}

#[test]
fn a_table_and_the_file_of_its_odometry_are_the_same_as_one_table() {
    let frames = frames();
    let whole = together(&[&table(&frames, true)], &LogOptions::default());
    assert_eq!((whole.path.len(), whole.notes.as_str()), (frames.len(), ""));
    let scans = table(&frames, false);
    let alone = together(&[&scans], &LogOptions::default());
    assert_ne!(alone.path, whole.path);
    for header in ["t,x,y,theta\n", "time_s,x_m,y_m,yaw_rad\n", ""] {
        let odometry = poses(header, &frames);
        for files in [[&scans, &odometry], [&odometry, &scans]] {
            let split = together(&files.map(String::as_str), &LogOptions::default());
            assert_eq!(split.path, whole.path, "{header}: {}", split.notes);
            assert_eq!(split.notes, "");
        }
    }
    let columns = "odometry odom.csv@time,x_mm,y_mm,heading_deg";
    let (name, columns) = columns.split_once(' ').unwrap();
    let options = LogOptions::read([(name, columns)]).unwrap();
    let rows = frames.iter().filter_map(|frame| {
        let [x, y, theta] = frame.odometry?.to_array();
        let [x, y, theta] = [1e3 * x, 1e3 * y, theta.to_degrees()];
        Some(format!("{};{x};{y};{theta}\n", frame.stamp_s))
    });
    let units = together(&[&scans, &rows.collect::<String>()], &options);
    // 1e-9 m: units there and back.
    let pairs = units.path.iter().zip(&whole.path);
    assert!(
        pairs.fold(0.0, |most: f64, (a, b)| most
            .max((a.1.position() - b.1.position()).norm()))
            < 1e-9
    );
    let twice = together(
        &[&table(&frames, true), &poses("t,x,y,theta\n", &frames)],
        &LogOptions::default(),
    );
    assert_eq!(twice.path, whole.path);
    assert_eq!(
        twice.notes,
        "x.csv: the log has its own odometry, too; that of the file of odometry is used, and the log's is not"
    );
}

#[test]
fn odometry_as_ros_and_evo_write_it_is_interpolated_at_the_scans() {
    let all = messages();
    let rows = |row: &dyn Fn(f64, [f64; 3]) -> String| {
        let rows = all.iter().filter_map(|message| match &message.body {
            Body::Odometry { stamp_s, pose, .. } => Some(row(*stamp_s, *pose)),
            _ => None,
        });
        rows.collect::<String>()
    };
    let half = |theta: f64| (theta / 2.0).sin_cos();
    let tum = rows(&|stamp_s, [x, y, theta]| {
        let (sin, cos) = half(theta);
        format!("{stamp_s} {x} {y} 0 0 0 {sin} {cos}\n")
    });
    let echo = rows(&|stamp_s, [x, y, theta]| {
        let (sin, cos) = half(theta);
        let (sec, nanosec) = (stamp_s.floor(), (1e9 * stamp_s.fract()).round());
        let rest = ",0.0".repeat(36);
        format!("{sec},{nanosec},odom,base_link,{x},{y},0.0,0.0,0.0,{sin},{cos}{rest}\n")
    });
    let header = "%time,field.header.seq,field.header.stamp,field.header.frame_id,field.child_frame_id,field.pose.pose.position.x,field.pose.pose.position.y,field.pose.pose.position.z,field.pose.pose.orientation.x,field.pose.pose.orientation.y,field.pose.pose.orientation.z,field.pose.pose.orientation.w\n";
    let echo_p = rows(&|stamp_s, [x, y, theta]| {
        let (sin, cos) = half(theta);
        let ns = (1e9 * stamp_s).round();
        format!("{ns},1,{ns},odom,base_link,{x},{y},0.0,0.0,0.0,{sin},{cos}\n")
    });
    let evo = format!("timestamp x y z qx qy qz qw\n{tum}");
    let scans = table(&frames(), false);
    for odometry in [&tum, &evo, &echo, &format!("{header}{echo_p}")] {
        let found = together(&[&scans, odometry], &LogOptions::default());
        let head = &odometry[..40];
        assert_eq!(found.notes, "", "{head}");
        let truth: &[SE2] = truth();
        let off_m = distance_m(&path(&found), truth);
        assert!(off_m < NEAR_M, "{head}: {off_m}");
    }
}

#[test]
fn a_file_of_odometry_that_cannot_be_used_is_named_in_a_sentence() {
    let frames = frames();
    let scans = table(&frames, false);
    let options = LogOptions::read([("odometry", "odom.csv")]).unwrap();
    let said = |odometry: &str| together(&[&scans, odometry], &options).notes;
    let early: String = (0..5).map(|k| format!("{k},0,0,0\n")).collect();
    assert_eq!(
        said(&early),
        "odom.csv: no scan has odometry, because the scans are from 1700000000.00 to 1700000032.25 s and the odometry from 0.00 to 4.00 s; write both with the same clock, or state the unit, such as time_us or time_ns"
    );
    assert_eq!(said("t,x,y,theta\n"), "odom.csv: it has no poses");
    assert_eq!(
        said("t,x,y,theta\n1,2,left,3\n"),
        "odom.csv: it has no poses; line 2 is the first that is none: word 3 must be a number, not ‘left’"
    );
    assert!(said("a line of text\n").starts_with(
        "odom.csv: it is read as odometry, which is a table with a header such as time,x,y,heading"
    ));
    let alone = together(&[&scans], &options).notes;
    assert!(
        alone.starts_with("odom.csv: open the file of odometry together"),
        "{alone}"
    );
    let mut torn = poses("t,x,y,theta\n", &frames);
    torn.insert_str(torn.find('\n').unwrap() + 1, "1700000000,oops,0,0\n");
    let notes = said(&torn);
    assert!(
        notes.contains("odom.csv: one line was skipped; the first is line 2"),
        "{notes}"
    );
    let bytes = mcap(&messages(), PER_CHUNK);
    let parts = vec![LogBytes::from(&bytes[..]), LogBytes::from(early.as_bytes())];
    let ros = mapped(parts, "x.mcap", &LogOptions::default()).notes;
    assert!(
        ros.contains("which has its odometry in itself; leave"),
        "{ros}"
    );
}
