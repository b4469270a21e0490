//! Registers a scan on a map without known pairs: ICP, and the information of its result.
//!
//! `cargo run -p ch16_slam2d --example register_a_scan`

use ch16_slam2d::prelude::*;

/// Points every 5 cm along two walls that meet in a corner, 4 m and 3 m long; the first at `start_m`.
fn walls(start_m: f64) -> Vec<Point2<f64>> {
    let along = |k: i32| start_m + 0.05 * f64::from(k);
    let south = (0..80).map(|k| Point2::new(along(k), 0.0));
    let west = (0..60).map(|k| Point2::new(0.0, along(k)));
    south.chain(west).collect()
}

/// Pose of the scan: the corner is behind the robot, to its right.
fn map_from_robot() -> SE2 {
    SE2::new(1.5, 1.0, 0.4)
}

/// Registers the scan from a guess that is 20 cm and 6° off.
pub fn register(variant: IcpVariant) -> (IcpResult, Matrix3<f64>) {
    let mut target = PointCloud::new(walls(0.0), 0.0);
    target.estimate_normals(0.2);
    let mut map = VoxelMap::new(0.25, 8);
    map.insert_cloud(&target);

    let robot_from_map = map_from_robot().inverse();
    // A scan does not hit exactly the points of the map.
    let seen = walls(0.02).into_iter().map(|p| robot_from_map.transform(p));
    let scan = PointCloud::new(seen.collect(), 0.25);

    let guess = map_from_robot() * SE2::new(0.2, -0.05, 0.1);
    let cfg = IcpConfig {
        variant,
        tau_m: 0.5,
        ..Default::default()
    };
    let found = icp(&scan, &map, guess, &cfg);
    // Neighbouring beams hit the same wall: ten of them count as one.
    let information = icp_information(&found.pairs, 0.02, 10.0);
    (found, regularize(information, 1.0, 2500.0))
}

/// Error of a registration, m and rad added.
pub fn error(found: &IcpResult) -> f64 {
    map_from_robot().between(&found.pose).step_size()
}

/// Prints both registrations and their information.
pub fn main() {
    for variant in [IcpVariant::PointToPoint, IcpVariant::PointToPlane] {
        let (found, information) = register(variant);
        let steps = found.trace.len() - 1;
        println!("{variant:?}: {steps} steps, rmse {:.4} m", found.rmse_m);
        println!("off by {:.4}; information{information:.0}", error(&found));
    }
}
