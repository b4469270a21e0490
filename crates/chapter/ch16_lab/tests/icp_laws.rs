//! Properties of every registration.

use ch16_lab::basin::{BasinScene, BasinStart, Minimum};
use ch16_lab::terrain::{SceneKind, TerrainScene};
use ch16_slam2d::chapter::AdaptiveThreshold;
use ch16_slam2d::cloud::{DenseMap, NearestMap, PointCloud, VoxelMap};
use ch16_slam2d::icp::{
    INFORMATION_CAP, INFORMATION_RIDGE, Icp, IcpConfig, IcpVariant, IcpWorkspace, Pair, StopReason,
    centroid, correspondences, icp, icp_information, icp_information_along, move_information,
    regularize,
};
use pr_geom::{Matrix3, Point2, SE2, Vector2, Vector3};
use pr_sim::Rng;
use proptest::prelude::*;

/// Points along the walls of a box with a nook, with up to 3 cm of noise.
///
/// The noise comes from a seed instead of a shrinking strategy: without noise, points tie for the nearest,
/// and the last bit decides.
fn walls(seed: u32) -> PointCloud {
    let mut rng = Rng::new(seed);
    let corners = [
        (-2.0, -1.5),
        (2.0, -1.5),
        (2.0, 1.0),
        (0.7, 1.0),
        (0.7, 1.6),
        (-2.0, 1.6),
        (-2.0, -1.5),
    ];
    let edges = corners.iter().zip(&corners[1..]);
    edges
        .flat_map(|(a, b)| (0..15).map(move |k| (a, b, f64::from(k) / 15.0)))
        .map(|(a, b, t)| {
            Point2::new(
                a.0 + t * (b.0 - a.0) + rng.uniform(-0.03, 0.03),
                a.1 + t * (b.1 - a.1) + rng.uniform(-0.03, 0.03),
            )
        })
        .collect()
}

fn pose(shift_m: f64, turn_rad: f64) -> impl Strategy<Value = SE2> {
    (-shift_m..shift_m, -shift_m..shift_m, -turn_rad..turn_rad)
        .prop_map(|(x, y, theta)| SE2::new(x, y, theta))
}

fn variant() -> impl Strategy<Value = IcpVariant> {
    prop_oneof![
        Just(IcpVariant::PointToPoint),
        Just(IcpVariant::PointToPlane)
    ]
}

proptest! {
    #[test]
    fn the_truncated_cost_of_point_to_point_never_rises(
        target in any::<u32>(), source in any::<u32>(), init in pose(0.8, 1.0), tau in 0.1..1.6,
    ) {
        let map = VoxelMap::from_cloud(&walls(target), 0.25, 8);
        let config = IcpConfig { tau_m: tau, ..IcpConfig::default() };
        let found = icp(&walls(source), &map, init, &config);
        for step in found.trace.windows(2) {
            let (before, after) = (step[0].truncated_cost_m2, step[1].truncated_cost_m2);
            // 1e-12: the rounding of a mean of 90 squares below 2.6.
            prop_assert!(after <= before + 1e-12, "{before} rose to {after}");
        }
    }

    #[test]
    fn moving_map_and_guess_alike_moves_the_result_alike(
        target in any::<u32>(), source in any::<u32>(), init in pose(0.2, 0.2), gauge in pose(5.0, 3.1),
        variant in variant(),
    ) {
        let mut target = walls(target);
        target.estimate_normals(0.4);
        let source = walls(source);
        // No bucket may be full, because the points that a full one keeps depend on the position of the
        // cells.
        let map = |cloud: &PointCloud| DenseMap::from_cloud(cloud, 0.25, usize::MAX);
        let config = IcpConfig { variant, ..IcpConfig::default() };
        let here = icp(&source, &map(&target), init, &config);
        let there = icp(&source, &map(&target.transformed(&gauge)), gauge * init, &config);
        // Poses agree as long as both run. The numbers of iterations may differ: the stopping rule measures
        // an increment in the map's frame, where a rotation about a far point counts as a shift.
        for (here, there) in here.trace.iter().zip(&there.trace) {
            let difference = (gauge * here.pose).between(&there.pose);
            // 1e-9: 25 iterations of rounding; a pair that flipped would show as 1e-3.
            prop_assert!(difference.step_size() < 1e-9, "{difference:?}");
            prop_assert!((here.rmse_m - there.rmse_m).abs() < 1e-9);
        }
    }

    #[test]
    fn stepping_ends_where_running_ends(init in pose(0.5, 0.5), variant in variant()) {
        let scene = BasinScene::new();
        let config = BasinScene::config(variant, 0.7);
        let init = scene.truth() * init;
        let whole = icp(scene.source(), scene.map(), init, &config);
        let mut workspace = IcpWorkspace::new();
        let mut steps = Icp::new(scene.source(), scene.map(), init, &config, &mut workspace);
        for entry in &whole.trace[1..] {
            prop_assert_eq!(&steps.step().trace, entry);
        }
        prop_assert_eq!(steps.step().stop, Some(whole.stop));
        prop_assert_eq!(steps.pairs().collect::<Vec<_>>(), whole.pairs.clone());
        let alone = correspondences(scene.source(), scene.map(), whole.pose, &config);
        prop_assert_eq!(alone, whole.pairs);
    }
}

