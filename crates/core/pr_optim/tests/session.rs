//! Initial guesses, local minima and outliers.

use core::f64::consts::TAU;

use nalgebra::Matrix3;
use pr_geom::SE2;
use pr_optim::{
    Between, JacobianModel, Method, Optimizer, Problem, RobustKernel, SessionOutcome, Settings,
    SolveSession, Start,
};

const NODES: usize = 24;

/// A ring with consistent measurements, and initial poses that wind `turns` times around it.
fn ring(turns: f64) -> Problem {
    ring_measured(turns, 1.0)
}

/// [`ring`] with measurements that wind `measured_turns` times around it.
fn ring_measured(turns: f64, measured_turns: f64) -> Problem {
    let step = |turns: f64| SE2::new(1.0, 0.0, turns * TAU / NODES as f64);
    let mut problem = Problem::new();
    let mut pose = SE2::identity();
    problem.add_fixed_pose(pose);
    for _ in 1..NODES {
        pose = pose * step(turns);
        problem.add_pose(pose);
    }
    for from in 0..NODES {
        problem.add_factor(Between {
            from,
            to: (from + 1) % NODES,
            measurement: step(measured_turns),
            information: Matrix3::identity() * 100.0,
        });
    }
    problem
}

fn solve(problem: &mut Problem, start: Start, kernel: RobustKernel) -> SessionOutcome {
    let mut optimizer = Optimizer::new(Settings {
        jacobians: JacobianModel::Exact,
        kernel,
        max_iterations: 100,
        step_tolerance: 1e-9,
        ..Settings::default()
    });
    let session = SolveSession::new(&mut optimizer, problem, start).unwrap();
    session.run()
}

#[test]
fn automatic_start_escapes_the_local_minimum_of_a_ring_wound_twice() {
    let mut stuck = ring(2.0);
    let outcome = solve(&mut stuck, Start::Given, RobustKernel::None);
    // The heading error of every edge is 2π/24: at least 24 · 100 · 0.2618² = 164.
    assert!(
        outcome.report.stop.is_converged(),
        "{}",
        outcome.report.stop
    );
    assert!(outcome.report.chi2 > 164.0);
    for start in [Start::Auto, Start::SpanningTree, Start::Chordal] {
        let mut problem = ring(2.0);
        let outcome = solve(&mut problem, start, RobustKernel::None);
        assert!(outcome.report.chi2 < 1e-12, "{start:?}");
    }
}

/// A ring whose headings sum up to a closing error of `radians`, with uninformative poses: the tree leaves all of
/// it to one measurement.
fn ring_opened_by(radians: f64) -> Problem {
    let mut problem = ring_measured(1.0, (TAU + radians) / TAU);
    problem.poses_mut().fill(SE2::identity());
    problem
}

#[test]
fn a_start_with_a_high_first_gain_ratio_is_followed() {
    let outcome = solve(&mut ring_opened_by(0.1), Start::Auto, RobustKernel::None);
    assert_eq!(outcome.start, Start::SpanningTree);
    let [given, tree] = outcome.tried.as_slice() else {
        panic!("{:?}", outcome.tried);
    };
    assert_eq!((given.start, given.stop), (Start::Given, None));
    assert_eq!(
        (tree.start, tree.cost),
        (Start::SpanningTree, outcome.report.cost)
    );
    assert!(tree.cost_initial < given.cost_initial);
    assert_eq!(outcome.total_iterations, tree.iterations);
}

#[test]
fn a_consistent_graph_is_solved_at_once() {
    let mut problem = Problem::new();
    problem.add_fixed_pose(SE2::identity());
    problem.add_pose(SE2::from_xy(1.0, 0.0));
    problem.add_factor(Between {
        from: 0,
        to: 1,
        measurement: SE2::from_xy(1.0, 0.0),
        information: Matrix3::identity(),
    });
    let mut optimizer = Optimizer::new(Settings {
        step_tolerance: 0.0,
        decrease_tolerance: 1e-8,
        ..Settings::default()
    });
    let report = optimizer.run(&mut problem);
    assert_eq!(report.iterations, 1);
    assert!(report.stop.is_converged(), "{}", report.stop);
}

#[test]
fn automatic_start_keeps_given_poses_that_are_the_better_guess() {
    // The tree contains a long measurement that is wrong and has low information.
    let mut problem = ring(1.0);
    problem.add_factor(Between {
        from: 0,
        to: NODES / 2,
        measurement: SE2::identity(),
        information: Matrix3::identity() * 1e-3,
    });
    let outcome = solve(
        &mut problem,
        Start::Auto,
        RobustKernel::Huber { width: 1.0 },
    );
    assert_eq!(outcome.start, Start::Given);
    assert!(
        outcome.report.stop.is_converged(),
        "{}",
        outcome.report.stop
    );
}

