//! Content of logs, and errors of damaged ones.

use core::f64::consts::{FRAC_PI_2, PI};

use super::*;
use crate::log::{LogError, LogReader};
use pr_geom::{SE2, Vector3};

/// Reads all frames and notes of a text.
fn read(text: impl AsRef<[u8]>) -> Result<(Vec<LogFrame>, LogNotes), LogError> {
    let mut reader = CarmenReader::new(text.as_ref(), "x.clf");
    let mut frames = Vec::new();
    while let Some(frame) = reader.next_frame()? {
        frames.push(frame);
    }
    Ok((frames, reader.notes().clone()))
}

const FLASER: &str = "FLASER 4 1 2 81.83 4 1.1 2 0.5 1 2 0.5 100.25 host 7\n";

#[test]
fn a_flaser_line_is_a_scan_with_odometry() {
    let (frames, notes) = read(FLASER).unwrap();
    let [frame] = &frames[..] else { panic!() };
    assert_eq!(frame.stamp_s, 100.25);
    assert_eq!(frame.odometry, Some(SE2::new(1.0, 2.0, 0.5)));
    assert_eq!(frame.scan.ranges_m, [1.0, 2.0, 81.83, 4.0]);
    assert_eq!(frame.scan.first_angle_rad, -FRAC_PI_2);
    assert_eq!(frame.scan.angle_step_rad, PI / 4.0);
    assert!(!frame.scan.is_return(81.83) && frame.scan.is_return(4.0));
    assert_eq!(notes.records["FLASER"], 1);
    assert_eq!((notes.broken, notes.truncated), (0, None));
}

#[test]
fn an_odd_number_of_beams_ends_at_the_left_and_an_even_one_before_it() {
    for (count, steps) in [(180, 180.0), (181, 180.0), (360, 360.0), (361, 360.0)] {
        let text = format!("FLASER {count} {}0 0 0 0 0 0 1 h 1\n", "2.5 ".repeat(count));
        let (frames, _) = read(text).unwrap();
        assert_eq!(frames[0].scan.angle_step_rad, PI / steps, "{count}");
    }
}

#[test]
fn parameters_say_where_the_laser_sits_and_how_far_it_sees() {
    let text = format!(
        "PARAM robot_frontlaser_offset 0.22 1 h 1\nPARAM robot_front_laser_max 3.5 1 h 1\n{FLASER}"
    );
    let (frames, _) = read(text).unwrap();
    assert_eq!(frames[0].scan.body_from_sensor, SE2::new(0.22, 0.0, 0.0));
    assert!(!frames[0].scan.is_return(4.0));
}

#[test]
fn the_codes_of_a_laser_in_millimetres_are_no_points() {
    let (frames, _) = read("FLASER 2 8.183 3.5 0 0 0 0 0 0 1 h 1\n").unwrap();
    assert!(!frames[0].scan.is_return(8.183) && frames[0].scan.is_return(3.5));
}

#[test]
fn a_robotlaser_line_carries_its_own_geometry() {
    let text = "ROBOTLASER1 0 -1.5 3.0 1.5 30 0.01 0 3 1 2 3 1 99 1.3 2 0 1 2 0 0.1 0.2 1 1 0 12.5 h 0.5\n";
    let (frames, _) = read(text).unwrap();
    let scan = &frames[0].scan;
    assert_eq!((scan.first_angle_rad, scan.angle_step_rad), (-1.5, 1.5));
    assert_eq!((scan.range_max_m, scan.ranges_m.len()), (30.0, 3));
    assert!((scan.body_from_sensor.x() - 0.3).abs() < 1e-12);
    assert_eq!(frames[0].stamp_s, 12.5);
}

