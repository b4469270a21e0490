//! The block factorization against `faer`'s, on random graphs.

use faer::linalg::solvers::Solve;
use faer::sparse::linalg::LltError;
use faer::sparse::linalg::solvers::Llt;
use faer::sparse::{SparseColMat, Triplet};
use faer::{ColRef, Side};
use nalgebra::{Matrix3, Vector3};
use pr_geom::SE2;
use pr_optim::structure::Structure;
use pr_optim::system::NormalEquations;
use pr_optim::{Between, JacobianModel, LinearSolver, OptimizeError, Problem, RobustKernel};
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

/// The solver of `problem` and its normal equations.
fn assembled(problem: &Problem, ridge: f64) -> (LinearSolver, NormalEquations) {
    let linear = LinearSolver::new(problem);
    let mut equations = NormalEquations::default();
    let (model, kernel) = (JacobianModel::Exact, RobustKernel::None);
    equations.assemble(problem, linear.structure(), model, kernel, ridge);
    (linear, equations)
}

/// `faer`'s factorization of the same equations; only the lower triangle is read.
fn by_faer(
    structure: &Structure,
    equations: &NormalEquations,
    damping: f64,
) -> Result<Llt<usize, f64>, LltError> {
    let mut entries = Vec::new();
    let mut put = |row: usize, column: usize, block: &[f64; 9]| {
        for (k, &value) in block.iter().enumerate() {
            let (row, column) = (3 * row + k % 3, 3 * column + k / 3);
            let scale = 1.0 + if row == column { damping } else { 0.0 };
            entries.push(Triplet::new(row, column, value * scale));
        }
    };
    for (column, diagonal) in equations.diagonal.iter().enumerate() {
        put(column, column, diagonal);
        let below = &equations.lower[structure.slots_of(column)];
        for (&row, block) in structure.rows_of(column).iter().zip(below) {
            put(row as usize, column, block);
        }
    }
    let size = equations.gradient.len();
    let matrix = SparseColMat::try_new_from_triplets(size, size, &entries).unwrap();
    matrix.sp_cholesky(Side::Lower)
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
        let (mut linear, equations) = assembled(&problem, 1e-9);
        linear.factorize(&equations, damping).unwrap();
        let mut block = equations.gradient.clone();
        linear.solve(&mut block);
        let faer = by_faer(linear.structure(), &equations, damping).unwrap();
        let rhs = ColRef::from_slice(&equations.gradient);
        let faer = faer.solve(rhs);
        let size = faer.iter().fold(0.0_f64, |size, value| size.max(value.abs()));
        for (a, b) in block.iter().zip(faer.iter()) {
            // 1e-9: rounding in another order, times a condition number of up to a million.
            prop_assert!((a - b).abs() <= 1e-9 * (1.0 + size), "{a} {b}");
        }
    }
}

#[test]
fn both_find_the_unconstrained_node() {
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
    let (mut linear, equations) = assembled(&problem, 0.0);
    let node = linear.structure().node_at[1] as usize;
    assert_eq!(
        linear.factorize(&equations, 0.0),
        Err(OptimizeError::NotPositiveDefinite { node })
    );
    assert!(by_faer(linear.structure(), &equations, 0.0).is_err());
}
