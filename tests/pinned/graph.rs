//! The chapter's worked example of a pose graph: three poses on a line.
//!
//! Odometry measures 1 m and 1 m, the loop 2.6 m. Before: χ² = 0.6² = 0.36. The optimum spreads the
//! disagreement equally, 0.2 m per edge: poses 1.2 and 2.4, χ² = 3 · 0.2² = 0.12.

use ch16_slam2d::graph::{EdgeKind, PoseGraph};
use nalgebra::Matrix3;
use pr_geom::SE2;
use pr_optim::{Between, JacobianModel, Method, Optimizer, Problem, Settings, StopReason};

#[test]
fn chapter_listing_solves_the_three_poses() {
    let mut graph = PoseGraph::new();
    let a = graph.add_fixed_node(SE2::identity());
    let b = graph.add_node(SE2::from_xy(1.0, 0.0));
    let c = graph.add_node(SE2::from_xy(2.0, 0.0));
    let omega = Matrix3::identity();
    graph.add_edge(a, b, SE2::from_xy(1.0, 0.0), omega, EdgeKind::Odometry);
    graph.add_edge(b, c, SE2::from_xy(1.0, 0.0), omega, EdgeKind::Odometry);
    graph.add_edge(a, c, SE2::from_xy(2.6, 0.0), omega, EdgeKind::Loop);
    assert!((graph.chi2() - 0.36).abs() < 1e-12);
    graph.optimize(10, 1e-9);
    assert_eq!(graph.pose(a), SE2::identity());
    assert!((graph.pose(b).x() - 1.2).abs() < 1e-9);
    assert!((graph.pose(c).x() - 2.4).abs() < 1e-9);
    assert!(graph.pose(c).translation().y.abs() < 1e-12);
    assert!((graph.chi2() - 0.12).abs() < 1e-12);
}

#[test]
fn every_method_and_jacobian_solves_the_three_poses() {
    for method in [
        Method::GaussNewton,
        Method::LevenbergMarquardt {
            initial_damping: 1e-3,
        },
    ] {
        for jacobians in [JacobianModel::Chapter, JacobianModel::Exact] {
            let mut problem = Problem::new();
            problem.add_fixed_pose(SE2::identity());
            problem.add_pose(SE2::from_xy(1.0, 0.0));
            problem.add_pose(SE2::from_xy(2.0, 0.0));
            for (from, to, x) in [(0, 1, 1.0), (1, 2, 1.0), (0, 2, 2.6)] {
                problem.add_factor(Between {
                    from,
                    to,
                    measurement: SE2::from_xy(x, 0.0),
                    information: Matrix3::identity(),
                });
            }
            let report = Optimizer::new(Settings {
                method,
                jacobians,
                max_iterations: 60,
                step_tolerance: 1e-10,
                ..Settings::default()
            })
            .run(&mut problem);
            assert!(
                matches!(report.stop, StopReason::SmallStep { step, tolerance } if step < tolerance),
                "{}",
                report.stop
            );
            assert!((report.chi2_initial - 0.36).abs() < 1e-12);
            assert!((report.chi2 - 0.12).abs() < 1e-12);
            assert!((problem.poses()[1].x() - 1.2).abs() < 1e-9);
            assert!((problem.poses()[2].x() - 2.4).abs() < 1e-9);
        }
    }
}
