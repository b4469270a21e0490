//! Covariances from the sparse factor against the inverse of the dense matrix.

use nalgebra::{DMatrix, Matrix3, Vector3};
use pr_geom::SE2;
use pr_optim::{
    Between, JacobianModel, OptimizeError, Optimizer, PreparedFactor, PreparedPose, Problem,
    RobustKernel, Settings,
};

/// Poses on a lawnmower path, four a line, with links to the line before; the second is fixed.
fn grid(nodes: usize) -> Problem {
    let mut problem = Problem::new();
    for k in 0..nodes {
        let (line, place) = (k / 4, k % 4);
        let x = if line % 2 == 0 { place } else { 3 - place };
        let pose = SE2::new(x as f64, line as f64, 0.3 * k as f64);
        if k == 1 {
            problem.add_fixed_pose(pose);
        } else {
            problem.add_pose(pose);
        }
    }
    let chain = (1..nodes).map(|k| (k - 1, k));
    let links = [(0, 7), (2, 5), (6, 9), (11, 4), (3, 4)];
    let links = (0..nodes)
        .step_by(12)
        .flat_map(|start| links.map(|(a, b)| (start + a, start + b)));
    for (from, to) in chain.chain(links) {
        let noise = Vector3::new(0.02, -0.03, 0.01) * (1.0 + (from + to) as f64 / 5.0);
        let information = Matrix3::new(30.0, 2.0, 1.0, 2.0, 20.0, -3.0, 1.0, -3.0, 60.0);
        measure(&mut problem, [from, to], &noise, information);
    }
    problem
}

/// Adds a measurement with this error.
fn measure(
    problem: &mut Problem,
    [from, to]: [usize; 2],
    noise: &Vector3<f64>,
    information: Matrix3<f64>,
) {
    let [start, end] = [from, to].map(|node| problem.poses()[node]);
    problem.add_factor(Between {
        from,
        to,
        measurement: start.between(&end).boxplus(noise),
        information,
    });
}

/// The dense inverse of JᵀΩJ over all poses, rows and columns of fixed poses zero.
fn dense_covariance(problem: &Problem) -> DMatrix<f64> {
    let nodes = problem.node_count();
    let mut hessian = DMatrix::<f64>::zeros(3 * nodes, 3 * nodes);
    for factor in problem.factors() {
        let part = PreparedFactor::new(factor).linearize(
            &PreparedPose::new(&problem.poses()[factor.from]),
            &PreparedPose::new(&problem.poses()[factor.to]),
            JacobianModel::Exact,
            RobustKernel::None,
        );
        let symmetric =
            |[xx, xy, xt, yy, yt, tt]: [f64; 6]| Matrix3::new(xx, xy, xt, xy, yy, yt, xt, yt, tt);
        let off_diagonal = Matrix3::from_column_slice(&part.to_from);
        let mut add = |row: usize, column: usize, block: Matrix3<f64>| {
            let mut view = hessian.fixed_view_mut::<3, 3>(3 * row, 3 * column);
            view += block;
        };
        add(factor.from, factor.from, symmetric(part.from_from));
        add(factor.to, factor.to, symmetric(part.to_to));
        add(factor.to, factor.from, off_diagonal);
        add(factor.from, factor.to, off_diagonal.transpose());
    }
    let free: Vec<usize> = (0..3 * nodes).filter(|k| !problem.fixed()[k / 3]).collect();
    let inverse = DMatrix::from_fn(free.len(), free.len(), |a, b| hessian[(free[a], free[b])])
        .try_inverse()
        .expect("positive definite");
    let mut covariance = DMatrix::zeros(3 * nodes, 3 * nodes);
    for (a, &row) in free.iter().enumerate() {
        for (b, &column) in free.iter().enumerate() {
            covariance[(row, column)] = inverse[(a, b)];
        }
    }
    covariance
}

