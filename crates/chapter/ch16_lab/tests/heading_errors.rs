//! A heading error that no scan shows: the scans of a stretch are missing, and the odometry turns by 20° there.

use ch16_lab::buildings::{BuildingRun, Kind, Recording, recorded};
use ch16_slam2d::metrics::position_error_m;
use pr_geom::SE2;

/// The recording without the scans of `gap_m` after a share of its frames, where the odometry turns once by 20°.
fn turned(recording: &Recording, share: f64, gap_m: f64) -> Recording {
    let mut frames = recording.frames.clone();
    let first = (share * frames.len() as f64) as usize;
    let pivot = frames[first].odometry;
    let turn = pivot * SE2::new(0.0, 0.0, 20_f64.to_radians()) * pivot.inverse();
    let (mut path_m, mut last) = (0.0, pivot);
    let mut end = first + 1;
    while path_m < gap_m {
        path_m += position_error_m(&last, &frames[end].odometry);
        last = frames[end].odometry;
        end += 1;
    }
    frames.drain(first + 1..end - 1);
    for frame in &mut frames[first + 1..] {
        frame.odometry = turn * frame.odometry;
    }
    Recording { frames }
}

#[test]
fn loops_correct_a_heading_error_of_20_degrees_over_a_gap() {
    // Without the sideways error of a heading, the hallway ends 1 m off; with poses far from the
    // odometry that half of the scan does not support, the circle turns by 90° and ends 32 m off.
    for (kind, seed, gap_m) in [(Kind::Hallway, 402, 3.0), (Kind::Circle, 401, 6.0)] {
        let (recording, robot) = recorded(kind, seed);
        let trial = BuildingRun::run(&turned(&recording, 0.2, gap_m), robot, true);
        assert!(trial.worst_m < 0.3, "{kind:?} {seed}: {} m", trial.worst_m);
    }
}
