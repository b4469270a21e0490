//! A path through a room, for tests of the back end.

use nalgebra::Vector3;
use pr_geom::SE2;

use super::SlamConfig;
use crate::config::LocalMapConfig;
use crate::scan::{Frame, LaserScan};

/// Around a circle in a room of 8 m × 6 m, in steps of 9 cm; 105 of them are a lap.
pub fn truth(step: usize) -> SE2 {
    let twist = Vector3::new(1.5, 0.0, 1.0) * 0.06;
    SE2::new(4.0, 1.5, 0.0) * SE2::exp(&(twist * step as f64))
}

/// The measurements after this many steps; the odometry overestimates each turn a little.
pub fn frame(step: usize) -> Frame {
    let (pose, last) = (truth(step), truth(step.saturating_sub(1)));
    let mut scan = LaserScan {
        angle_step_rad: 1_f64.to_radians(),
        range_max_m: 12.0,
        ..LaserScan::default()
    };
    let bearings = (0..360).map(|beam| scan.bearing_rad(beam));
    scan.ranges_m = bearings
        .map(|bearing| {
            let (sin, cos) = pr_geom::math::sin_cos(pose.theta() + bearing);
            let to_wall =
                |at: f64, step: f64, size: f64| (size * f64::from(step > 0.0) - at) / step;
            to_wall(pose.x(), cos, 8.0).min(to_wall(pose.y(), sin, 6.0))
        })
        .collect();
    Frame {
        stamp_s: 0.25 * step as f64,
        odometry: (step > 0).then(|| last.between(&pose) * SE2::new(0.0, 0.0, 0.005)),
        scan,
    }
}

/// Odometry and points that are hardly informative: the windows of loops are wide, so every loop needs confirmation.
pub fn doubting() -> SlamConfig {
    let mut robot = LocalMapConfig::for_scan(&frame(0).scan);
    robot.point_sigma_m = 1.0;
    robot.odometry.per_metre = 0.5;
    robot.loops.min_path_m = 4.0;
    SlamConfig::from_local_map(robot)
}
