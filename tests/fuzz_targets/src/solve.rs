//! Invariants of every solve, for any graph.

use pr_geom::SE2;
use pr_optim::{OptimizeError, Optimizer, Problem, Settings, SolveSession, Start, StopReason};

/// Solves, and checks that the result is finite and costs no more than its start, or that the error is typed.
pub fn solve(problem: &mut Problem, settings: Settings, start: Start) {
    let given = problem.poses().to_vec();
    let (cost, chi2) = problem.cost_and_chi2(settings.kernel);
    let can_start = cost.is_finite() && chi2.is_finite();
    let mut optimizer = Optimizer::new(settings);
    match SolveSession::new(&mut optimizer, problem, start).map(SolveSession::run) {
        Err(_) => assert_same(&given, problem.poses()),
        Ok(outcome) => {
            let report = outcome.report;
            if !(report.cost.is_finite() && report.chi2.is_finite()) {
                let error = OptimizeError::NotFinite;
                assert_eq!(report.stop, StopReason::Failed { error });
                assert_same(&given, problem.poses());
                let asked = (start, settings);
                assert!(!can_start, "{asked:?} at {cost:e}, {chi2:e}: {report:?}");
                return;
            }
            assert_finite(problem);
            let ended = problem.cost_and_chi2(settings.kernel).0;
            assert_eq!(report.cost.to_bits(), ended.to_bits(), "the report's cost");
            if let Some(first) = report.steps.first() {
                assert!(
                    report.cost <= first.cost_before,
                    "{report:?} began at {first:?}"
                );
            }
            if can_start && matches!(start, Start::Auto | Start::Given) {
                assert!(report.cost <= cost, "{} above {cost}", report.cost);
            }
        }
    }
    for (node, is_fixed) in problem.fixed().iter().enumerate() {
        if *is_fixed {
            // Adding 0 to −0 gives 0.
            assert_eq!(given[node], problem.poses()[node], "node {node} is fixed");
        }
    }
}

/// Asserts that the poses have equal bits.
fn assert_same(expected: &[SE2], found: &[SE2]) {
    let bits = |pose: &SE2| pose.to_array().map(f64::to_bits);
    assert!(
        expected.iter().map(bits).eq(found.iter().map(bits)),
        "{found:?} instead of {expected:?}"
    );
}

fn assert_finite(problem: &Problem) {
    for (node, pose) in problem.poses().iter().enumerate() {
        let is_finite = pose.to_array().iter().all(|value| value.is_finite());
        assert!(is_finite, "node {node} at {pose:?}");
    }
}
