//! Properties of every solve, on random graphs.

use nalgebra::{Matrix3, Vector3};
use pr_geom::SE2;
use pr_optim::{
    Between, JacobianModel, Method, Optimizer, Problem, RobustKernel, Settings, StopReason,
};
use proptest::prelude::*;

/// A chain of poses with loop closures, and random measurement errors.
#[derive(Clone, Debug)]
struct Graph {
    poses: Vec<SE2>,
    factors: Vec<Between>,
}

impl Graph {
    fn problem(&self, world: SE2) -> Problem {
        let mut problem = Problem::new();
        problem.add_fixed_pose(world * self.poses[0]);
        for pose in &self.poses[1..] {
            problem.add_pose(world * *pose);
        }
        for factor in &self.factors {
            problem.add_factor(*factor);
        }
        problem
    }
}

fn twist(size: f64) -> impl Strategy<Value = Vector3<f64>> {
    [-size..size, -size..size, -size..size].prop_map(|[x, y, w]| Vector3::new(x, y, w))
}

fn graph() -> impl Strategy<Value = Graph> {
    let nodes = 4_usize..14;
    nodes
        .prop_flat_map(|nodes| {
            let starts = prop::collection::vec(twist(0.6), nodes);
            let noise = prop::collection::vec(twist(0.15), 2 * nodes);
            let loops = prop::collection::vec((0..nodes, 0..nodes), 1..6);
            (starts, noise, loops)
        })
        .prop_map(|(starts, noise, loops)| {
            let truth: Vec<SE2> = (0..starts.len())
                .map(|k| SE2::new(k as f64 * 0.8, (k % 3) as f64 * 0.5, k as f64 * 0.4))
                .collect();
            let chain = (1..starts.len()).map(|k| (k - 1, k));
            let loops = loops.into_iter().filter(|(from, to)| from != to);
            let factors = chain
                .chain(loops)
                .zip(&noise)
                .map(|((from, to), noise)| Between {
                    from,
                    to,
                    measurement: truth[from].between(&truth[to]).boxplus(noise),
                    information: Matrix3::new(30.0, 2.0, 1.0, 2.0, 20.0, -3.0, 1.0, -3.0, 60.0),
                })
                .collect();
            let poses = truth
                .iter()
                .zip(&starts)
                .map(|(pose, start)| pose.boxplus(start))
                .collect();
            Graph { poses, factors }
        })
}

proptest! {
    #[test]
    fn levenberg_marquardt_never_raises_the_cost(graph in graph(), kernel in 0..3) {
        let kernel = [
            RobustKernel::None,
            RobustKernel::Huber { width: 1.0 },
            RobustKernel::Dcs { phi: 5.0 },
        ][kernel as usize];
        let mut problem = graph.problem(SE2::identity());
        let mut optimizer = Optimizer::new(Settings {
            method: Method::LevenbergMarquardt { initial_damping: 1e-4 },
            jacobians: JacobianModel::Exact,
            kernel,
            ..Settings::default()
        });
        let cost = |problem: &Problem| -> f64 {
            (0..problem.factors().len()).map(|k| kernel.cost(problem.factor_chi2(k))).sum()
        };
        for _ in 0..15 {
            let before = cost(&problem);
            let step = optimizer.step(&mut problem).unwrap();
            // 1e-12: the sum over the factors is rounded in another order here.
            prop_assert!(cost(&problem) <= before * (1.0 + 1e-12));
            if !step.accepted {
                prop_assert_eq!(cost(&problem), before);
            }
        }
    }

    #[test]
    fn a_rigid_motion_of_everything_changes_only_the_gauge(graph in graph(), world in twist(2.0)) {
        let world = SE2::exp(&world);
        let settings = Settings {
            method: Method::LevenbergMarquardt { initial_damping: 1e-4 },
            jacobians: JacobianModel::Exact,
            max_iterations: 12,
            step_tolerance: 0.0,
            ..Settings::default()
        };
        let mut here = graph.problem(SE2::identity());
        let mut there = graph.problem(world);
        let report_here = Optimizer::new(settings).run(&mut here);
        let report_there = Optimizer::new(settings).run(&mut there);
        // 1e-6: twelve iterations on poses whose last bits differ from the start.
        let scale = 1.0 + report_here.chi2_initial;
        prop_assert!((report_here.chi2 - report_there.chi2).abs() < 1e-6 * scale);
        if report_here.steps.iter().zip(&report_there.steps).all(|(a, b)| a.accepted == b.accepted) {
            for (a, b) in here.poses().iter().zip(there.poses()) {
                prop_assert!((world * *a).boxminus(b).norm() < 1e-5);
            }
        }
    }

    #[test]
    fn gauss_newton_stops_where_the_gradient_vanishes(graph in graph()) {
        let mut problem = graph.problem(SE2::identity());
        let report = Optimizer::new(Settings {
            jacobians: JacobianModel::Exact,
            max_iterations: 60,
            step_tolerance: 1e-9,
            ..Settings::default()
        })
        .run(&mut problem);
        prop_assume!(matches!(report.stop, StopReason::SmallStep { .. }));
        for node in 1..problem.node_count() {
            for axis in 0..3 {
                let mut delta = Vector3::zeros();
                delta[axis] = 1e-5;
                let pose = problem.poses()[node];
                problem.poses_mut()[node] = pose.boxplus(&delta);
                let up = problem.chi2();
                problem.poses_mut()[node] = pose.boxplus(&-delta);
                let down = problem.chi2();
                problem.poses_mut()[node] = pose;
                // 1e-4: rounding of χ² over 2e-5, and the curvature of a step of 1e-9.
                prop_assert!((up - down).abs() / 2e-5 < 1e-4 * (1.0 + report.chi2));
            }
        }
    }
}
