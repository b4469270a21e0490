use std::f64::consts::TAU;
use std::io::Cursor as Bytes;

use ch16_slam2d::cloud::PointCloud;
use ch16_slam2d::local_map::LocalMapConfig;
use ch16_slam2d::pipeline::ScanPose;
use ch16_slam2d::scan::LaserScan;
use pr_geom::{Point2, SE2, Vector3, math};

use super::*;
use crate::log::LogFrame;
use crate::run::LogRun;
use crate::settings::{SETTINGS, Setting};

/// A room of 8 m × 6 m seen from a circle in it; odometry overestimates each turn slightly.
fn frame(step: usize, beams: usize) -> LogFrame {
    let way = |scale: f64| SE2::exp(&(Vector3::new(1.5, 0.0, scale) * (0.06 * step as f64)));
    let pose = SE2::new(4.0, 1.5, 0.0) * way(1.0);
    let mut scan = LaserScan {
        first_angle_rad: -TAU / 2.0,
        angle_step_rad: TAU / beams as f64,
        range_max_m: 12.0,
        ..LaserScan::default()
    };
    let range_m = |beam: usize| {
        let (sin, cos) = math::sin_cos(pose.theta() + scan.bearing_rad(beam));
        let to_wall = |at: f64, step: f64, size: f64| (size * f64::from(step > 0.0) - at) / step;
        to_wall(pose.x(), cos, 8.0).min(to_wall(pose.y(), sin, 6.0))
    };
    scan.ranges_m = (0..beams).map(range_m).collect();
    LogFrame {
        stamp_s: 100.0 + 0.25 * step as f64,
        odometry: Some(way(1.01)),
        scan,
    }
}

fn run(beams: usize, steps: core::ops::Range<usize>) -> LogRun {
    let mut run = LogRun::default();
    go_on(&mut run, beams, steps);
    run
}

fn go_on(run: &mut LogRun, beams: usize, steps: core::ops::Range<usize>) {
    for step in steps {
        run.step(frame(step, beams)).unwrap();
    }
}

fn saved(run: &LogRun) -> Vec<u8> {
    run.session().unwrap().to_bytes()
}

#[test]
fn what_is_saved_loads_to_the_same_and_is_saved_to_the_same_bytes() {
    for beams in [120, 360, 1440] {
        let mut run = run(beams, 0..120);
        for is_finished in [false, true] {
            if is_finished {
                run.finish();
            }
            let session = run.session().unwrap();
            assert_eq!(session.mapped.is_some(), is_finished);
            let bytes = session.to_bytes();
            let mut loaded = Session::read(Bytes::new(&bytes), "x").unwrap();
            assert!(loaded.to_bytes() == bytes, "{beams} beams");
            // Scans of more than 131 points are stored with fewer bits; everything else is exact.
            if beams > 120 {
                let pairs = loaded.snapshot.keyframes.iter_mut();
                for (a, b) in pairs.zip(&session.snapshot.keyframes) {
                    a.scan = b.scan.clone();
                }
            }
            assert!(loaded == session, "{beams} beams");
        }
    }
}

#[test]
fn a_continued_run_equals_an_uninterrupted_one_bit_by_bit() {
    let mut whole = run(120, 0..150);
    let half = saved(&run(120, 0..80));
    let session = Session::from_bytes(&half, "x").unwrap();
    let mut second = LogRun::resume(&session).unwrap();
    go_on(&mut second, 120, 80..150);
    assert_eq!(saved(&second), saved(&whole));
    // The same holds after both have ended, and when they continue.
    whole.finish();
    second.finish();
    assert_eq!(saved(&second), saved(&whole));
    let session = Session::from_bytes(&saved(&whole), "x").unwrap();
    let mut third = LogRun::resume(&session).unwrap();
    go_on(&mut third, 120, 150..170);
    assert_eq!(saved(&third), saved(&run(120, 0..170)));
}

#[test]
fn a_log_of_another_scanner_is_reported() {
    let session = run(120, 0..80).session().unwrap();
    for (beams, count) in [(120, 0), (90, 1)] {
        let mut second = LogRun::resume(&session).unwrap();
        go_on(&mut second, beams, 80..90);
        let sentences = second.sentences("log");
        assert_eq!(sentences.len(), count, "{sentences:?}");
        let is_said = |expected: &String| expected.contains("a step of 4.00°");
        assert!(sentences.iter().all(is_said), "{sentences:?}");
    }
}

