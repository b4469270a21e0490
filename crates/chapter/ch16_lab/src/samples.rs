//! Reproducible clouds and a graph for benchmarks and examples.
//!
//! The benchmarks, the table of workloads and the files for `ch16 register` share these data. Everything is
//! seen by the simulator's LiDAR in the Apartment, with range noise of 0.02 m.

use pr_geom::SE2;
use pr_sim::{Lidar, LidarConfig, Rng, World};

use crate::lap::{Lap, LapConfig};
use ch16_slam2d::cloud::PointCloud;
use ch16_slam2d::graph::PoseGraph;

/// Standard deviation of a range, m.
pub const RANGE_SIGMA_M: f64 = 0.02;
/// Points of [`apartment_map`].
const MAP_POINTS: usize = 5000;
/// Radius of the normals on the map, whose points are dense, m.
const MAP_NORMAL_RADIUS_M: f64 = 0.2;
/// Radius of the normals on one sweep, m.
const SWEEP_NORMAL_RADIUS_M: f64 = 0.3;

/// The returns of one sweep of `beams` rays, in the sensor's frame.
#[must_use]
pub fn sweep(world_from_sensor: &SE2, beams: usize, rng: &mut Rng) -> PointCloud {
    let mut lidar = Lidar::new(LidarConfig {
        beams,
        range_sigma_m: RANGE_SIGMA_M,
        ..LidarConfig::default()
    });
    let ranges_m = lidar.sense(&World::apartment(), world_from_sensor, rng);
    lidar.project(&ranges_m).collect()
}

/// 5,000 points of the Apartment in the world's frame, seen from 14 poses, without normals.
#[must_use]
pub fn apartment_map() -> PointCloud {
    let mut rng = Rng::new(5);
    let mut points = PointCloud::default();
    for k in 0..14 {
        let (column, row) = (f64::from(k % 7), f64::from(k / 7));
        let pose = SE2::new(0.9 + 1.7 * column, 2.2 + 4.6 * row, 0.3 * column);
        points.extend_transformed(&sweep(&pose, 360, &mut rng), &pose);
    }
    points.iter().take(MAP_POINTS).collect()
}

/// A scan to register on a map.
#[derive(Clone, Debug)]
pub struct RegistrationSample {
    /// The map with normals, in the world's frame.
    pub map: PointCloud,
    /// The scan in its sensor's frame.
    pub scan: PointCloud,
    /// True pose of the sensor, `world_from_scan`.
    pub truth: SE2,
    /// The initial guess of `world_from_scan`, 0.18 m and 0.05 rad off.
    pub guess: SE2,
}

impl RegistrationSample {
    /// A sweep of 720 points on [`apartment_map`].
    #[must_use]
    pub fn large() -> Self {
        let mut map = apartment_map();
        map.estimate_normals(MAP_NORMAL_RADIUS_M);
        Self::new(map, 720, 77)
    }

    /// A sweep of 180 points on another one of 180, taken 0.11 m and 0.05 rad apart.
    #[must_use]
    pub fn small() -> Self {
        let near = SE2::new(2.1, 1.95, 0.15);
        let mut map = sweep(&near, 180, &mut Rng::new(79)).transformed(&near);
        map.estimate_normals(SWEEP_NORMAL_RADIUS_M);
        Self::new(map, 180, 78)
    }

    fn new(map: PointCloud, beams: usize, seed: u32) -> Self {
        // From here every beam has a return: none passes the doors of rooms A and D both.
        let truth = SE2::new(2.2, 1.9, 0.2);
        Self {
            map,
            scan: sweep(&truth, beams, &mut Rng::new(seed)),
            truth,
            guess: truth * SE2::new(0.15, -0.1, 0.05),
        }
    }
}

/// The final pose graph of the canonical lap, with its 41 nodes moved back to dead reckoning.
#[must_use]
pub fn lap_graph() -> PoseGraph {
    let mut lap = Lap::new(LapConfig::default());
    lap.run();
    let mut graph = lap.graph().clone();
    for (node, keyframe) in lap.keyframes().enumerate() {
        graph.set_pose(node, lap.drive().dead_reckoning(keyframe.tick));
    }
    graph
}

#[cfg(test)]
mod tests {
    use super::*;
    use ch16_slam2d::cloud::DenseMap;
    use ch16_slam2d::icp::{Icp, IcpConfig, IcpVariant, IcpWorkspace};

    #[test]
    fn the_clouds_have_the_sizes_that_their_names_promise() {
        let (large, small) = (RegistrationSample::large(), RegistrationSample::small());
        assert_eq!((large.map.len(), large.scan.len()), (5000, 720));
        assert_eq!((small.map.len(), small.scan.len()), (180, 180));
        assert!(large.map.has_normals() && small.map.has_normals());
    }

    #[test]
    fn both_variants_find_home_from_the_guess() {
        // 3 cm and 1°: the noise is 2 cm a point, and the small map is sparse.
        for sample in [RegistrationSample::large(), RegistrationSample::small()] {
            let map = DenseMap::from_cloud(&sample.map, 0.25, usize::MAX);
            for variant in [IcpVariant::PointToPoint, IcpVariant::PointToPlane] {
                let config = IcpConfig {
                    variant,
                    tau_m: 0.5,
                    ..IcpConfig::default()
                };
                let mut workspace = IcpWorkspace::new();
                let found =
                    Icp::new(&sample.scan, &map, sample.guess, &config, &mut workspace).run();
                let error = sample.truth.between(&found.pose).log();
                assert!(error.x.hypot(error.y) < 0.03, "{variant:?}: {error}");
                assert!(error.z.abs() < 1_f64.to_radians(), "{variant:?}: {error}");
            }
        }
    }

    #[test]
    fn the_graph_of_the_lap_starts_at_dead_reckoning() {
        let mut graph = lap_graph();
        assert_eq!(graph.node_count(), 41);
        let before = graph.chi2();
        graph.optimize_robust(15, 1e-7, 12.0);
        assert!(graph.chi2() < 0.1 * before, "{before} → {}", graph.chi2());
    }
}
