//! State kept between steps or graphs changes the time of a solve, not its result.

use nalgebra::{Matrix3, Vector3};
use pr_geom::SE2;
use pr_optim::{
    Between, FactorUse, JacobianModel, JointCovariance, Optimizer, Problem, Settings, StopReason,
};

/// A path around a square of `side` steps a side, with an error in every step, and the loop at its end.
fn square(side: usize, off: f64) -> Problem {
    let mut problem = Problem::new();
    let turned = |k: usize| if k.is_multiple_of(side) { 1.57 } else { 0.0 };
    let mut pose = SE2::identity();
    problem.add_fixed_pose(pose);
    for k in 1..4 * side {
        let step = SE2::new(1.0, 0.0, turned(k));
        pose = pose * step;
        let to = problem.add_pose(pose);
        let noise = Vector3::new(0.3, -0.2, 0.1) * (off * (k % 3) as f64);
        add(&mut problem, [to - 1, to], step.boxplus(&noise));
    }
    problem
}

fn add(problem: &mut Problem, [from, to]: [usize; 2], measurement: SE2) {
    problem.add_factor(Between {
        from,
        to,
        measurement,
        information: Matrix3::new(30.0, 2.0, 1.0, 2.0, 20.0, -3.0, 1.0, -3.0, 60.0),
    });
}

fn close(mut problem: Problem) -> Problem {
    let last = problem.node_count() - 1;
    add(&mut problem, [last, 0], SE2::new(1.0, 0.0, 1.57));
    problem
}

fn optimizer(factor_use: FactorUse) -> Optimizer {
    Optimizer::new(Settings {
        jacobians: JacobianModel::Exact,
        step_tolerance: 1e-9,
        factor_use,
        ..Settings::default()
    })
}

#[test]
fn a_reused_factor_gives_the_same_optimum() {
    // Loops with closing errors of centimetres, decimetres and metres.
    for off in [0.002, 0.03, 0.3] {
        let mut every = close(square(12, off));
        let mut kept = every.clone();
        let expected = optimizer(FactorUse::EveryStep).run(&mut every);
        let report = optimizer(FactorUse::WhileStepsShrink).run(&mut kept);
        assert!(matches!(report.stop, StopReason::SmallStep { .. }));
        for (a, b) in kept.poses().iter().zip(every.poses()) {
            assert!(a.between(b).log().norm() < 1e-8, "{off}: {a:?} {b:?}");
        }
        assert!((report.chi2 - expected.chi2).abs() < 1e-12 * expected.chi2_initial);
        // Factor reuse and the stop rule cost only a few short steps.
        assert!(report.iterations <= expected.iterations + 3, "{off}");
    }
}

#[test]
fn a_factor_is_not_reused_for_another_graph_or_after_a_covariance() {
    let open = square(12, 0.002);
    let closed = close(open.clone());
    let stepped = |optimizer: &mut Optimizer, problem: &Problem| {
        let mut problem = problem.clone();
        let step = optimizer.step(&mut problem).unwrap();
        (step.largest_step.to_bits(), problem.poses().to_vec())
    };
    let expected = stepped(&mut optimizer(FactorUse::EveryStep), &closed);
    let mut kept = optimizer(FactorUse::WhileStepsShrink);
    let _ = stepped(&mut kept, &open);
    assert_eq!(stepped(&mut kept, &closed), expected, "another graph");
    kept.joint_covariance(&closed, 5, 30).unwrap();
    assert_eq!(stepped(&mut kept, &closed), expected, "a covariance");
    kept.restart();
    assert_eq!(stepped(&mut kept, &closed), expected, "another solve");
}

#[test]
fn graphs_of_any_size_can_follow_each_other() {
    let mut kept = optimizer(FactorUse::WhileStepsShrink);
    let answers = |optimizer: &mut Optimizer, side: usize| -> (Vec<SE2>, JointCovariance) {
        let mut problem = close(square(side, 0.01));
        optimizer.run(&mut problem);
        let joint = optimizer.joint_covariance(&problem, side, 3 * side);
        (problem.poses().to_vec(), joint.unwrap())
    };
    for side in [20, 7, 40, 2, 20] {
        let fresh = answers(&mut optimizer(FactorUse::WhileStepsShrink), side);
        assert_eq!(answers(&mut kept, side), fresh, "{side}");
    }
}