#[test]
fn pending_loops_are_saved_and_stay_pending() {
    // Odometry and points that are hardly informative: windows are wide, and every loop waits for confirmation.
    let settings = [
        ("point_sigma_m", 1.0),
        ("odometry.per_metre", 0.5),
        ("loops.min_path_m", 4.0),
    ];
    let settings = settings.map(|(name, value)| (Setting::named(name).unwrap(), value));
    let doubting = |steps: core::ops::Range<usize>| {
        let new = LogRun::default();
        let settings = settings.iter();
        let mut run = settings.fold(new, |run, (setting, value)| {
            run.with_setting(setting, *value).unwrap()
        });
        go_on(&mut run, 120, steps);
        run
    };
    let (half, mut whole) = (doubting(0..125), doubting(0..140));
    let session = Session::from_bytes(&saved(&half), "x").unwrap();
    assert!(!session.snapshot.pending.is_empty());
    assert_eq!(session, half.session().unwrap());
    let mut second = LogRun::resume(&session).unwrap();
    go_on(&mut second, 120, 125..140);
    assert_eq!(saved(&second), saved(&whole));
    // At the end, pending loops are accepted or dropped in the same way.
    whole.finish();
    second.finish();
    assert_eq!(saved(&second), saved(&whole));
    let closed = |run: &LogRun| run.loops().iter().filter(|tried| tried.accepted).count();
    assert_eq!(closed(&second), closed(&whole));
}

#[test]
fn a_keyframe_takes_three_kilobytes_at_most_whatever_the_sensor() {
    for beams in [180, 720, 2880] {
        let mut run = run(beams, 0..200);
        run.finish();
        let session = run.session().unwrap();
        let scans_m = session.snapshot.keyframes.iter().map(|k| k.scan.len());
        let (points, keyframes) = (scans_m.max().unwrap(), session.snapshot.keyframes.len());
        // The window is stored exactly, whatever the map's size.
        let mut without_window = session.clone();
        without_window.snapshot.front_end.scans.clear();
        let fixed = without_window.to_bytes();
        assert!(session.snapshot.front_end.scans.len() <= 16);
        assert!(session.scan_poses.len() <= 8 * keyframes + 40);
        let each = fixed.len() / keyframes;
        assert!(each <= 3000, "{beams} beams, {points} points: {each} bytes");
        let loaded = Session::from_bytes(&session.to_bytes(), "x").unwrap();
        for (stored, seen) in loaded
            .snapshot
            .keyframes
            .iter()
            .zip(&session.snapshot.keyframes)
        {
            if beams < 2880 {
                assert_eq!(stored.scan.len(), seen.scan.len());
            }
            // More points than fit are downsampled, but not too much.
            assert!(stored.scan.len() > 2 * seen.scan.len() / 3);
            if stored.scan.len() == seen.scan.len() {
                for (a, b) in stored.scan.iter().zip(seen.scan.iter()) {
                    // Half a step of 16-bit coordinates within 8 m.
                    assert!((a - b).abs().max() <= 0.5 / 2048.0);
                }
            }
        }
    }
}

#[test]
fn scans_of_another_make_keep_their_normals_and_crowded_ones_are_thinned() {
    let radius_m = 0.5;
    let spiral = |count: usize| -> PointCloud {
        let mut cloud = PointCloud::new(Vec::new(), 3.5);
        for k in 0..count {
            let (sin, cos) = math::sin_cos(k as f64);
            let at = 1.0 + 30.0 * k as f64 / count as f64;
            let normal = (k % 7 != 0).then(|| nalgebra::Vector2::new(sin, cos));
            cloud.push_with_normal(Point2::new(at * cos, at * sin), normal);
        }
        cloud
    };
    for (count, exact) in [
        (60, true),
        (200, false),
        (340, false),
        (5000, false),
        (0, true),
    ] {
        let scan = spiral(count);
        let stored = |scan: &PointCloud| {
            let scans = scans::store_all([scan].into_iter(), radius_m, body::SCAN_BYTES);
            postcard::to_stdvec(&scans[0]).unwrap()
        };
        let first = stored(&scan);
        assert!(first.len() <= body::SCAN_BYTES);
        let back: scans::StoredScan = postcard::from_bytes(&first).unwrap();
        let back = back.restored(radius_m).unwrap();
        assert_eq!(back == scan, exact, "{count} points");
        assert_eq!(back.len() == count, count <= 340);
        assert_eq!(stored(&back), first, "{count} points");
    }
}

