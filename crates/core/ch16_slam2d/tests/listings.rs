//! The signatures of the chapter's printed listings, through the import that they name.
//!
//! The results are tested elsewhere; here the listings must compile as printed, and every name must have the
//! chapter's meaning.

use ch16_slam2d::prelude::*;

/// Two walls that meet in a corner, each 2 m long.
fn corner() -> PointCloud {
    let walls = |k: i32| {
        let along = 0.05 * f64::from(k);
        [Point2::new(along, 0.0), Point2::new(0.0, along)]
    };
    let points: Vec<Point2<f64>> = (1..=40).flat_map(walls).collect();
    PointCloud::new(points, 0.25)
}

#[test]
fn the_listings_on_poses_compile() {
    let pose: SE2 = SE2::new(2.0, 1.0, 0.5);
    let theta: f64 = pose.theta();
    let position: Vector2<f64> = pose.translation();
    let log: Vector3<f64> = pose.log();
    let adjoint: Matrix3<f64> = pose.adjoint();
    let moved: SE2 = pose.boxplus(&Vector3::new(0.1, 0.0, 0.0));
    assert_eq!((position, theta), (Vector2::new(2.0, 1.0), 0.5));
    assert_eq!(log.z, theta);
    assert_eq!(adjoint * Vector3::z(), Vector3::new(1.0, -2.0, 1.0));
    // The perturbation acts on the right: the robot moves along its own heading.
    let ahead = (moved.translation() - position).normalize();
    assert!((ahead - Vector2::new(0.5_f64.cos(), 0.5_f64.sin())).norm() < 1e-12);
    let moved_back: SE2 = SE2::identity() * SE2::from_xy(-2.0, -1.0) * pose;
    assert_eq!(moved_back.translation(), Vector2::zeros());
}

#[test]
fn the_listings_on_registration_compile() {
    let mut target: PointCloud = corner();
    target.estimate_normals(0.2);
    let mut map = VoxelMap::new(0.25, 8);
    let points: Vec<Point2<f64>> = target.iter().collect();
    let normals: Vec<Option<Vector2<f64>>> = (0..target.len()).map(|k| target.normal(k)).collect();
    map.insert(&points, &normals);
    let query: Point2<f64> = Point2::new(1.0, 0.1);
    let nearest: Option<u32> = map.nearest(&query, 0.3);
    let index = nearest.expect("0.1 m away") as usize;
    assert!((map.point(index) - Point2::new(1.0, 0.0)).norm() < 1e-12);
    let neighbor: Option<Neighbor> = map.neighbor(query, 0.3);
    assert_eq!(neighbor.map(|found| found.index), Some(index));
    assert_eq!(map.nearest(&query, 0.1), None);

    // No point is off by half the distance to its neighbour, so all pairs are correct at once.
    let offset = SE2::new(0.01, -0.008, 0.004);
    let cloud: PointCloud = target.transformed(&offset.inverse());
    assert_eq!(cloud.stamp_s(), 0.25);
    for variant in [IcpVariant::PointToPoint, IcpVariant::PointToPlane] {
        let cfg = IcpConfig {
            variant,
            tau_m: 0.5,
            ..Default::default()
        };
        let result: IcpResult = icp(&cloud, &map, SE2::identity(), &cfg);
        let IcpResult {
            pose,
            rmse_m,
            inliers,
            ref trace,
            ..
        } = result;
        // 1e-4: the run ends at a step of that size, part of which remains because of the damping.
        assert!(pose.between(&offset).step_size() < 1e-4, "{variant:?}");
        assert!(rmse_m < 1e-4 && inliers == cloud.len(), "{variant:?}");
        assert_eq!(trace[0].pose, SE2::identity());

        let information: Matrix3<f64> = icp_information(&result.pairs, 0.02, 10.0);
        let regularized: Matrix3<f64> = regularize(information, 1.0, 2500.0);
        assert!(regularized.diagonal().max() <= 2500.0);
        assert!(regularized.cholesky().is_some());
    }
}

#[test]
fn the_listings_on_single_steps_compile() {
    let src: [Point2<f64>; 2] = [Point2::new(1.0, 0.0), Point2::new(0.0, 1.0)];
    let dst = src.map(|p| SE2::new(2.0, 1.0, 0.3).transform(p));
    let aligned: SE2 = svd_align(&src, &dst);
    assert!(aligned.between(&SE2::new(2.0, 1.0, 0.3)).step_size() < 1e-12);

    let wall: Vec<Point2<f64>> = corner().iter().collect();
    let lifted: Vec<Point2<f64>> = wall.iter().map(|p| p + Vector2::new(0.0, 0.1)).collect();
    let normals = vec![Some(Vector2::y()); wall.len()];
    let step: SE2 = point_to_plane_step(&wall, &lifted, &normals);
    // 1e-4 is the share by which the step is damped.
    assert!((step.translation() - Vector2::new(0.0, 0.1)).norm() < 1e-4);
}

#[test]
fn the_listing_on_the_pose_graph_compiles() {
    let mut graph = PoseGraph::new();
    let a: NodeId = graph.add_fixed_node(SE2::identity());
    let b = graph.add_node(SE2::from_xy(1.0, 0.0));
    let c = graph.add_node(SE2::from_xy(2.0, 0.0));
    let omega = Matrix3::<f64>::identity();
    graph.add_edge(a, b, SE2::from_xy(1.0, 0.0), omega, EdgeKind::Odometry);
    graph.add_edge(b, c, SE2::from_xy(1.0, 0.0), omega, EdgeKind::Odometry);
    graph.add_edge(a, c, SE2::from_xy(2.6, 0.0), omega, EdgeKind::Loop);
    let (max_iters, tolerance, huber) = (10, 1e-9, f64::INFINITY);
    let before: f64 = graph.chi2();
    let largest_step: f64 = graph.optimize_once(huber);
    assert!(largest_step > 0.0 && graph.chi2() < before);
    graph.optimize(max_iters, tolerance);
    assert!((graph.pose(c).translation().x - 2.4).abs() < 1e-8);
    let edge: PoseEdge = graph.edges().last().expect("three edges").edge;
    assert_eq!(edge.kind, EdgeKind::Loop);
}
