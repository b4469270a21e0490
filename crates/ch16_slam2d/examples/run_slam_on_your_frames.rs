//! SLAM on frames of your own: a log, a robot, or a room and a walk that are made up here.
//!
//! `cargo run -p ch16_slam2d --example run_slam_on_your_frames`

use ch16_slam2d::pipeline::{LogFrame, Pipeline};
use ch16_slam2d::prelude::*;
use ch16_slam2d::scan::{Frame, FrameError, LaserScan};

/// The walk: around a circle in an empty room of 8 m × 6 m.
pub fn truth(step: usize) -> SE2 {
    SE2::new(4.0, 1.5, 0.0) * SE2::exp(&(Vector3::new(1.5, 0.0, 1.0) * 0.06 * step as f64))
}

/// What the robot measures after `step` steps: its wheels claim a little too much of each turn.
pub fn frame(step: usize) -> Frame {
    let (pose, last) = (truth(step), truth(step.saturating_sub(1)));
    let mut scan = LaserScan {
        angle_step_rad: 1_f64.to_radians(),
        range_max_m: 12.0,
        ..LaserScan::default()
    };
    let bearings = (0..360).map(|beam| scan.bearing_rad(beam));
    scan.ranges_m = bearings.map(|bearing| range_m(&pose, bearing)).collect();
    Frame {
        stamp_s: 0.25 * step as f64,
        odometry: (step > 0).then(|| last.between(&pose) * SE2::new(0.0, 0.0, 0.01)),
        scan,
    }
}

fn range_m(pose: &SE2, bearing_rad: f64) -> f64 {
    let (sin, cos) = (pose.theta() + bearing_rad).sin_cos();
    let to_wall = |at: f64, step: f64, size: f64| (size * f64::from(step > 0.0) - at) / step;
    to_wall(pose.x(), cos, 8.0).min(to_wall(pose.y(), sin, 6.0))
}

/// Where the wheels say that the robot is after `step` steps, in the frame of its start.
pub fn wheels(step: usize) -> SE2 {
    let motions = (1..=step).filter_map(|k| frame(k).odometry);
    motions.fold(SE2::identity(), |pose, motion| pose * motion)
}

/// Runs all frames and returns the pipeline with its map, whose frame lies where the robot started.
pub fn run() -> Result<Pipeline, FrameError> {
    let mut pipeline = Pipeline::default();
    for step in 0..=120 {
        let report = pipeline.step(&LogFrame {
            stamp_s: frame(step).stamp_s,
            odometry: Some(wheels(step)),
            scan: frame(step).scan,
        })?;
        if let Some(node) = report.new_keyframe {
            println!("keyframe {node} at {:.3?}", report.estimate.to_array());
        }
    }
    pipeline.finish();
    Ok(pipeline)
}

/// Prints the keyframes, and where the last scan was taken.
pub fn main() {
    let pipeline = run().expect("frames in the order of time, with finite numbers");
    if let Some((stamp_s, pose)) = pipeline.trajectory().last() {
        println!("at {stamp_s} s: {:.3?}", pose.to_array());
    }
}
