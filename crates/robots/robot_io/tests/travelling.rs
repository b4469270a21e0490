//! What travels with the robot is cut out of recordings, and nothing else is.
//!
//! The recordings have no licence and are not part of the project. If the folder with the reference data is absent,
//! these tests report it and pass.

use bench_support::skip::{NO_RECORDED_LOGS, skip};
use pr_geom::math;
use robot_io::log::{LogFrame, LogNotes, LogReader};
use robot_io::own_body::BodyReader;

use crate::verdicts::{FIELD, Frames, frames, given_logs, reversed, thinned};

/// What is said, and the number of returns that are cut out of the first scans.
fn said(frames: &[LogFrame]) -> (Vec<String>, usize) {
    let count = |frame: &LogFrame| {
        let ranges = frame.scan.ranges_m.iter();
        ranges
            .filter(|range_m| frame.scan.is_return(**range_m))
            .count()
    };
    let mut reader = BodyReader::new(Box::new(Frames {
        frames: frames.iter().cloned().collect(),
        notes: LogNotes::default(),
    }));
    let mut cut = 0;
    for frame in frames {
        cut += count(frame) - count(&reader.next_frame().unwrap().unwrap());
    }
    let remarks = reader.notes().warnings.iter();
    (remarks.map(|remark| remark.text.clone()).collect(), cut)
}

fn without_odometry(frames: &[LogFrame]) -> Vec<LogFrame> {
    let without = frames.iter().map(|frame| LogFrame {
        odometry: None,
        ..frame.clone()
    });
    without.collect()
}

/// The recording as a laser sees it that leans toward `direction_rad`: the floor hides what is beyond its line.
fn leaning(frames: &[LogFrame], distance_m: f64, direction_rad: f64) -> Vec<LogFrame> {
    let lean = |frame: &LogFrame| {
        let mut frame = frame.clone();
        for beam in 0..frame.scan.ranges_m.len() {
            let off = frame.scan.bearing_rad(beam) - direction_rad;
            let floor_m = distance_m / math::cos(off);
            let range_m = frame.scan.ranges_m[beam];
            let sees_floor = floor_m > 0.0 && floor_m < 30.0;
            if sees_floor && (range_m > floor_m || !frame.scan.is_return(range_m)) {
                frame.scan.ranges_m[beam] = floor_m;
            }
        }
        frame
    };
    frames.iter().map(lean).collect()
}

#[test]
fn nothing_is_cut_out_of_a_good_recording_cut_thinned_or_reversed() {
    let Some(logs) = given_logs() else {
        return skip("what travels with the robot", NO_RECORDED_LOGS);
    };
    let field = FIELD.map(|(name, _)| name.to_owned());
    for name in logs.into_iter().chain(field) {
        let all = frames(&name);
        let ways = [
            all.clone(),
            all[..all.len() / 2].to_vec(),
            all[all.len() / 2..].to_vec(),
            all.iter().step_by(2).cloned().collect(),
            all.iter().map(|frame| thinned(frame, 4)).collect(),
            reversed(&all),
            without_odometry(&all),
            without_odometry(&reversed(&all)),
        ];
        for (way, frames) in ways.iter().enumerate() {
            assert_eq!(said(frames), (vec![], 0), "{name}, way {way}");
        }
    }
}

/// The constants were chosen on a simulated drive; the recorded logs only report.
#[test]
fn the_floor_before_a_leaning_laser_is_cut_out_with_and_without_odometry() {
    for name in [
        "logs/aces.clf",
        "logs/cmu_wean1.clf.gz",
        "logs/duke-loop5.clf",
        "logs/intel.clf",
    ] {
        if given_logs().is_none() {
            return skip("the floor before a leaning laser", NO_RECORDED_LOGS);
        }
        let all = leaning(&frames(name), 3.0, 40_f64.to_radians());
        for frames in [without_odometry(&all), all] {
            let (said, cut) = said(&frames);
            let expected = "a straight line 3.00 m from the laser, toward 40°, travels";
            assert!(
                said.iter().any(|text| text.starts_with(expected)),
                "{name}: {said:?}"
            );
            assert!(cut > frames.len(), "{name}: {cut}");
        }
    }
}