#[test]
fn point_to_plane_does_not_promise_the_same() {
    // It reduces distances along normals, so the truncated cost may rise, and the law above can fail.
    let scene = BasinScene::new();
    let config = BasinScene::config(IcpVariant::PointToPlane, 0.7);
    let rises = (-180..=180).step_by(5).any(|heading_deg| {
        let start = BasinStart {
            heading_deg: f64::from(heading_deg),
            dx_m: 0.0,
            dy_m: 0.0,
        };
        let found = icp(scene.source(), scene.map(), scene.guess(&start), &config);
        let mut steps = found.trace.windows(2);
        steps.any(|step| step[1].truncated_cost_m2 > step[0].truncated_cost_m2 + 1e-6)
    });
    assert!(rises);
}

#[test]
fn trimming_keeps_the_nearest_share_of_the_pairs() {
    let scene = BasinScene::new();
    let all = BasinScene::config(IcpVariant::PointToPoint, 0.7);
    let half = IcpConfig { trim: 0.5, ..all };
    let init = scene.guess(&BasinStart::default());
    let pairs = correspondences(scene.source(), scene.map(), init, &all);
    let kept = correspondences(scene.source(), scene.map(), init, &half);
    assert_eq!(kept.len(), pairs.len().div_ceil(2));
    let longest = kept.iter().map(|p| p.distance_m()).fold(0.0, f64::max);
    let dropped = pairs.iter().filter(|pair| !kept.contains(pair));
    assert!(dropped.map(|p| p.distance_m()).all(|d| d >= longest));
}

#[test]
fn a_huber_width_keeps_outliers_from_pulling_the_pose() {
    // A wall whose last points are outliers, 0.5 m in front of it.
    let wall: PointCloud = (0..60)
        .map(|k| Point2::new(0.05 * f64::from(k % 30), if k < 30 { 0.0 } else { 3.0 }))
        .collect();
    let seen: PointCloud = wall
        .iter()
        .enumerate()
        .map(|(k, p)| {
            if k % 10 == 0 {
                p + Vector2::repeat(0.4)
            } else {
                p
            }
        })
        .collect();
    let map = VoxelMap::from_cloud(&wall, 0.25, 8);
    let error = |huber_width_m: f64| {
        let config = IcpConfig {
            huber_width_m,
            ..IcpConfig::default()
        };
        icp(&seen, &map, SE2::identity(), &config).pose.y().abs()
    };
    assert!(
        error(0.05) < 0.3 * error(f64::INFINITY),
        "{} {}",
        error(0.05),
        error(f64::INFINITY)
    );
}

#[test]
fn a_registration_says_why_it_ended() {
    let scene = BasinScene::new();
    let start = |heading_deg| BasinStart {
        heading_deg,
        dx_m: 0.0,
        dy_m: 0.0,
    };
    let config = BasinScene::config(IcpVariant::PointToPoint, 0.7);
    let mut workspace = IcpWorkspace::new();
    let near = scene.register_from(&start(10.0), &config, &mut workspace);
    assert_eq!(near.ending, Minimum::Right);
    assert!(matches!(near.stop, StopReason::SmallStep { step, tolerance } if step < tolerance));
    let short = IcpConfig {
        max_iterations: 3,
        ..config
    };
    let cut = scene.register_from(&start(10.0), &short, &mut workspace);
    assert_eq!(cut.stop, StopReason::IterationLimit { max_iterations: 3 });
    assert_eq!(cut.iterations, 3);
    let far = icp(
        scene.source(),
        scene.map(),
        SE2::from_xy(50.0, 0.0),
        &config,
    );
    let (pairs, min_pairs) = (0, 8);
    assert_eq!(far.stop, StopReason::TooFewPairs { pairs, min_pairs });
    assert_eq!((far.rmse_m, far.trace.len()), (f64::INFINITY, 1));
}

