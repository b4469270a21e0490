//! Where the wheels alone would put the robot: the odometry, laid on the map by the first keyframe that has any.

use pr_geom::SE2;
use pr_geom::math;

use super::log_state::LogState;

fn pose([x, y, theta]: [f64; 3]) -> SE2 {
    SE2::new(x, y, theta)
}

/// The pose by odometry alone at each keyframe, in the map's frame; `None` where there is no odometry.
pub fn poses(robot: &LogState) -> Vec<Option<SE2>> {
    let known = |odometry: &[f64; 3]| odometry.iter().all(|value| value.is_finite());
    let mut map_from_odometry = None;
    let keyframes = robot.keyframes.iter();
    let poses = keyframes.map(|keyframe| {
        let odometry = Some(keyframe.odometry).filter(known).map(pose)?;
        let map_from_odometry =
            *map_from_odometry.get_or_insert_with(|| pose(keyframe.pose) * odometry.inverse());
        Some(map_from_odometry * odometry)
    });
    poses.collect()
}

/// Distance of the pose by odometry alone from that of its keyframe, m; `None` without odometry.
pub fn off_m(robot: &LogState, by_wheels: &[Option<SE2>], keyframe: usize) -> Option<f64> {
    let [x, y, _] = robot.keyframes.get(keyframe)?.pose;
    let wheels = by_wheels.get(keyframe)?.as_ref()?;
    Some(math::norm2(wheels.x() - x, wheels.y() - y))
}

/// Distance between the ends of the two paths, m; `None` without odometry.
pub fn end_m(robot: &LogState) -> Option<f64> {
    off_m(robot, &poses(robot), robot.keyframes.len().checked_sub(1)?)
}