#[test]
fn a_kernel_rejects_a_false_loop_that_bends_least_squares() {
    let far = NODES / 2;
    let error = |kernel| {
        let mut problem = ring(1.0);
        let truth = problem.poses()[far];
        problem.add_factor(Between {
            from: 0,
            to: far,
            measurement: SE2::identity(),
            information: Matrix3::identity() * 100.0,
        });
        solve(&mut problem, Start::Given, kernel);
        problem.poses()[far].boxminus(&truth).norm()
    };
    assert!(error(RobustKernel::None) > 0.5);
    assert!(error(RobustKernel::Dcs { phi: 1.0 }) < 0.01);
}

/// A ring with a measurement that contradicts it by half a turn: every minimum is suspicious.
fn untrusted_ring() -> Problem {
    let mut problem = ring(1.0);
    problem.add_factor(Between {
        from: 0,
        to: 1,
        measurement: SE2::new(1.0, 0.0, 2.9),
        information: Matrix3::identity() * 100.0,
    });
    problem
}

fn stubborn() -> Optimizer {
    Optimizer::new(Settings {
        jacobians: JacobianModel::Exact,
        max_iterations: 40,
        ..Settings::default()
    })
}

#[test]
fn the_original_method_is_restored_after_the_fallback() {
    let mut problem = untrusted_ring();
    let mut optimizer = stubborn();
    let session = SolveSession::new(&mut optimizer, &mut problem, Start::Auto).unwrap();
    let outcome = session.run();
    assert_eq!(optimizer.settings.method, Method::GaussNewton);
    assert_eq!(problem.chi2(), outcome.report.chi2);
    assert!(outcome.total_iterations > outcome.report.iterations);
}

#[test]
fn a_session_dropped_during_the_fallback_restores_the_method() {
    let mut problem = untrusted_ring();
    let mut optimizer = stubborn();
    let mut session = SolveSession::new(&mut optimizer, &mut problem, Start::Auto).unwrap();
    while session.last_step().is_none_or(|step| step.damping == 0.0) {
        assert!(session.step(), "the fallback takes damped steps");
    }
    drop(session);
    assert_eq!(optimizer.settings.method, Method::GaussNewton);
    let step = optimizer.step(&mut problem).unwrap();
    assert_eq!(step.damping, 0.0);
}

/// [`ring_opened_by`] 0.5 rad.
fn open_ring() -> Problem {
    ring_opened_by(0.5)
}

const DCS: RobustKernel = RobustKernel::Dcs { phi: 1.0 };

#[test]
fn automatic_start_with_a_kernel_keeps_true_measurements_that_a_guess_rejects() {
    let tree = solve(&mut open_ring(), Start::SpanningTree, DCS);
    // One measurement has an error of 0.5 rad, s = 100 · 0.25 = 25: alone it costs 3 − 4/26 = 2.8.
    assert!(tree.report.stop.is_converged());
    assert!(tree.report.cost > 2.0, "{}", tree.report.cost);
    let mut problem = open_ring();
    let outcome = solve(&mut problem, Start::Auto, DCS);
    assert_eq!(outcome.start, Start::LeastSquares);
    assert!(outcome.report.stop.is_converged());
    // Distributed over 24 measurements, 24 · 100 · (0.5/24)² = 1.04 for the headings alone, and none is
    // beyond φ: the least-squares optimum is the optimum with the kernel.
    let plain = solve(&mut open_ring(), Start::Auto, RobustKernel::None);
    assert!(plain.report.chi2 < 1.05, "{}", plain.report.chi2);
    // 1e-9: both stop at steps below 1e-9, and the cost is flat there.
    assert!((outcome.report.cost - plain.report.chi2).abs() < 1e-9);
    assert_eq!(problem.cost_and_chi2(DCS).0, outcome.report.cost);
}

#[test]
fn automatic_start_with_a_kernel_keeps_the_guess_if_least_squares_diverges() {
    let far = NODES / 2;
    let mut problem = ring(1.0);
    let truth = problem.poses()[far];
    problem.add_factor(Between {
        from: 0,
        to: far,
        measurement: SE2::identity(),
        information: Matrix3::identity() * 100.0,
    });
    let given = solve(&mut problem.clone(), Start::Given, DCS);
    let outcome = solve(&mut problem, Start::Auto, DCS);
    assert!(outcome.report.cost <= given.report.cost);
    assert!(problem.poses()[far].boxminus(&truth).norm() < 0.01);
}

#[test]
fn a_session_that_ends_early_reports_the_cost_with_the_kernel() {
    let settings = Settings {
        jacobians: JacobianModel::Exact,
        kernel: DCS,
        step_tolerance: 1e-9,
        ..Settings::default()
    };
    let whole = solve(&mut open_ring(), Start::Auto, DCS).total_iterations;
    for steps in 0..=whole {
        let mut problem = open_ring();
        let mut optimizer = Optimizer::new(settings);
        let mut session = SolveSession::new(&mut optimizer, &mut problem, Start::Auto).unwrap();
        for _ in 0..steps {
            session.step();
        }
        let outcome = session.finish();
        let cost = problem.cost_and_chi2(DCS).0;
        assert_eq!(cost, outcome.report.cost, "after {steps} steps");
        assert_eq!(optimizer.settings, settings);
    }
}
