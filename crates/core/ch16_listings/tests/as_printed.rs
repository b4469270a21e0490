//! The chapter's two worked examples and its map, by the calls that it prints.

use ch16_listings::prelude::*;

#[test]
fn svd_align_recovers_a_known_motion() {
    let truth = SE2::translation(2.0, 1.0) * SE2::new(Vector2::zeros(), 0.6_f64.atan2(0.8));
    let src = [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]].map(Point2::from);
    let dst = src.map(|p| truth.transform(&p));
    let pose = svd_align(&src, &dst);
    assert!((pose.translation().x - 2.0).abs() < 1e-9);
    assert!((pose.translation().y - 1.0).abs() < 1e-9);
    assert!((pose.theta() - truth.theta()).abs() < 1e-9);
}

#[test]
fn a_loop_spreads_its_error_over_the_cycle() {
    let mut graph = PoseGraph::new();
    let a = graph.add_fixed_node(SE2::identity());
    let b = graph.add_node(SE2::translation(1.0, 0.0));
    let c = graph.add_node(SE2::translation(2.0, 0.0));
    let omega = Matrix3::identity();
    graph.add_edge(a, b, SE2::translation(1.0, 0.0), omega, EdgeKind::Odometry);
    graph.add_edge(b, c, SE2::translation(1.0, 0.0), omega, EdgeKind::Odometry);
    graph.add_edge(a, c, SE2::translation(2.6, 0.0), omega, EdgeKind::Loop);
    assert!((graph.chi2() - 0.36).abs() < 1e-9);
    graph.optimize(20, 1e-12);
    assert_eq!(graph.pose(a), SE2::identity());
    assert!((graph.pose(b).translation().x - 1.2).abs() < 1e-9);
    assert!((graph.pose(c).translation().x - 2.4).abs() < 1e-9);
    assert!((graph.chi2() - 0.12).abs() < 1e-9);
}

#[test]
fn a_full_cell_takes_no_more_points() {
    let mut map = VoxelMap::new(0.25, 8);
    let pts: Vec<Point2<f64>> = (0..20)
        .map(|k| Point2::new(0.01 * f64::from(k), 0.1))
        .collect();
    let normals = vec![Some(Vector2::y()); pts.len()];
    map.insert(&pts, &normals);
    assert_eq!((map.pts.len(), map.normals.len()), (8, 8));
    assert_eq!(map.nearest(&Point2::new(0.02, 0.12), 0.25), Some(2));
    assert_eq!(map.nearest(&Point2::new(2.0, 0.1), 0.25), None);
}