#[test]
fn a_session_with_other_parameters_is_rejected_by_their_name() {
    let bytes = saved(&run(120, 0..20));
    for (from, to, expected) in [
        (
            "\"point_sigma_m\"",
            "\"point_sigma_k\"",
            "missing field `point_sigma_m`",
        ),
        (
            "\"keyframe_distance_m\":0.65",
            "\"keyframe_distance_m\":-0.1",
            "keyframe_distance_m must be positive and at most 1000000, not -0.1",
        ),
    ] {
        let mut other = bytes.clone();
        let mut places = bytes.windows(from.len());
        let at = places.position(|place| place == from.as_bytes()).unwrap();
        other[at..at + to.len()].copy_from_slice(to.as_bytes());
        let error = Session::from_bytes(&signed(other), "x")
            .unwrap_err()
            .to_string();
        assert!(error.contains(expected), "{error}");
    }
}

#[test]
fn every_byte_counts_and_so_does_every_length() {
    let bytes = saved(&run(40, 0..12));
    assert!(bytes.len() < 20_000, "{}", bytes.len());
    for at in 0..bytes.len() {
        let mut damaged = bytes.clone();
        damaged[at] ^= 1 << (at % 8);
        let error = Session::from_bytes(&damaged, "x").unwrap_err().to_string();
        assert!(is_a_sentence(&error), "{at}: {error}");
        let error = Session::from_bytes(&bytes[..at], "x")
            .unwrap_err()
            .to_string();
        assert!(is_a_sentence(&error), "{at}: {error}");
    }
}

fn is_a_sentence(error: &str) -> bool {
    error.lines().count() == 1
        && error.starts_with('x')
        && (error.contains("again") || error.contains("give ") || error.contains("use the program"))
}

/// Recomputes the checksum.
fn signed(mut bytes: Vec<u8>) -> Vec<u8> {
    let end = bytes.len() - TAIL_BYTES;
    let sum = checksum(&bytes[..end]);
    bytes[end..].copy_from_slice(&sum.to_le_bytes());
    bytes
}

#[test]
fn forged_bytes_give_an_error_or_a_usable_session() {
    let bytes = saved(&run(40, 0..12));
    let mut accepted = 0;
    for at in (HEAD_BYTES..bytes.len() - TAIL_BYTES).step_by(3) {
        for value in [0x00, 0x7f, 0xff] {
            let mut forged = bytes.clone();
            forged[at] = value;
            match Session::from_bytes(&signed(forged), "x") {
                Err(error) => assert!(is_a_sentence(&error.to_string()), "{at}: {error}"),
                Ok(session) => {
                    accepted += 1;
                    let resumed = LogRun::resume(&session);
                    assert!(resumed.is_ok(), "{at} {value}: {:?}", resumed.err());
                }
            }
        }
    }
    assert!(accepted > 0);
}

#[test]
fn a_map_may_have_lost_every_loop_that_was_driven() {
    let mut run = run(120, 0..200);
    run.finish();
    let mut session = run.session().unwrap();
    let mapped = session.mapped.as_mut().unwrap();
    mapped.loops.clear();
    session.snapshot.optimized_edges = session.snapshot.edges.len();
    let read = Session::from_bytes(&session.to_bytes(), "x").unwrap();
    assert_eq!(read, session);
    assert_eq!(read.graph().optimized_edges(), read.graph().edge_count());
}

#[test]
fn impossible_states_are_rejected() {
    let good = run(40, 0..12).session().unwrap();
    let rejected = |change: &dyn Fn(&mut Session), expected: &str| {
        let mut session = good.clone();
        change(&mut session);
        let error = Session::from_bytes(&session.to_bytes(), "x").unwrap_err();
        assert!(error.to_string().contains(expected), "{error}");
    };
    let far = SE2::new(1e60, 0.0, 0.0);
    rejected(&|x| x.snapshot.nodes[0].pose = far, "within ±1e50");
    rejected(
        &|x| x.snapshot.edges[0].edge.information *= 1e60,
        "within ±1e50",
    );
    rejected(
        &|x| x.snapshot.last_stamp_s = 0.0,
        "keyframes are not in order",
    );
    rejected(&|x| x.snapshot.keyframes[1].stamp_s = 0.0, "not in order");
    let last_s = good.snapshot.last_stamp_s;
    rejected(
        &|x| x.scan_poses.last_mut().unwrap().stamp_s = last_s + 1.0,
        "poses of scans are not in order",
    );
    rejected(
        &|x| x.scan_poses[0].keyframe = 1,
        "poses of scans are not in order",
    );
}

