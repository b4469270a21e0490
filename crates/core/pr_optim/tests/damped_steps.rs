//! Stop conditions of a solve with damped steps.

use nalgebra::{Matrix3, Vector3};
use pr_geom::SE2;
use pr_optim::{Between, JacobianModel, Method, Optimizer, Problem, Settings, StopReason};

fn damped(jacobians: JacobianModel, initial_damping: f64) -> Settings {
    Settings {
        method: Method::LevenbergMarquardt { initial_damping },
        jacobians,
        max_iterations: 60,
        ..Settings::default()
    }
}

/// One free pose at the origin, measured from a fixed one with each of the given residuals.
fn seen_with(residuals: &[Vector3<f64>]) -> Problem {
    let mut problem = Problem::new();
    let from = problem.add_fixed_pose(SE2::identity());
    let to = problem.add_pose(SE2::identity());
    for residual in residuals {
        problem.add_factor(Between {
            from,
            to,
            measurement: SE2::exp(residual).inverse(),
            information: Matrix3::identity(),
        });
    }
    problem
}

/// Two measurements with rotation errors of +3 and −3 rad, for which the chapter's Jacobians point uphill.
///
/// With translation residuals `p` and `q` their gradient is `p + q`. The exact ones first rotate `p` and `q` by
/// nearly a right angle to opposite sides: if `q` is `p` rotated by 90°, the sum of the rotated residuals points
/// against `p + q`.
fn uphill() -> Problem {
    seen_with(&[Vector3::new(1.0, 0.0, 3.0), Vector3::new(0.0, 1.0, -3.0)])
}

#[test]
fn a_solve_with_only_rejected_steps_has_not_converged() {
    let mut problem = uphill();
    let mut optimizer = Optimizer::new(damped(JacobianModel::Chapter, 1.0));
    let report = optimizer.run(&mut problem);
    assert!(report.steps.iter().all(|step| !step.accepted));
    // The last steps are far below the tolerance of 1e-6, because of damping alone.
    assert!(report.steps.last().unwrap().largest_step < 1e-9);
    assert!(
        matches!(report.stop, StopReason::DampingLimit { damping, limit } if damping > limit),
        "{}",
        report.stop
    );
    assert!(!report.stop.is_converged());
    assert_eq!(problem.poses()[1], SE2::identity());
}

#[test]
fn a_step_that_damping_made_small_does_not_end_a_solve() {
    // Steps are accepted from the first on, but a damping of 1e9 shrinks them by 1e-9.
    let mut problem = seen_with(&[Vector3::new(1.0, 0.5, 0.2)]);
    let mut optimizer = Optimizer::new(Settings {
        decrease_tolerance: 1e-8,
        ..damped(JacobianModel::Exact, 1e9)
    });
    let report = optimizer.run(&mut problem);
    assert!(report.steps[0].accepted);
    assert!(report.steps[0].largest_step < 1e-8);
    assert!(report.stop.is_converged(), "{}", report.stop);
    assert!(report.iterations > 10);
    assert!(report.chi2 < 1e-8 * report.chi2_initial);
}

#[test]
fn the_predicted_decrease_of_a_small_step_is_accurate() {
    // The smaller the step, the better the model: at λ = 1e4 the rest is of third order.
    let mut problem = seen_with(&[Vector3::new(1.0, 0.5, 0.2), Vector3::new(-0.3, 0.1, 0.4)]);
    for (damping, tolerance) in [(1e2, 1e-2), (1e4, 1e-4)] {
        let mut optimizer = Optimizer::new(damped(JacobianModel::Exact, damping));
        let before = problem.chi2();
        let step = optimizer.step(&mut problem).unwrap();
        let gain = (before - problem.chi2()) / step.predicted_decrease;
        // Without λ δᵀDδ the prediction would be half of the actual decrease.
        assert!((gain - 1.0).abs() < tolerance, "{gain} at {damping}");
    }
}

#[test]
fn a_start_at_the_optimum_has_converged() {
    let residuals = [Vector3::new(1.0, 0.5, 0.2), Vector3::new(-0.3, 0.1, 0.4)];
    for step_tolerance in [1e-6, 1e-9] {
        let mut problem = seen_with(&residuals);
        let settings = Settings {
            step_tolerance,
            ..damped(JacobianModel::Exact, 1e-3)
        };
        Optimizer::new(Settings {
            step_tolerance: 0.0,
            method: Method::GaussNewton,
            ..settings
        })
        .run(&mut problem);
        let report = Optimizer::new(settings).run(&mut problem);
        assert!(report.stop.is_converged(), "{}", report.stop);
        // Only rounding is left to gain.
        assert!((report.chi2 - report.chi2_initial).abs() < 1e-14 * report.chi2);
    }
    // Zero residual: every predicted decrease is zero.
    let mut problem = seen_with(&[Vector3::zeros()]);
    let report = Optimizer::new(damped(JacobianModel::Exact, 1e-3)).run(&mut problem);
    assert_eq!(report.iterations, 1);
    assert!(report.stop.is_converged(), "{}", report.stop);
}

#[test]
fn gauss_newton_after_damped_steps_is_not_damped() {
    let residuals = [Vector3::new(1.0, 0.5, 0.2), Vector3::new(-0.3, 0.1, 0.4)];
    let mut problem = seen_with(&residuals);
    let mut optimizer = Optimizer::new(damped(JacobianModel::Exact, 10.0));
    optimizer.step(&mut problem).unwrap();
    optimizer.settings.method = Method::GaussNewton;
    let step = optimizer.step(&mut problem).unwrap();
    assert_eq!(step.damping, 0.0);
}