#[test]
fn a_raw_scan_takes_the_odometry_of_its_time() {
    let raw = |t: f64| format!("RAWLASER1 0 -1.5 3.0 1.5 30 0.01 0 3 1 2 3 0 {t} h {t}\n");
    let odom = |x: f64, t: f64| format!("ODOM {x} 0 0 0 0 0 {t} h {t}\n");
    let text = [odom(0.0, 1.0), raw(1.5), odom(1.0, 2.0), raw(3.0)].concat();
    let (frames, _) = read(text).unwrap();
    let xs: Vec<Option<f64>> = frames
        .iter()
        .map(|f| f.odometry.map(|pose| pose.x()))
        .collect();
    // A second after the last odometry pose there is no odometry.
    assert_eq!(xs, [Some(0.5), None]);
}

#[test]
fn a_raw_scan_that_is_logged_late_takes_the_odometry_of_its_own_time() {
    let odom = |x: f64, t: f64| format!("ODOM {x} 0 0 0 0 0 {t} h {t}\n");
    let raw = "RAWLASER1 0 -1.5 3.0 1.5 30 0.01 0 3 1 2 3 0 1.5 h 4.2\n".to_owned();
    let odometry = [
        odom(0.0, 1.0),
        odom(1.0, 2.0),
        odom(3.0, 3.0),
        odom(6.0, 4.0),
    ];
    let (frames, _) = read([odometry.concat(), raw].concat()).unwrap();
    assert_eq!(frames[0].odometry.unwrap().x(), 0.5);
}

#[test]
fn a_raw_scan_without_a_time_takes_the_odometry_before_it() {
    let odom = |x: f64| format!("ODOM {x} 0 0 0 0 0 0 h 0\n");
    let raw = "RAWLASER1 0 -1.5 3.0 1.5 30 0.01 0 3 1 2 3 0 0 h 0\n".to_owned();
    let line = |scan: u32| [odom(f64::from(scan)), raw.clone()].concat();
    let (frames, _) = read((0..100).map(line).collect::<String>()).unwrap();
    let xs = frames.iter().map(|frame| frame.odometry.unwrap().x());
    assert!(xs.eq((0..100).map(f64::from)));
}

#[test]
fn parameters_say_where_the_laser_of_raw_scans_sits() {
    let text = "PARAM robot_frontlaser_offset 0.22 1 h 1\n\
                RAWLASER1 0 -1.5 3.0 1.5 30 0.01 0 3 1 2 3 0 1.5 h 1.5\n";
    let (frames, _) = read(text).unwrap();
    assert_eq!(frames[0].scan.body_from_sensor, SE2::new(0.22, 0.0, 0.0));
}

/// Lines of a robot on an arc, without times; `in_place` maps odometry to the laser's pose.
fn on_an_arc(in_place: impl Fn(SE2) -> SE2) -> String {
    let line = |step: u32| {
        let odometry = SE2::exp(&(Vector3::new(0.1, 0.0, 0.05) * f64::from(step)));
        let [[x, y, theta], [a, b, c]] = [in_place(odometry), odometry].map(|pose| pose.to_array());
        format!("FLASER 2 1 2 {x} {y} {theta} {a} {b} {c} 0 h 0\n")
    };
    (0..20).map(line).collect()
}

#[test]
fn a_laser_that_looks_back_or_aside_sits_where_every_line_says() {
    for mount in [
        SE2::new(-0.3, 0.0, 3.1),
        SE2::new(0.1, 0.25, 0.0),
        SE2::new(0.2, 0.0, FRAC_PI_2),
    ] {
        let (frames, _) = read(on_an_arc(|odometry| odometry * mount)).unwrap();
        assert_eq!(frames.len(), 20);
        for (number, frame) in frames.iter().enumerate() {
            let found = frame.scan.body_from_sensor;
            // 1e-12: a few roundings of numbers about 1.
            assert!(mount.between(&found).log().norm() < 1e-12, "{found:?}");
            assert_eq!(frame.stamp_s, number as f64);
        }
    }
}

