//! The chapter's two worked examples, by the chapter's listings and by the core.

use ch16_listings::{EdgeKind, PoseGraph, SE2, Translation, svd_align};
use ch16_slam2d::{graph, icp};
use nalgebra::{Matrix3, Point2, Vector2};

#[test]
fn svd_align_recovers_a_known_rigid_motion() {
    let src = [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]].map(Point2::from);
    // The rotation of the 3-4-5 triangle, multiplied out by hand, and t = (2, 1).
    let (cos, sin, t) = (0.8, 0.6, Vector2::new(2.0, 1.0));
    let dst = src.map(|p| Point2::new(cos * p.x - sin * p.y, sin * p.x + cos * p.y) + t);
    let found = [svd_align(&src, &dst), SE2::from(icp::svd_align(&src, &dst))];
    for pose in found {
        // 1e-12: a dozen roundings of numbers of order 1.
        assert!((pose.translation() - t).norm() < 1e-12, "{pose:?}");
        assert!((pose.theta().cos() - cos).abs() < 1e-12, "{pose:?}");
        assert!((pose.theta().sin() - sin).abs() < 1e-12, "{pose:?}");
    }
}

#[test]
fn a_loop_error_spreads_evenly_around_the_cycle() {
    let at = |x: f64| SE2::new(Vector2::new(x, 0.0), 0.0);
    let omega = Matrix3::identity();
    let mut chain = PoseGraph::new();
    let first = chain.add_fixed_node(at(0.0));
    let (second, third) = (chain.add_node(at(1.0)), chain.add_node(at(2.0)));
    chain.add_edge(first, second, at(1.0), omega, EdgeKind::Odometry);
    chain.add_edge(second, third, at(1.0), omega, EdgeKind::Odometry);
    assert!(chain.chi2() < 1e-12, "a chain contradicts nothing");
    chain.add_edge(first, third, at(2.6), omega, EdgeKind::Loop);
    assert!((chain.chi2() - 0.36).abs() < 1e-12);

    let mut core = graph::PoseGraph::new();
    core.add_fixed_node(at(0.0).into());
    core.add_node(at(1.0).into());
    core.add_node(at(2.0).into());
    for (i, j, x, kind) in [
        (0, 1, 1.0, EdgeKind::Odometry),
        (1, 2, 1.0, EdgeKind::Odometry),
        (0, 2, 2.6, EdgeKind::Loop),
    ] {
        core.add_edge(i, j, at(x).into(), omega, kind);
    }

    chain.optimize(10, 1e-9);
    core.optimize(10, 1e-9);
    let ends = [
        (chain.chi2(), chain.pose(second), chain.pose(third)),
        (core.chi2(), core.pose(1).into(), core.pose(2).into()),
    ];
    for (chi2, middle, last) in ends {
        // 1e-8: the solvers add 1e-9 to the diagonal.
        assert!((chi2 - 0.12).abs() < 1e-8, "{chi2}");
        assert!((middle.translation().x - 1.2).abs() < 1e-8, "{middle:?}");
        assert!((last.translation().x - 2.4).abs() < 1e-8, "{last:?}");
    }
    // Each of the three edges takes a third of 0.6 m.
    for edge in chain.graph.edge_indices() {
        let (i, j) = chain.graph.edge_endpoints(edge).expect("it has ends");
        let e = chain.residual(i, j, &chain.graph[edge]);
        assert!((e.norm() - 0.2).abs() < 1e-8, "{e}");
    }
}
