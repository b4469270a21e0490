//! Registrations by NDT in its reference scene.

use ch16_slam2d::cloud::PointCloud;
use ch16_slam2d::ndt::{NdtConfig, NdtMap, NdtResult, ndt_align};
use pr_geom::{SE2, Translation};
use pr_sim::{Lidar, LidarConfig, Rng, World};

/// A registration of `ndt.json`: its sweep, and one of its starts.
pub fn value(start: &str, what: &str) -> Option<f64> {
    let [dx, dy, turn] = match start {
        "far_start" => [0.1, -0.4, 0.15],
        _ => return None,
    };
    let pose = SE2::new(2.0, 1.9, 0.0);
    let mut lidar = Lidar::new(LidarConfig {
        beams: 180,
        max_range_m: 6.0,
        range_sigma_m: 0.01,
        ..LidarConfig::default()
    });
    let ranges = lidar.sense(&World::apartment(), &pose, &mut Rng::new(0x5C0));
    let cloud: PointCloud = lidar.project(&ranges).collect();
    let cloud = cloud.downsample(0.08);
    let map = NdtMap::build(&cloud.transformed(&pose), 0.5, 4);
    let init = SE2::new(pose.x() + dx, pose.y() + dy, pose.theta() + turn);
    let NdtResult { pose: found, .. } = ndt_align(&cloud, &map, init, &NdtConfig::default());
    let distance_m = |to: &SE2| (to.translation() - pose.translation()).norm();
    match what {
        "offset_m" => Some(distance_m(&init)),
        "error_m" => Some(distance_m(&found)),
        _ => None,
    }
}