#[test]
fn a_map_pose_in_place_of_the_lasers_is_not_a_mounting() {
    for map_from_odometry in [SE2::new(0.4, 0.2, 0.1), SE2::new(0.1, 0.3, 0.0)] {
        let (frames, _) = read(on_an_arc(|odometry| map_from_odometry * odometry)).unwrap();
        assert_eq!(frames.len(), 20);
        let mut mounts = frames.iter().map(|frame| frame.scan.body_from_sensor);
        assert!(mounts.all(|mount| mount == SE2::identity()));
    }
}

#[test]
fn raw_scans_without_any_odometry_are_all_read() {
    // More than may wait for odometry at a time.
    let raw = |t: usize| format!("RAWLASER1 0 -1.5 3.0 1.5 30 0.01 0 3 1 2 3 0 {t} h {t}\n");
    let (frames, _) = read((1..=200).map(raw).collect::<String>()).unwrap();
    assert_eq!(frames.len(), 200);
    assert!(frames.iter().all(|frame| frame.odometry.is_none()));
}

#[test]
fn a_scan_that_is_logged_twice_is_read_once() {
    let text = "\
ODOM 0 0 0 0 0 0 1 h 1
RAWLASER1 0 -1.5 3.0 1.5 30 0.01 0 3 1 2 3 0 1.5 h 1.5
ROBOTLASER1 0 -1.5 3.0 1.5 30 0.01 0 3 1 2 3 0 0 0 0 0 0 0 0 0 1 1 0 1.5 h 1.5
ODOM 0 0 0 0 0 0 2 h 2
RAWLASER1 0 -1.5 3.0 1.5 30 0.01 0 3 1 2 3 0 2.5 h 2.5
";
    let (frames, notes) = read(text).unwrap();
    assert_eq!(frames.len(), 1);
    assert_eq!(notes.records["RAWLASER1"], 2);
}

#[test]
fn a_log_without_times_counts_its_scans() {
    let line = "FLASER 2 1 2 0 0 0 0 0 0 0 h 0\n";
    let (frames, _) = read(line.repeat(3)).unwrap();
    let stamps: Vec<f64> = frames.iter().map(|f| f.stamp_s).collect();
    assert_eq!(stamps, [0.0, 1.0, 2.0]);
}

#[test]
fn a_malformed_line_is_reported_and_the_rest_is_read() {
    let broken = "FLASER 4 1 2 x 4 1 2 0.5 1 2 0.5 100 host 7\n";
    let nan = "FLASER 2 1 2 0 0 0 nan 0 0 100 host 7\n";
    let text = format!("{FLASER}{broken}{nan}FLASER 900 1 2 3\n\u{0}\u{1}\n{FLASER}");
    let (frames, notes) = read(text).unwrap();
    assert_eq!((frames.len(), notes.broken), (2, 4));
    let sentences = notes.sentences("x.clf");
    assert_eq!(
        sentences,
        [
            "x.clf: 4 lines were skipped; the first is line 2: number 3 of the readings must be a number, not ‘x’"
        ]
    );
}

#[test]
fn a_truncated_last_line_is_no_broken_line() {
    let text = format!("{FLASER}FLASER 4 1 2 3");
    let (frames, notes) = read(text).unwrap();
    assert_eq!((frames.len(), notes.broken), (1, 0));
    let [sentence] = &notes.sentences("x.clf")[..] else {
        panic!()
    };
    assert_eq!(
        sentence,
        "x.clf: the last line, 2, is incomplete and was skipped: expected 4 readings, found 3"
    );
}

#[test]
fn the_vertices_of_a_graph_with_scans_are_its_odometry() {
    let scan = |stamp: u32| {
        format!("ROBOTLASER1 0 -1.5 3 1 12 0.1 0 4 1 2 3 4 0 0 0 0 0 0 0 0 0 0 0 0 {stamp} h 0\n")
    };
    let text = format!(
        "VERTEX2 0 1 2 0.5\n{}VERTEX2 1 2 2 0.5\n{}EDGE2 0 1 1 0 0 1 0 1 1 0 0\n",
        scan(1),
        scan(2)
    );
    let (frames, notes) = read(text).unwrap();
    let poses: Vec<Option<SE2>> = frames.iter().map(|frame| frame.odometry).collect();
    assert_eq!(
        poses,
        [Some(SE2::new(1.0, 2.0, 0.5)), Some(SE2::new(2.0, 2.0, 0.5))]
    );
    assert_eq!((notes.records["EDGE2"], notes.about.len()), (1, 1));
}

