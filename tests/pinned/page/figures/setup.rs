//! The set-up in the text: the Apartment, constants of the lap, the gate.

use ch16_lab::basin::BasinScene;
use ch16_lab::lap::{FALSE_LOOP_DISTANCE_M, FALSE_LOOP_TURN_DEG, LAST_KEYFRAMES, LapConfig};
use ch16_slam2d::chapter::AdaptiveThreshold;
use ch16_slam2d::chi_squared::{cdf3, gate_threshold};
use ch16_slam2d::cloud::PointCloud;
use ch16_slam2d::icp::{INFORMATION_CAP, INFORMATION_RIDGE, IcpVariant, point_to_plane_step};
use ch16_slam2d::metrics::DisagreementConfig;
use ch16_slam2d::ndt::NdtMap;
use pr_geom::{Point2, SE2, Vector2};
use pr_sim::World;

use super::basin::{TAU_M, WIDE_TAU_M};

/// Sizes of the Apartment, m.
pub fn world(what: &str) -> Option<f64> {
    let size = |bounds: pr_sim::WorldRect| bounds.max - bounds.min;
    let rooms = World::apartment_rooms();
    let (a, d) = (rooms[0].bounds, rooms[3].bounds);
    match what {
        "width" => Some(size(World::apartment().bounds()).x),
        "height" => Some(size(World::apartment().bounds()).y),
        "corridor_width" => Some(d.min.y - a.max.y),
        "room_a_width" => Some(size(a).x),
        "room_a_height" => Some(size(a).y),
        _ => None,
    }
}

/// `lap.beams`, `loop.radius_m`, `basin.tau`: constants by part.
pub fn value(path: &[&str]) -> Option<f64> {
    let config = LapConfig::default();
    let loops = &config.slam.chapter.loops;
    let basin = BasinScene::config(IcpVariant::PointToPoint, TAU_M);
    Some(match *path {
        ["lap", "beams"] => config.drive.lidar.beams as f64,
        ["lap", "range_m"] => config.drive.lidar.max_range_m,
        ["lap", "noise_cm"] => 100.0 * config.drive.lidar.range_sigma_m,
        ["map", "disagreement_reach_m"] => DisagreementConfig::default().reach_m,
        ["p2l", "ridge"] => plane_ridge(),
        ["ndt", "clamp"] => ndt_clamp(),
        ["lap", "tick_s"] => config.drive.dt_s,
        ["lap", "last_keyframes"] => LAST_KEYFRAMES as f64,
        ["lap", "keyframe_m"] => config.slam.keyframe_distance_m,
        ["lap", "keyframe_rad"] => config.slam.keyframe_turn_rad,
        ["loop", "every_ordinal"] => loops.attempt_every_nodes as f64,
        ["loop", "false_m"] => FALSE_LOOP_DISTANCE_M,
        ["loop", "false_deg"] => FALSE_LOOP_TURN_DEG,
        ["loop", "radius_m"] => loops.radius_m,
        ["loop", "min_gap"] => loops.min_gap_nodes as f64,
        ["loop", "max_rmse_m"] => loops.max_rmse_m,
        ["loop", "min_inliers"] => loops.min_inliers as f64,
        ["loop", "drift_m"] => loops.drift_sigma_m,
        ["loop", "drift_rad"] => loops.drift_sigma_rad,
        ["loop", "inflate"] => loops.trust.covariance_scale,
        ["odometry", "inflate"] => config.slam.chapter.odometry_trust.covariance_scale,
        ["lap", "tau_deviations"] => tau_deviations(),
        ["information", "ridge"] => INFORMATION_RIDGE,
        ["information", "cap"] => INFORMATION_CAP,
        ["information", "cap_std_m"] => 1.0 / INFORMATION_CAP.sqrt(),
        ["basin", "tau"] => basin.tau_m,
        ["basin", "tau_wide"] => WIDE_TAU_M,
        ["normals", "min_neighbors"] => min_neighbors() as f64,
        _ => return None,
    })
}

/// The smallest number of points in a line that yields normals.
fn min_neighbors() -> usize {
    let has_normals = |count: &usize| {
        let line = (0..*count).map(|k| Point2::new(0.05 * k as f64, 0.0));
        let mut cloud: PointCloud = line.collect();
        cloud.estimate_normals(0.3);
        cloud.normal(0).is_some()
    };
    (1..10)
        .find(has_normals)
        .expect("ten points in a line give normals")
}

/// The ridge of the point-to-plane step as a share of the mean of the diagonal, computed from the part of a
/// step that it suppresses.
fn plane_ridge() -> f64 {
    const OFF_M: f64 = 0.1;
    let wall = [-1.0, 0.0, 1.0].map(|x| Point2::new(x, 0.0));
    let lifted = wall.map(|p| Point2::new(p.x, OFF_M));
    let step = point_to_plane_step(&wall, &lifted, &[Some(Vector2::y()); 3]);
    // Three rows (0, 1, x) about the centroid.
    let diagonal = [0.0, 3.0, 2.0];
    let ridge = diagonal[1] * (OFF_M / step.y() - 1.0);
    ridge / (diagonal.iter().sum::<f64>() / 3.0)
}

/// The smaller eigenvalue of a Gaussian with points on a line, as a share of the larger one.
fn ndt_clamp() -> f64 {
    let line = (0..8).map(|k| Point2::new(0.05 + 0.1 * f64::from(k), 0.5));
    let map = NdtMap::build(&line.collect::<PointCloud>(), 1.0, 4);
    let values = map.cells()[0].covariance.symmetric_eigenvalues();
    values.min() / values.max()
}

/// Ratio of the adaptive τ to the usual difference of prediction and registration.
fn tau_deviations() -> f64 {
    // A power of two avoids rounding.
    const DIFFERENCE_M: f64 = 0.125;
    let mut threshold = AdaptiveThreshold::new(0.5, 0.0, 6.0);
    for _ in 0..8 {
        threshold.update(&SE2::identity(), &SE2::from_xy(DIFFERENCE_M, 0.0));
    }
    threshold.tau_m() / DIFFERENCE_M
}

/// The test of an innovation: its threshold, and what it accepts.
pub fn gate(what: &str) -> Option<f64> {
    match what {
        "chi2" => Some(LapConfig::default().slam.chapter.loops.gate_chi2),
        "quantile_percent" => {
            let gate = LapConfig::default().slam.chapter.loops.gate_chi2;
            Some(100.0 * cdf3(gate))
        }
        "rejected_share" => Some(1.0 - cdf3(LapConfig::default().slam.chapter.loops.gate_chi2)),
        "tight_chi2" => Some(gate_threshold(0.9)),
        _ => None,
    }
}