#[test]
fn the_corridors_point_to_plane_matrix_has_rank_two_and_the_rooms_three() {
    // Two perfect walls along x: their normals do not constrain x, to the last bit.
    let mut corridor: PointCloud = (0..40)
        .flat_map(|k| {
            let x = 0.1 * f64::from(k);
            [Point2::new(x, 0.0), Point2::new(x, 1.2)]
        })
        .collect();
    corridor.estimate_normals(0.3);
    let map = VoxelMap::from_cloud(&corridor, 0.3, 8);
    let config = IcpConfig::default();
    let mut pairs = correspondences(&corridor, &map, SE2::identity(), &config);
    // The last point of a wall may have too few neighbours for a normal.
    pairs.retain(|pair| pair.normal.is_some());
    assert!(pairs.len() >= corridor.len() - 4);
    let information = icp_information(&pairs, 0.01, 1.0);
    assert_eq!(information.rank(1e-9 * information.norm()), 2);
    assert_eq!(information.row(0).norm(), 0.0);

    // The simulated ones have noise in their normals: less than 1 % of the largest eigenvalue counts as
    // degenerate.
    let scene = |kind| TerrainScene::new(kind, TerrainScene::DEFAULT_NDT_CELL_M).information(0.6);
    assert_eq!(scene(SceneKind::Room).rank(), 3);
    let corridor = scene(SceneKind::Corridor);
    assert_eq!(corridor.rank(), 2);
    let along = corridor
        .null_direction()
        .expect("rank 2 leaves a direction");
    assert!(along.x.abs() > 0.99, "{along}");
}

#[test]
fn information_turns_with_the_body_and_counts_both_axes_without_a_normal() {
    let scene = TerrainScene::new(SceneKind::Room, TerrainScene::DEFAULT_NDT_CELL_M);
    let config = IcpConfig::default();
    let pairs = correspondences(scene.cloud(), scene.map(), SE2::identity(), &config);
    let straight = icp_information(&pairs, 0.05, 12.0);
    let turned = icp_information_along(&pairs, 0.05, 12.0, 0.7);
    let mut rotation = Matrix3::identity();
    rotation
        .fixed_view_mut::<2, 2>(0, 0)
        .copy_from(&SE2::new(0.0, 0.0, 0.7).rotation_matrix());
    let expected = rotation.transpose() * straight * rotation;
    // 1e-9 of entries of order 1e4.
    assert!((turned - expected).norm() < 1e-9 * expected.norm());

    let bare: Vec<_> = pairs
        .iter()
        .map(|pair| ch16_slam2d::icp::Pair {
            normal: None,
            ..*pair
        })
        .collect();
    let per_axis = pairs.len() as f64 / (0.05 * 0.05 * 12.0);
    let information = icp_information(&bare, 0.05, 12.0);
    assert!((information[(0, 0)] - per_axis).abs() < 1e-9 * per_axis);
    assert!((information[(1, 1)] - per_axis).abs() < 1e-9 * per_axis);
    assert!(information[(0, 1)].abs() < 1e-9 * per_axis);
}