#[test]
fn what_holds_no_scan_is_rejected_in_one_sentence() {
    for (text, expected) in [
        ("", "x.clf is empty; use a recorded log"),
        (
            "Dear reader,\nthis is no log.\n",
            "x.clf is not a CARMEN log; use one with lines that start with FLASER, ROBOTLASER1 or RAWLASER1. Its first line is ‘Dear reader,’; if it is a table, name its columns with --columns, such as time_s,ranges_m@-90:90 or angle_deg,range_mm",
        ),
        (
            "ODOM 0 0 0 0 0 0 1 h 1\n",
            "x.clf has no usable scan: no line starts with FLASER, ROBOTLASER1 or RAWLASER1; record the laser as well",
        ),
        (
            "PARAM a 1 1 h 1\nFLASER 2 1 2 nan 0 0 0 0 0 1 h 1\n",
            "x.clf has no usable scan: line 2: laser_x must be a finite number, not ‘nan’",
        ),
        (
            "FLASER 2 1",
            "x.clf has no usable scan: line 1: expected 2 readings, found 1",
        ),
        (
            "FLASER 1 1.5 0 0 0 0 0 0 1 h 1\n",
            "x.clf has no usable scan: line 1: a scan must have at least two readings",
        ),
        (
            "FLASER 2 1 2 0 0 0 1e300 0 0 1 h 1\n",
            "x.clf has no usable scan: line 1: a pose must be within 41000 km of its origin, and is at 1e300 m, 0e0 m",
        ),
    ] {
        let error = read(text).unwrap_err().to_string();
        assert_eq!(error, expected, "{text:?}");
    }
    let noise: Vec<u8> = (0..100_000_u32)
        .map(|k| (k.wrapping_mul(k) % 251) as u8)
        .collect();
    let error = read(noise).unwrap_err().to_string();
    assert!(error.starts_with("x.clf is not a CARMEN log"), "{error}");
}

/// Bytes that cannot be read, as behind the end of a packed file that is cut off.
struct CutOff;

impl std::io::Read for CutOff {
    fn read(&mut self, _: &mut [u8]) -> std::io::Result<usize> {
        Err(std::io::Error::other("incomplete deflate stream"))
    }
}

#[test]
fn bytes_that_cannot_be_read_end_the_log_with_an_error() {
    use std::io::{BufReader, Read as _};

    let line = "FLASER 2 1.0 1.0 0 0 0 0 0 0 1.0 host 1.0\n";
    let mut reader = CarmenReader::new(BufReader::new(line.as_bytes().chain(CutOff)), "x.log.gz");
    assert!(reader.next_frame().unwrap().is_some());
    let problem = reader.next_frame().unwrap_err().to_string();
    assert!(
        problem.starts_with("x.log.gz: line 2: incomplete deflate stream; the rest"),
        "{problem}"
    );
}

#[test]
fn a_line_with_other_readings_than_it_states_says_so() {
    let line = "ROBOTLASER1 0 -1.5 3.0 1.0 10 0.01 0 4 1.0 1.0 1.0 0 0.5 0.5 0.1 0.5 0.5 0.1 0 0 0 0 0 1.0 host 1.0\n";
    let mut reader = CarmenReader::new(line.as_bytes(), "x.log");
    let problem = reader.next_frame().unwrap_err().to_string();
    assert!(
        problem.contains("fewer or more than the 4 readings that it states"),
        "{problem}"
    );
}