#[test]
fn foreign_files_are_distinguished_from_damaged_sessions() {
    let bytes = saved(&run(40, 0..3));
    let mut newer = bytes.clone();
    newer[8] = 7;
    let mut older = bytes.clone();
    older[8] = 1;
    let mut longer = bytes.clone();
    longer.push(0);
    for (file, expected) in [
        (&b""[..], "x is empty; give a session"),
        (b"FLASER 180", "x is not a session"),
        (b"SLAM2D\r\n", "x ends at byte 8 of 20"),
        (
            &newer,
            "x is a session of version 7, but this program reads version 5",
        ),
        (
            &older,
            "x is a session of version 1, but this program reads version 5",
        ),
        (&longer, "x continues after its end at byte"),
    ] {
        let error = Session::from_bytes(file, "x").unwrap_err().to_string();
        assert!(error.starts_with(expected), "{error}");
    }
}

#[test]
fn every_parameter_is_written_and_read() {
    for setting in SETTINGS {
        let value = setting.value(&LocalMapConfig::default()) + 1.0;
        let mut run = LogRun::default().with_setting(setting, value).unwrap();
        // Few enough points to be stored exactly.
        run.step(frame(0, 120)).unwrap();
        let session = Session::from_bytes(&saved(&run), "x").unwrap();
        let robot = session.snapshot.config.local_map.unwrap();
        assert_eq!(setting.value(&robot), value, "{}", setting.name);
        assert!(session == run.session().unwrap(), "{}", setting.name);
    }
}

#[test]
fn rays_to_a_thinned_wall_end_on_it_and_leave_gaps_open() {
    let wall = (-20..=20).map(|k| Point2::new(2.0, 0.06 * f64::from(k)));
    let behind = [Point2::new(-3.0, 0.0)];
    let scan: PointCloud = wall.chain(behind).collect();
    let sensor = LaserScan {
        angle_step_rad: 0.5_f64.to_radians(),
        ..LaserScan::default()
    };
    let seen = rays(&scan, &sensor, 0.06);
    let mut met = 0;
    for (ray, &range_m) in seen.ranges_m.iter().enumerate() {
        let (sin, cos) = math::sin_cos(seen.bearing_rad(ray));
        if range_m.is_nan() {
            assert!(sin.abs() > 0.45 || cos < 0.0, "{ray}");
        } else if cos > 0.0 {
            met += 1;
            // 0.02: the nearest ray to a point at the wall's end is a quarter degree off.
            assert!((range_m * cos - 2.0).abs() < 0.02, "{ray}");
        }
    }
    assert!(met > 110, "{met}");
}

#[test]
fn a_waiting_robot_does_not_fill_the_file_with_scan_poses() {
    let scan_pose = |number: usize, keyframe: usize| ScanPose {
        stamp_s: number as f64,
        keyframe,
        keyframe_from_body: SE2::identity(),
    };
    let keyframe = |number: usize| match number {
        0..100 => 0,
        100..105 => 1,
        _ => 2,
    };
    let scans: Vec<ScanPose> = (0..150).map(|k| scan_pose(k, keyframe(k))).collect();
    let kept = selected_scan_poses(&scans);
    // Eight of the first keyframe, all of the second, and all of the last, which may get more.
    assert_eq!(kept.len(), 8 + 5 + 45);
    assert_eq!((kept[0], kept[7].stamp_s), (scans[0], 87.0));
    assert_eq!(selected_scan_poses(&kept), kept);
}

#[test]
fn a_session_that_is_reopened_is_saved_as_it_was_even_if_it_is_ended_again() {
    let session = run(120, 0..60).session().unwrap();
    let mut reopened = LogRun::reopen(&session).unwrap();
    let before = reopened.session().unwrap();
    reopened.finish();
    assert_eq!(reopened.session().unwrap(), before);
    assert_eq!(before.snapshot, session.snapshot);
}
