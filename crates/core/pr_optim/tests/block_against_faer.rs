//! The block factorization against `faer`'s, on random graphs.

use nalgebra::{Matrix3, Vector3};
use pr_geom::SE2;
use pr_optim::system::NormalEquations;
use pr_optim::{Between, Factorization, JacobianModel, LinearSolver, Problem, RobustKernel};
use proptest::prelude::*;

/// A chain of `nodes` poses with loops between the given pairs.
fn graph(nodes: usize, loops: &[(usize, usize)], twists: &[[f64; 3]]) -> Problem {
    let mut problem = Problem::new();
    let mut pose = SE2::identity();
    problem.add_fixed_pose(pose);
    for [x, y, w] in &twists[1..nodes] {
        pose = pose.boxplus(&Vector3::new(1.0 + x, *y, *w));
        problem.add_pose(pose);
    }
    let chain = (1..nodes).map(|k| (k - 1, k));
    let loops = loops.iter().map(|&(a, b)| (a % nodes, b % nodes));
    for (from, to) in chain.chain(loops).filter(|(from, to)| from != to) {
        let [x, y, w] = twists[(from + 7 * to) % nodes];
        let poses = problem.poses();
        let measurement = poses[from]
            .between(&poses[to])
            .boxplus(&Vector3::new(y, w, x));
        problem.add_factor(Between {
            from,
            to,
            measurement,
            information: Matrix3::new(30.0, 2.0, 1.0, 2.0, 20.0, -3.0, 1.0, -3.0, 60.0),
        });
    }
    problem
}

fn solve(problem: &Problem, factorization: Factorization, damping: f64) -> Vec<f64> {
    let mut linear = LinearSolver::new(problem, factorization);
    let mut equations = NormalEquations::default();
    equations.assemble(
        problem,
        linear.structure(),
        JacobianModel::Exact,
        RobustKernel::None,
        1e-9,
    );
    linear.factorize(&equations, damping).unwrap();
    let mut solution = equations.gradient.clone();
    linear.solve(&mut solution);
    solution
}

proptest! {
    #[test]
    fn both_factorizations_give_the_same_step(
        nodes in 2_usize..120,
        loops in prop::collection::vec((0_usize..120, 0_usize..120), 0..80),
        twists in prop::collection::vec([-0.5..0.5, -0.5..0.5, -0.5..0.5], 120),
        damping in prop::sample::select(vec![0.0, 1e-3, 10.0]),
    ) {
        let problem = graph(nodes, &loops, &twists);
        let block = solve(&problem, Factorization::Block, damping);
        let faer = solve(&problem, Factorization::Faer, damping);
        let size = faer.iter().fold(0.0_f64, |size, value| size.max(value.abs()));
        for (a, b) in block.iter().zip(&faer) {
            // 1e-9: rounding in another order, times a condition number of up to a million.
            prop_assert!((a - b).abs() <= 1e-9 * (1.0 + size), "{a} {b}");
        }
    }
}

#[test]
fn both_report_the_unconstrained_node() {
    // No fixed pose and no ridge: the last pivot of the component is zero or negative.
    let mut problem = Problem::new();
    problem.add_pose(SE2::identity());
    problem.add_pose(SE2::identity());
    problem.add_factor(Between {
        from: 0,
        to: 1,
        measurement: SE2::identity(),
        information: Matrix3::identity(),
    });
    for factorization in [Factorization::Block, Factorization::Faer] {
        let mut linear = LinearSolver::new(&problem, factorization);
        let mut equations = NormalEquations::default();
        equations.assemble(
            &problem,
            linear.structure(),
            JacobianModel::Chapter,
            RobustKernel::None,
            0.0,
        );
        let last = linear.structure().node_at[1] as usize;
        let error = linear.factorize(&equations, 0.0).unwrap_err();
        assert_eq!(
            error,
            pr_optim::OptimizeError::NotPositiveDefinite { node: last }
        );
    }
}