#[test]
fn information_moved_to_the_body_is_the_hessian_of_the_cost_under_perturbations_there() {
    let scene = TerrainScene::new(SceneKind::Room, TerrainScene::DEFAULT_NDT_CELL_M);
    let map_from_body = SE2::new(3.0, -1.0, 2.0);
    let (sigma, covariance_scale) = (0.05_f64, 12.0);
    let config = IcpConfig::default();
    let mut pairs = correspondences(scene.cloud(), scene.map(), SE2::identity(), &config);
    pairs.retain(|pair| pair.normal.is_some());
    let residual = |pair: &Pair, delta: &Vector3<f64>| {
        let in_body = map_from_body.inverse().transform(pair.source);
        let moved = map_from_body.boxplus(delta).transform(in_body);
        let normal = pair.normal.expect("pairs without one were left out");
        normal.dot(&(moved - pair.target)) / (sigma * sigma * covariance_scale).sqrt()
    };
    let step = 1e-4;
    let mut hessian = Matrix3::zeros();
    for pair in &pairs {
        let row = Vector3::from_fn(|k, _| {
            let delta = Vector3::from_fn(|axis, _| if axis == k { step } else { 0.0 });
            (residual(pair, &delta) - residual(pair, &-delta)) / (2.0 * step)
        });
        hessian += row * row.transpose();
    }

    let center = centroid(&pairs);
    let body_from_center = map_from_body.inverse() * SE2::from_xy(center.x, center.y);
    let at_center = icp_information(&pairs, sigma, covariance_scale);
    let at_body = move_information(&at_center, &body_from_center.inverse());
    // 1e-6: central differences over 1e-4 leave 1e-8 of an arm of a few metres.
    assert!((at_body - hessian).norm() < 1e-6 * hessian.norm());
    // Moving the other way yields another matrix, and so does the matrix about the centroid.
    let wrong_way = move_information(&at_center, &body_from_center);
    assert!((wrong_way - hessian).norm() > 0.1 * hessian.norm());
    let along = icp_information_along(&pairs, sigma, covariance_scale, map_from_body.theta());
    assert!((along - hessian).norm() > 0.1 * hessian.norm());
    let turned = move_information(&at_center, &SE2::new(0.0, 0.0, map_from_body.theta()));
    assert!((along - turned).norm() < 1e-12 * turned.norm());
}

#[test]
fn regularizing_caps_the_largest_diagonal_entry_at_2500() {
    let small = Matrix3::from_diagonal_element(10.0);
    let chapters = |information| regularize(information, INFORMATION_RIDGE, INFORMATION_CAP);
    assert_eq!(chapters(small), Matrix3::from_diagonal_element(11.0));
    let large = chapters(Matrix3::new(
        9999.0, 5.0, 0.0, 5.0, 99.0, 0.0, 0.0, 0.0, 0.0,
    ));
    assert_eq!(large[(0, 0)], 2500.0);
    assert_eq!(large[(0, 1)], 1.25);
    assert_eq!(large[(2, 2)], 0.25);
}

#[test]
fn the_threshold_adapts_after_three_deviations() {
    let mut threshold = AdaptiveThreshold::new(0.5, 0.03, 6.0);
    let shifted = SE2::from_xy(0.1, 0.0);
    threshold.update(&SE2::identity(), &SE2::from_xy(0.02, 0.0));
    for _ in 0..2 {
        threshold.update(&SE2::identity(), &shifted);
        assert_eq!(threshold.tau_m(), 0.5);
    }
    threshold.update(&SE2::identity(), &shifted);
    assert!((threshold.tau_m() - 0.3).abs() < 1e-12);
    // A turn counts by how far it moves the farthest point: 2·6·sin(0.05).
    let mut threshold = AdaptiveThreshold::new(0.5, 0.03, 6.0);
    for _ in 0..3 {
        threshold.update(&SE2::identity(), &SE2::new(0.0, 0.0, -0.1));
    }
    assert!((threshold.tau_m() - 36.0 * 0.05_f64.sin()).abs() < 1e-12);
}

#[test]
fn clouds_keep_their_order_and_turn_their_normals() {
    let mut cloud = PointCloud::from_iter([
        Point2::new(0.05, 0.0),
        Point2::new(-0.05, 0.0),
        Point2::new(0.15, 0.1),
    ]);
    let thin = cloud.downsample(0.2);
    assert_eq!(thin.len(), 2);
    assert!((thin.point(0) - Point2::new(0.1, 0.05)).norm() < 1e-15);
    cloud.clear();
    cloud.push(Point2::new(1.0, 0.0));
    cloud.push_with_normal(Point2::new(2.0, 0.0), Some(Vector2::y()));
    let turned = cloud.transformed(&SE2::new(0.0, 3.0, std::f64::consts::FRAC_PI_2));
    assert_eq!(turned.normal(0), None);
    let normal = turned.normal(1).expect("the second point has a normal");
    assert!((normal + Vector2::x()).norm() < 1e-15);
    assert!((turned.point(1) - Point2::new(0.0, 5.0)).norm() < 1e-15);
    let map = DenseMap::from_cloud(&turned, 0.25, 8);
    assert_eq!(map.normal(0).is_some(), map.source_index(0) == 1);
}
