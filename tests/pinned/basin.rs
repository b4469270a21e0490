//! w16.1: every registration of `basin.json`, and the normals of its target.

use ch16_lab::basin::{BasinScene, BasinStart};
use ch16_slam2d::cloud::{DenseMap, NearestMap, PointCloud, VoxelMap};
use ch16_slam2d::icp::{IcpVariant, IcpWorkspace, icp};
use pr_geom::{Point2, SE2};
use serde::Deserialize;
use slam2d_tests::{assert_close, reference};

#[derive(Deserialize)]
struct Basin {
    target: Vec<[f64; 2]>,
    source: Vec<[f64; 2]>,
    truth: [f64; 3],
    runs: Vec<Run>,
}

#[derive(Deserialize)]
struct Run {
    heading_deg: f64,
    dx: f64,
    dy: f64,
    variant: String,
    tau: f64,
    pose: [f64; 3],
    iterations: usize,
    converged: bool,
    rmse: f64,
    inliers: usize,
    error_m: f64,
    error_deg: f64,
}

impl Run {
    fn variant(&self) -> IcpVariant {
        match self.variant.as_str() {
            "point-to-point" => IcpVariant::PointToPoint,
            "point-to-plane" => IcpVariant::PointToPlane,
            other => panic!("unknown variant {other}"),
        }
    }

    fn name(&self) -> String {
        format!(
            "{} from {}° ({}, {}) with τ {}",
            self.variant, self.heading_deg, self.dx, self.dy, self.tau
        )
    }
}

fn cloud(points: &[[f64; 2]]) -> PointCloud {
    points.iter().map(|&[x, y]| Point2::new(x, y)).collect()
}

fn check_all_runs<M: NearestMap>(map: impl Fn(&PointCloud) -> M) {
    let basin: Basin = reference("basin.json");
    assert_eq!(basin.runs.len(), 292);
    let mut target = cloud(&basin.target);
    target.estimate_normals(0.3);
    let map = map(&target);
    let source = cloud(&basin.source);
    let [x, y, theta] = basin.truth;
    for run in &basin.runs {
        let config = BasinScene::config(run.variant(), run.tau);
        let init = SE2::new(x + run.dx, y + run.dy, theta + run.heading_deg.to_radians());
        let found = icp(&source, &map, init, &config);
        let name = run.name();
        assert_close(&format!("{name}: x"), found.pose.x(), run.pose[0], 1e-9);
        assert_close(&format!("{name}: y"), found.pose.y(), run.pose[1], 1e-9);
        let turn = SE2::new(0.0, 0.0, found.pose.theta() - run.pose[2]).theta();
        assert_close(&format!("{name}: θ"), turn, 0.0, 1e-9);
        assert_close(&format!("{name}: rmse"), found.rmse_m, run.rmse, 1e-9);
        assert_eq!(found.trace.len() - 1, run.iterations, "{name}");
        assert_eq!(found.stop.converged(), run.converged, "{name}");
        assert_eq!(found.inliers, run.inliers, "{name}");
    }
}

#[test]
fn all_292_registrations_end_where_the_reference_ends_on_the_dense_map() {
    check_all_runs(|target| DenseMap::from_cloud(target, 0.25, 8));
}

#[test]
fn all_292_registrations_end_where_the_reference_ends_on_the_voxel_map() {
    check_all_runs(|target| VoxelMap::from_cloud(target, 0.25, 8));
}

#[test]
fn the_scene_has_the_points_of_the_reference() {
    let basin: Basin = reference("basin.json");
    let scene = BasinScene::new();
    for (name, actual, expected) in [
        ("target", scene.target(), &basin.target),
        ("source", scene.source(), &basin.source),
    ] {
        assert_eq!(actual.len(), expected.len(), "{name}");
        for (index, (point, [x, y])) in actual.iter().zip(expected).enumerate() {
            assert_close(&format!("{name} {index}: x"), point.x, *x, 1e-9);
            assert_close(&format!("{name} {index}: y"), point.y, *y, 1e-9);
        }
    }
    for (actual, expected) in scene.truth().to_array().into_iter().zip(basin.truth) {
        assert_close("truth", actual, expected, 1e-9);
    }
}

#[test]
fn all_292_starts_of_the_scene_reach_the_errors_of_the_reference() {
    let basin: Basin = reference("basin.json");
    let scene = BasinScene::new();
    let mut workspace = IcpWorkspace::new();
    for run in &basin.runs {
        let start = BasinStart {
            heading_deg: run.heading_deg,
            dx_m: run.dx,
            dy_m: run.dy,
        };
        let config = BasinScene::config(run.variant(), run.tau);
        let outcome = scene.register_from(&start, &config, &mut workspace);
        let name = run.name();
        assert_close(&format!("{name}: m"), outcome.error_m, run.error_m, 1e-9);
        // 1e-7°: 1e-9 rad is 6e-8 degrees.
        assert_close(
            &format!("{name}: °"),
            outcome.error_deg,
            run.error_deg,
            1e-7,
        );
        assert_eq!(outcome.iterations, run.iterations, "{name}");
        assert_eq!(outcome.inliers, run.inliers, "{name}");
    }
}
