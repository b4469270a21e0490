//! Sample logs: two rounds of the simulator's ring as a CARMEN log with its true trajectory; and a log of another
//! day in the ring that starts half way.

use core::ops::RangeInclusive;

use ch16_lab::lap::{Drive, DriveConfig};
use pr_geom::SE2;
use pr_sim::Course;
use robot_io::carmen::write_carmen;
use robot_io::log::LogFrame;
use robot_io::trajectory::{StampedPose, Trajectory};

/// Noise factor: twice the chapter's odometry noise.
const NOISE_FACTOR: f64 = 2.0;

/// Seed of the other day.
const OTHER_SEED: u32 = 11;
/// Part of the path that is in the log of the other day.
const OTHER_PART: [f64; 2] = [0.55, 0.85];

fn drive(config: &DriveConfig) -> Drive {
    let config = DriveConfig {
        noise_factor: NOISE_FACTOR,
        ..config.clone()
    };
    Drive::simulate(&config.on_course(&Course::ring()))
}

/// Rounds to the resolution of a sensor.
fn rounded(value: f64, digits: i32) -> f64 {
    let scale = f64::from(10_i32.pow(digits.unsigned_abs()));
    (value * scale).round() / scale
}

/// The log, and the true trajectory as TUM lines.
#[must_use]
pub fn ring() -> (Vec<u8>, Vec<u8>) {
    let drive = drive(&DriveConfig::default());
    let all = drive.ticks().len();
    let truth = (0..=all).map(|tick| StampedPose {
        stamp_s: drive.frame(tick).stamp_s,
        pose: drive.truth(tick),
    });
    let mut lines = Vec::new();
    let written = Trajectory::new(truth.collect()).write_tum(&mut lines);
    written.expect("memory takes text");
    (log_of(&drive, 0..=all), lines)
}

/// The log of another day.
#[must_use]
pub fn another_day() -> Vec<u8> {
    let drive = drive(&DriveConfig {
        seed: OTHER_SEED,
        ..DriveConfig::default()
    });
    let all = drive.ticks().len();
    let [first, last] = OTHER_PART.map(|share| (share * all as f64) as usize);
    log_of(&drive, first..=last)
}

/// CARMEN lines; odometry starts at zero where the log starts.
fn log_of(drive: &Drive, ticks: RangeInclusive<usize>) -> Vec<u8> {
    let mut log = Vec::new();
    let mut odometry = SE2::identity();
    let first = *ticks.start();
    for tick in ticks {
        let frame = drive.frame(tick);
        if tick > first {
            odometry = odometry * frame.odometry.unwrap_or(SE2::identity());
        }
        let [x, y, theta] = odometry.to_array().map(|value| rounded(value, 5));
        let mut scan = frame.scan;
        for range_m in &mut scan.ranges_m {
            *range_m = rounded(*range_m, 3);
        }
        let written = write_carmen(
            &LogFrame {
                stamp_s: frame.stamp_s,
                odometry: Some(SE2::new(x, y, theta)),
                scan,
            },
            &mut log,
        );
        written.expect("memory takes text");
    }
    log
}
