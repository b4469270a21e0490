//! The sample: the simulator's ring, twice around, as a log of CARMEN, and the truth of it.

use ch16_lab::lap::{Drive, DriveConfig};
use pr_geom::SE2;
use pr_sim::Course;
use robot_io::carmen::write_carmen;
use robot_io::log::LogFrame;
use robot_io::trajectory::{StampedPose, Trajectory};

/// Its noise: wheels twice as bad as the chapter's.
const NOISE_FACTOR: f64 = 2.0;

fn drive() -> Drive {
    let config = DriveConfig {
        noise_factor: NOISE_FACTOR,
        ..DriveConfig::default()
    };
    Drive::simulate(&config.on_course(&Course::ring()))
}

/// To the millimetre, as a sensor tells it.
fn rounded(value: f64, digits: i32) -> f64 {
    let scale = f64::from(10_i32.pow(digits.unsigned_abs()));
    (value * scale).round() / scale
}

/// The log, and the true trajectory as TUM lines.
#[must_use]
pub fn ring() -> (Vec<u8>, Vec<u8>) {
    let drive = drive();
    let (mut log, mut truth) = (Vec::new(), Vec::new());
    let mut wheels = SE2::identity();
    for tick in 0..=drive.ticks().len() {
        let frame = drive.frame(tick);
        wheels = wheels * frame.odometry.unwrap_or(SE2::identity());
        let [x, y, theta] = wheels.to_array().map(|value| rounded(value, 5));
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
        truth.push(StampedPose {
            stamp_s: frame.stamp_s,
            pose: drive.truth(tick),
        });
    }
    let mut lines = Vec::new();
    let written = Trajectory::new(truth).write_tum(&mut lines);
    written.expect("memory takes text");
    (log, lines)
}
