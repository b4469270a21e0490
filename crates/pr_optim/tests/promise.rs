//! What every solve promises: a finite result that costs no more than its start, or a typed error.
//!
//! The fuzz target `graphs` looks for graphs that break it; these are the ones that led to it.

use nalgebra::Matrix3;
use pr_geom::SE2;
use pr_optim::{
    Between, JacobianModel, OptimizeError, Optimizer, Problem, RobustKernel, Session, Settings,
    Start, StopReason,
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

/// Three measurements of one pose that contradict each other. The chapter's Jacobians lead
/// Gauss–Newton to a place where its steps end, and that costs more than the start.
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

/// A square whose steps with the chapter's Jacobians first descend and then climb without end.
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
fn full_steps_climb_above_the_start_and_a_run_gives_the_start_back() {
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
    assert_eq!(report.went_back_to, Some(0));
    assert_eq!((report.cost, report.chi2_initial), (start, start));
}

#[test]
fn steps_that_do_not_converge_end_at_the_best_poses_on_the_way() {
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
    let step = report.went_back_to.unwrap();
    assert_eq!(report.steps[step].cost_before, report.cost);
    // A session that is told where to start keeps the same promise.
    let mut optimizer = solver(8);
    let mut in_session = square();
    let session = Session::new(&mut optimizer, &mut in_session, Start::Given).unwrap();
    assert_eq!(session.run().report, report);
    assert_eq!(in_session.poses(), solved.poses());
}

#[test]
fn a_run_that_descends_goes_nowhere_back() {
    let mut problem = contradiction();
    let report = Optimizer::new(Settings {
        jacobians: JacobianModel::Exact,
        max_iterations: 100,
        ..Settings::default()
    })
    .run(&mut problem);
    assert!(report.stop.is_converged(), "{}", report.stop);
    assert_eq!(report.went_back_to, None);
    assert!(report.cost < contradiction().chi2());
}

#[test]
fn poses_beyond_all_numbers_stay_as_they_came_and_the_error_says_why() {
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
            let mut hopeless = far(1e308, 1e308);
            let mut optimizer = Optimizer::new(Settings {
                kernel,
                ..Settings::default()
            });
            let error = match Session::new(&mut optimizer, &mut hopeless, start) {
                Err(error) => error,
                Ok(session) => match session.run().report.stop {
                    StopReason::Failed { error } => error,
                    stop => panic!("{start:?}: {stop}"),
                },
            };
            assert_eq!(error, OptimizeError::NotFinite, "{start:?}");
            assert_eq!(hopeless.poses(), far(1e308, 1e308).poses(), "{start:?}");
        }
    }
    // A tree of measurements that are not at fault leads back into the range of numbers.
    let mut lost = far(1e308, 1.0);
    let mut optimizer = Optimizer::new(Settings::default());
    let session = Session::new(&mut optimizer, &mut lost, Start::Auto).unwrap();
    let outcome = session.run();
    assert_eq!(outcome.start, Start::SpanningTree);
    assert_eq!(outcome.report.cost, 0.0);
}