#[test]
fn every_marginal_and_every_pair_equals_the_dense_inverse() {
    let nodes = 36;
    let problem = grid(nodes);
    let dense = dense_covariance(&problem);
    let block = |a: usize, b: usize| dense.fixed_view::<3, 3>(3 * a, 3 * b).into_owned();
    // The dense matrix has no ridge either.
    let mut optimizer = Optimizer::new(Settings {
        ridge: 0.0,
        ..Settings::default()
    });
    let marginals = optimizer.marginals(&problem).unwrap();
    // 1e-10: rounding in another order, times a condition number of up to a million.
    for (a, marginal) in marginals.iter().enumerate() {
        assert!((marginal - block(a, a)).amax() < 1e-10, "node {a}");
        for b in 0..nodes {
            let joint = optimizer.joint_covariance(&problem, a, b).unwrap();
            assert!((joint.first - block(a, a)).amax() < 1e-10, "{a} {b}");
            assert!((joint.cross - block(a, b)).amax() < 1e-10, "{a} {b}");
            assert!((joint.second - block(b, b)).amax() < 1e-10, "{a} {b}");
        }
    }
    let measured = optimizer.measured_covariances(&problem).unwrap();
    assert_eq!(measured.len(), problem.factors().len());
    for (joint, factor) in measured.iter().zip(problem.factors()) {
        let (a, b) = (factor.from, factor.to);
        assert!((joint.first - block(a, a)).amax() < 1e-10, "{a} {b}");
        assert!((joint.cross - block(a, b)).amax() < 1e-10, "{a} {b}");
        assert!((joint.second - block(b, b)).amax() < 1e-10, "{a} {b}");
    }
    assert!(
        marginals[nodes - 1].trace() > marginals[2].trace(),
        "far is less certain"
    );
    assert_eq!(marginals[1], Matrix3::zeros());
}

#[test]
fn along_a_chain_the_relative_covariance_is_that_of_the_one_measurement() {
    let mut problem = Problem::new();
    problem.add_fixed_pose(SE2::identity());
    let step = SE2::new(1.0, 0.2, 0.4);
    let information = Matrix3::new(30.0, 2.0, 1.0, 2.0, 20.0, -3.0, 1.0, -3.0, 60.0);
    for from in 0..5 {
        let pose = problem.poses()[from] * step;
        problem.add_pose(pose);
        problem.add_factor(Between {
            from,
            to: from + 1,
            measurement: step,
            information,
        });
    }
    let mut optimizer = Optimizer::new(Settings::default());
    let joint = optimizer.joint_covariance(&problem, 3, 4).unwrap();
    let relative = joint.relative(&problem.poses()[3], &problem.poses()[4]);
    let expected = information.try_inverse().unwrap();
    // 1e-8: the ridge. Either pose alone is far less certain than the step between them.
    assert!((relative - expected).amax() < 1e-8);
    assert!(joint.first.trace() > 3.0 * expected.trace());
}

/// A graph that ends with one measurement for each node: two branches, one of them measured backwards.
fn grid_with_tail() -> Problem {
    let mut problem = grid(24);
    for (from, to) in [(23, 24), (25, 24), (20, 26), (26, 27), (25, 28)] {
        let parent = problem.poses()[usize::min(from, to)];
        problem.add_pose(parent * SE2::new(0.8, -0.1 * from as f64, 0.2 * to as f64));
        let noise = Vector3::new(0.02, 0.01, -0.03);
        let information = Matrix3::new(25.0, -2.0, 1.0, -2.0, 40.0, 3.0, 1.0, 3.0, 90.0);
        measure(&mut problem, [from, to], &noise, information);
    }
    problem
}

/// Compares the blocks of all pairs, one after the other, with the dense inverse.
fn assert_that_every_pair_equals_the_dense_inverse(problem: &Problem) {
    let dense = dense_covariance(problem);
    let block = |a: usize, b: usize| dense.fixed_view::<3, 3>(3 * a, 3 * b).into_owned();
    let mut optimizer = Optimizer::new(Settings {
        ridge: 0.0,
        ..Settings::default()
    });
    for a in 0..problem.node_count() {
        for b in 0..problem.node_count() {
            let joint = optimizer.joint_covariance(problem, a, b).unwrap();
            // 1e-10: as above.
            assert!((joint.first - block(a, a)).amax() < 1e-10, "{a} {b}");
            assert!((joint.cross - block(a, b)).amax() < 1e-10, "{a} {b}");
            assert!((joint.second - block(b, b)).amax() < 1e-10, "{a} {b}");
        }
    }
}

#[test]
fn covariances_after_the_last_loop_follow_by_propagation() {
    assert_that_every_pair_equals_the_dense_inverse(&grid_with_tail());
}

/// [`grid_with_tail`] with loops from its end, one of them between two early nodes.
fn grid_with_loops() -> Problem {
    let mut problem = grid_with_tail();
    for (from, to) in [(28, 3), (5, 17), (27, 24), (2, 26)] {
        let noise = Vector3::new(-0.04, 0.03, 0.02);
        let information = Matrix3::new(50.0, 4.0, -1.0, 4.0, 30.0, 2.0, -1.0, 2.0, 80.0);
        measure(&mut problem, [from, to], &noise, information);
    }
    problem
}

