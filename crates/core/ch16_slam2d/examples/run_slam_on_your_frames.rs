//! SLAM on custom frames: from a log, a robot, or the simulated room of this example.
//!
//! `cargo run -p ch16_slam2d --example run_slam_on_your_frames`

use ch16_slam2d::pipeline::{LogFrame, Pipeline};
use ch16_slam2d::prelude::*;
use ch16_slam2d::scan::{FrameError, LaserScan};

/// The true path: a circle in an empty room of 8 m × 6 m.
pub fn truth(step: usize) -> SE2 {
    SE2::new(4.0, 1.5, 0.0) * SE2::exp(&(Vector3::new(1.5, 0.0, 1.0) * 0.06 * step as f64))
}

/// Odometry from the start, which overestimates each turn a little.
pub fn odometry(step: usize) -> SE2 {
    let motion = truth(0).between(&truth(1)) * SE2::new(0.0, 0.0, 0.01);
    (0..step).fold(SE2::identity(), |pose, _| pose * motion)
}

/// The log entry of the scan after `step` steps.
pub fn frame(step: usize) -> LogFrame {
    let mut scan = LaserScan {
        angle_step_rad: 1_f64.to_radians(),
        range_max_m: 12.0,
        ..LaserScan::default()
    };
    let bearings = (0..360).map(|beam| scan.bearing_rad(beam));
    scan.ranges_m = bearings.map(|b| range_m(&truth(step), b)).collect();
    LogFrame {
        stamp_s: 0.25 * step as f64,
        odometry: Some(odometry(step)),
        scan,
    }
}

fn range_m(pose: &SE2, bearing_rad: f64) -> f64 {
    let (sin, cos) = (pose.theta() + bearing_rad).sin_cos();
    let to_wall = |at: f64, step: f64, size: f64| (size * f64::from(step > 0.0) - at) / step;
    to_wall(pose.x(), cos, 8.0).min(to_wall(pose.y(), sin, 6.0))
}

/// Runs all frames and returns the pipeline with its map, in the frame of the robot's start.
pub fn run() -> Result<Pipeline, FrameError> {
    let mut pipeline = Pipeline::default();
    for step in 0..=120 {
        pipeline.step(&frame(step))?;
    }
    pipeline.finish();
    Ok(pipeline)
}

/// Prints the poses of the scans.
pub fn main() {
    for (stamp_s, pose) in run().expect("frames in order").trajectory() {
        println!("at {stamp_s} s: {:.3?}", pose.to_array());
    }
}
