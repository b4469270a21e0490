//! Guarantee of every solve: a finite result that costs no more than its start, or a typed error.
//!
//! The fuzz target `graphs` searches for graphs that violate it; these are its findings.

use nalgebra::Matrix3;
use pr_geom::SE2;
use pr_optim::{
    Between, JacobianModel, OptimizeError, Optimizer, Problem, RobustKernel, Settings,
    SolveSession, Start, StopReason,
};

/// Poses, the first of them fixed, and measurements with unit information.
fn problem(poses: &[[f64; 3]], measured: &[(usize, usize, [f64; 3])]) -> Problem {
    let mut problem = Problem::new();
    for &[x, y, theta] in poses {
        problem.add_pose(SE2::new(x, y, theta));
    }
    problem.fix(0);
    for &(from, to, [x, y, theta]) in measured {
        problem.add_factor(Between {
            from,
            to,
            measurement: SE2::new(x, y, theta),
            information: Matrix3::identity(),
        });
    }
    problem
}

/// Three contradictory measurements of one pose. With the chapter's Jacobians, Gauss–Newton converges
/// to a pose that costs more than the start.
fn contradiction() -> Problem {
    problem(
        &[[0.0; 3], [1.5, -1.0, 0.5]],
        &[
            (0, 1, [4.0, 3.5, -1.0]),
            (0, 1, [-2.5, -1.0, 0.0]),
            (0, 1, [3.0, -1.0, 3.0]),
        ],
    )
}

/// A square whose steps with the chapter's Jacobians first descend and then diverge.
fn square() -> Problem {
    problem(
        &[
            [0.0; 3],
            [1.5, -3.0, -1.5],
            [0.5, -3.0, 0.5],
            [3.5, 2.0, 2.0],
        ],
        &[
            (0, 1, [-0.5, -1.5, -2.0]),
            (1, 2, [-0.5, 2.5, -1.0]),
            (2, 3, [3.0, -2.0, 3.0]),
            (0, 3, [3.5, 3.5, -1.5]),
            (0, 3, [-1.5, 0.5, 0.5]),
        ],
    )
}

fn solver(max_iterations: usize) -> Optimizer {
    Optimizer::new(Settings {
        jacobians: JacobianModel::Chapter,
        max_iterations,
        ..Settings::default()
    })
}

#[test]
fn a_run_whose_steps_climb_above_the_start_restores_it() {
    let mut stepped = contradiction();
    let start = stepped.chi2();
    let mut optimizer = solver(100);
    for _ in 0..8 {
        optimizer.step(&mut stepped).unwrap();
    }
    assert!(stepped.chi2() > 1.3 * start, "{}", stepped.chi2());

    let mut solved = contradiction();
    let report = optimizer.run(&mut solved);
    assert!(report.stop.is_converged(), "{}", report.stop);
    assert_eq!(solved.poses(), contradiction().poses());
    assert_eq!(report.reverted_to, Some(0));
    assert_eq!((report.cost, report.chi2_initial), (start, start));
}

#[test]
fn steps_that_do_not_converge_end_at_the_best_poses() {
    let mut stepped = square();
    let mut optimizer = solver(8);
    let mut cheapest = (square().chi2(), square());
    for _ in 0..8 {
        optimizer.step(&mut stepped).unwrap();
        if stepped.chi2() < cheapest.0 {
            cheapest = (stepped.chi2(), stepped.clone());
        }
    }
    assert!(stepped.chi2() > 1.9 * square().chi2());

    let mut solved = square();
    let report = optimizer.run(&mut solved);
    assert_eq!(report.stop, StopReason::IterationLimit { limit: 8 });
    assert_eq!(report.cost, cheapest.0);
    assert_eq!(solved.poses(), cheapest.1.poses());
    let step = report.reverted_to.unwrap();
    assert_eq!(report.steps[step].cost_before, report.cost);
    // A session with a given start has the same guarantee.
    let mut optimizer = solver(8);
    let mut in_session = square();
    let session = SolveSession::new(&mut optimizer, &mut in_session, Start::Given).unwrap();
    assert_eq!(session.run().report, report);
    assert_eq!(in_session.poses(), solved.poses());
}

#[test]
fn a_run_that_descends_reverts_no_step() {
    let mut problem = contradiction();
    let report = Optimizer::new(Settings {
        jacobians: JacobianModel::Exact,
        max_iterations: 100,
        ..Settings::default()
    })
    .run(&mut problem);
    assert!(report.stop.is_converged(), "{}", report.stop);
    assert_eq!(report.reverted_to, None);
    assert!(report.cost < contradiction().chi2());
}

#[test]
fn overflowing_poses_are_unchanged_and_the_error_is_reported() {
    // The cost of a pose at 1e308 overflows, and so do the guesses from a measurement of 1e308.
    let far = |pose: f64, measured: f64| {
        problem(
            &[[0.0; 3], [pose, 0.0, 0.0], [1.0, 0.0, 0.0]],
            &[(0, 1, [measured, 0.0, 0.0]), (1, 2, [measured, 0.0, 0.0])],
        )
    };
    let starts = [
        Start::Auto,
        Start::Given,
        Start::SpanningTree,
        Start::Chordal,
        Start::LeastSquares,
    ];
    for kernel in [RobustKernel::None, RobustKernel::Dcs { phi: 1.0 }] {
        for start in starts {
            let mut unsolvable = far(1e308, 1e308);
            let mut optimizer = Optimizer::new(Settings {
                kernel,
                ..Settings::default()
            });
            let error = match SolveSession::new(&mut optimizer, &mut unsolvable, start) {
                Err(error) => error,
                Ok(session) => match session.run().report.stop {
                    StopReason::Failed { error } => error,
                    stop => panic!("{start:?}: {stop}"),
                },
            };
            assert_eq!(error, OptimizeError::NotFinite, "{start:?}");
            assert_eq!(unsolvable.poses(), far(1e308, 1e308).poses(), "{start:?}");
        }
    }
    // A tree of valid measurements leads back into the range of numbers.
    let mut lost = far(1e308, 1.0);
    let mut optimizer = Optimizer::new(Settings::default());
    let session = SolveSession::new(&mut optimizer, &mut lost, Start::Auto).unwrap();
    let outcome = session.run();
    assert_eq!(outcome.start, Start::SpanningTree);
    assert_eq!(outcome.report.cost, 0.0);
}