#[test]
fn later_loops_update_the_covariances_of_the_prefix() {
    let mut problem = grid_with_loops();
    // Some of its loops belong to the prefix; the last ones, and those of the grid's end, do not.
    for optimized in [0, 31, problem.factors().len() - 4, problem.factors().len()] {
        problem.mark_optimized(optimized);
        assert_that_every_pair_equals_the_dense_inverse(&problem);
    }
}

#[test]
fn a_measurement_far_more_certain_than_the_graph_is_factorized() {
    let mut problem = grid_with_tail();
    problem.mark_optimized(problem.factors().len());
    let measurement = problem.poses()[3].between(&problem.poses()[28]);
    let nearly_sure = Between {
        from: 3,
        to: 28,
        measurement,
        information: Matrix3::identity() * 1e15,
    };
    problem.add_factor(nearly_sure);
    let relative = |problem: &Problem| {
        let joint = Optimizer::new(Settings::default()).joint_covariance(problem, 3, 28);
        joint
            .unwrap()
            .relative(&problem.poses()[3], &problem.poses()[28])
    };
    let known = relative(&problem);
    let far = Optimizer::new(Settings::default()).largest_move_since(&problem);
    assert_eq!(far, Ok(f64::INFINITY), "unknown");
    problem.mark_optimized(problem.factors().len());
    assert_eq!(known, relative(&problem));
    // A matrix that is not positive definite is reported when it is added, as when it is factorized.
    problem.pop_factor();
    problem.add_factor(Between {
        information: Matrix3::identity() * -1e3,
        ..nearly_sure
    });
    let mut optimizer = Optimizer::new(Settings::default());
    let rejected = optimizer.joint_covariance(&problem, 3, 28);
    assert!(matches!(
        rejected,
        Err(OptimizeError::NotPositiveDefinite { .. })
    ));
}

#[test]
fn the_largest_move_by_loops_is_that_of_a_step() {
    let mut problem = grid_with_tail();
    let mut optimizer = Optimizer::new(Settings {
        jacobians: JacobianModel::Exact,
        step_tolerance: 1e-12,
        ..Settings::default()
    });
    optimizer.run(&mut problem);
    assert_eq!(optimizer.largest_move_since(&problem), Ok(0.0));
    let loops = grid_with_loops();
    for &factor in &loops.factors()[loops.factors().len() - 4..] {
        problem.add_factor(factor);
        let expected = optimizer.largest_move_since(&problem).unwrap();
        let step = optimizer.step(&mut problem.clone()).unwrap().largest_step;
        assert!((expected - step).abs() < 1e-9 * step, "{expected} {step}");
        assert!(step > 1e-3);
    }
    for _ in 0..4 {
        problem.add_factor(loops.factors()[3]);
    }
    assert_eq!(optimizer.largest_move_since(&problem), Ok(f64::INFINITY));
}

#[test]
fn a_covariance_has_the_same_bits_whatever_was_queried_before() {
    let whole = grid_with_loops();
    let mut problem = grid(24);
    problem.mark_optimized(problem.factors().len());
    let mut kept = Optimizer::new(Settings::default());
    let fresh = |problem: &Problem, a, b| {
        Optimizer::new(Settings::default()).joint_covariance(problem, a, b)
    };
    let new = problem.factors().len()..;
    for &factor in &whole.factors()[new] {
        let newest = factor.from.max(factor.to).max(problem.node_count() - 1);
        if newest == problem.node_count() {
            problem.add_pose(whole.poses()[newest]);
        }
        problem.add_factor(factor);
        for old in [2, newest - 3] {
            let joint = kept.joint_covariance(&problem, old, newest);
            assert_eq!(joint, fresh(&problem, old, newest), "{old} {newest}");
        }
    }
    // The kept factor is of other poses, other values, or another ridge.
    kept.step(&mut problem).unwrap();
    assert_eq!(
        kept.joint_covariance(&problem, 2, 28),
        fresh(&problem, 2, 28)
    );
    problem.poses_mut()[7] = SE2::new(3.0, 1.2, 0.4);
    assert_eq!(
        kept.joint_covariance(&problem, 2, 28),
        fresh(&problem, 2, 28)
    );
    kept.linear_for(&problem);
    kept.marginals(&problem).unwrap();
    assert_eq!(
        kept.joint_covariance(&problem, 2, 28),
        fresh(&problem, 2, 28)
    );
    kept.settings.ridge = 0.5;
    let ridged = kept.joint_covariance(&problem, 2, 28).unwrap();
    assert!(ridged.second.trace() < 0.9 * fresh(&problem, 2, 28).unwrap().second.trace());
}
