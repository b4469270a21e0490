//! Registrations by NDT in its reference scene, and the curvature of its score in a corridor.

use ch16_lab::terrain::{SceneKind, TerrainScene};
use ch16_slam2d::cloud::PointCloud;
use ch16_slam2d::ndt::{NdtConfig, NdtMap, NdtResult, ndt_align};
use nalgebra::{Matrix2x3, Matrix3, Vector2, Vector3};
use pr_geom::{Rotation, SE2};
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

/// Bare corridors that differ in their noise.
const CORRIDORS: u32 = 12;

/// The exact Hessian of the negative score in these corridors: `corridors`, and its smallest eigenvalue at the
/// truth (`negative_at_truth` counts the corridors) and at the optimum (`least_at_optimum`).
pub fn hessian(what: &str) -> Option<f64> {
    let scenes = (0..CORRIDORS).map(|k| {
        TerrainScene::with_seed(
            SceneKind::LongCorridor,
            TerrainScene::DEFAULT_NDT_CELL_M,
            TerrainScene::SEED + k,
        )
    });
    let at_truth = |scene: &TerrainScene| smallest_curvature(scene, &scene.world_from_sensor());
    let at_optimum = |scene: &TerrainScene| {
        let sensor = scene.world_from_sensor();
        let cloud = scene.cloud().transformed(&sensor.inverse());
        let config = NdtConfig {
            max_iterations: 500,
            ..NdtConfig::default()
        };
        let found = ndt_align(&cloud, scene.ndt(), sensor, &config);
        smallest_curvature(scene, &found.pose)
    };
    match what {
        "corridors" => Some(f64::from(CORRIDORS)),
        "negative_at_truth" => {
            let curvatures = scenes.map(|scene| at_truth(&scene));
            Some(curvatures.filter(|least| *least < 0.0).count() as f64)
        }
        "least_at_optimum" => scenes.map(|scene| at_optimum(&scene)).reduce(f64::min),
        _ => None,
    }
}

/// Smallest eigenvalue of the Hessian of the negative score in `(t_x, t_y, θ)` about the sensor.
fn smallest_curvature(scene: &TerrainScene, world_from_sensor: &SE2) -> f64 {
    let cloud = scene
        .cloud()
        .transformed(&scene.world_from_sensor().inverse());
    let rotation = Rotation::new(world_from_sensor.theta());
    let mut hessian = Matrix3::zeros();
    for point in cloud.iter() {
        let (x, y) = rotation.rotate(point.x, point.y);
        let moved = world_from_sensor.translation() + Vector2::new(x, y);
        let jacobian = Matrix2x3::new(1.0, 0.0, -y, 0.0, 1.0, x);
        for cell in scene.ndt().around(moved.x, moved.y) {
            let off = moved - cell.mean.coords;
            let pulled = cell.information * off;
            let slope: Vector3<f64> = jacobian.transpose() * pulled;
            let mut curvature = jacobian.transpose() * cell.information * jacobian;
            // The second derivative of the moved point by the angle points back to the sensor.
            curvature[(2, 2)] -= pulled.dot(&Vector2::new(x, y));
            hessian += (-0.5 * off.dot(&pulled)).exp() * (curvature - slope * slope.transpose());
        }
    }
    hessian.symmetric_eigenvalues().min()
}
