//! One estimator for all sensors: few beams or many, short range or long, any mounting.

use ch16_lab::lap::{Drive, DriveConfig};
use ch16_slam2d::metrics::position_error_m;
use ch16_slam2d::scan::Frame;
use ch16_slam2d::slam::{Slam, SlamConfig};
use pr_geom::SE2;
use pr_sim::LidarConfig;

fn drive(lidar: LidarConfig) -> Drive {
    Drive::simulate(&DriveConfig {
        lidar,
        ..DriveConfig::default()
    })
}

/// Largest error of the estimate over the lap, m.
fn farthest_m(drive: &Drive, config: SlamConfig, frame: impl Fn(usize) -> Frame) -> f64 {
    let mut slam = Slam::new(config);
    let mut farthest: f64 = 0.0;
    for tick in 0..=drive.ticks().len() {
        let report = slam.step(&frame(tick)).unwrap();
        farthest = farthest.max(position_error_m(&report.estimate, &drive.truth(tick)));
    }
    farthest
}

/// Largest error of dead reckoning, m: the estimate has to be better.
fn dead_reckoning_m(drive: &Drive) -> f64 {
    let ticks = drive.ticks().iter();
    let errors = ticks.map(|tick| position_error_m(&tick.dead_reckoning, &tick.truth));
    errors.fold(0.0, f64::max)
}

/// The configuration that follows from a scan, with the map frame of the drive.
fn of_scan(drive: &Drive) -> SlamConfig {
    SlamConfig {
        start: drive.truth(0),
        ..SlamConfig::for_robot(&drive.frame(0).scan)
    }
}

#[test]
fn the_lap_is_tracked_from_40_to_4000_beams() {
    for (beams, range_sigma_m) in [(40, 0.03), (360, 0.03), (4000, 0.01)] {
        let drive = drive(LidarConfig {
            beams,
            range_sigma_m,
            max_range_m: 12.0,
            ..LidarConfig::default()
        });
        let farthest = farthest_m(&drive, of_scan(&drive), |tick| drive.frame(tick));
        assert!(
            farthest < 0.7 * dead_reckoning_m(&drive),
            "{beams} beams: {farthest} m"
        );
    }
}

#[test]
fn a_body_is_tracked_wherever_its_sensor_is_mounted() {
    let drive = drive(LidarConfig::default());
    for (x, y, theta) in [(0.2, -0.1, 3.0), (-0.4, 0.3, 1.57), (0.0, 0.0, -0.7)] {
        let body_from_sensor = SE2::new(x, y, theta);
        // Pose of the body that carries the sensor, from the pose of the sensor.
        let body = |sensor: SE2| sensor * body_from_sensor.inverse();
        let mut slam = Slam::new(SlamConfig {
            start: body(drive.truth(0)),
            ..of_scan(&drive)
        });
        let mut farthest: f64 = 0.0;
        for tick in 0..=drive.ticks().len() {
            let mut frame = drive.frame(tick);
            frame.scan.body_from_sensor = body_from_sensor;
            frame.odometry = frame
                .odometry
                .map(|motion| body_from_sensor * motion * body_from_sensor.inverse());
            let estimate = slam.step(&frame).unwrap().estimate;
            farthest = farthest.max(position_error_m(&estimate, &body(drive.truth(tick))));
        }
        assert!(
            farthest < 0.7 * dead_reckoning_m(&drive),
            "{theta}: {farthest} m"
        );
    }
}

#[test]
fn a_sensor_mounted_upside_down_is_tracked_as_well() {
    // Its beams run clockwise: the last bearing comes first, and the step is negative.
    let drive = drive(LidarConfig::default());
    let turned = |tick| {
        let mut frame = drive.frame(tick);
        let last = frame.scan.ranges_m.len() - 1;
        frame.scan.first_angle_rad = frame.scan.bearing_rad(last);
        frame.scan.angle_step_rad = -frame.scan.angle_step_rad;
        frame.scan.ranges_m.reverse();
        frame
    };
    let farthest = farthest_m(&drive, of_scan(&drive), turned);
    assert!(farthest < 0.7 * dead_reckoning_m(&drive), "{farthest} m");
}
