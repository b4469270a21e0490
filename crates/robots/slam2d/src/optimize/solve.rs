//! The solve of `slam2d optimize`: settings, repetitions, times, progress.

use bench_support::CpuClock;
use indicatif::{ProgressBar, ProgressStyle};
use pr_optim::{
    JacobianModel, Method, OptimizeError, Optimizer, Problem, SessionOutcome, Settings,
    SolveSession, Start, StopReason,
};

use super::args::{MethodName, OptimizeArgs};
use super::robust::{InlierCounts, select};

/// Initial damping of `--method lm`, relative to the diagonal.
const INITIAL_DAMPING: f64 = 1e-6;

/// Largest step, m and rad added, at which a graph without contradictions has converged: its
/// cost is rounding noise, so a relative decrease is never small.
const STEP_TOLERANCE: f64 = 1e-10;

/// Result and times of a solve.
pub struct Solved {
    /// The last solve; all are equal.
    pub outcome: SessionOutcome,
    /// Result of `--robust`.
    pub inliers: Option<InlierCounts>,
    /// CPU time of the first solve, with ordering and symbolic analysis, ms.
    pub first_ms: f64,
    /// CPU time of the fastest solve, ms.
    pub best_ms: f64,
}

/// Solves from the file's poses `repeat` times, reusing the symbolic analysis of the first.
///
/// # Errors
/// If no step can be computed, or the final cost is not finite.
pub fn solve_repeatedly(
    problem: &mut Problem,
    args: &OptimizeArgs,
) -> Result<Solved, OptimizeError> {
    let mut optimizer = Optimizer::new(settings(args));
    let bar = progress_bar(u64::from(args.repeat) * args.max_iterations as u64);
    let given = problem.poses().to_vec();
    let mut times_ms = Vec::new();
    let (outcome, inliers) = loop {
        problem.poses_mut().copy_from_slice(&given);
        let (outcome, inliers, elapsed_ms) = solve_once(&mut optimizer, problem, args, &bar)?;
        // Every solve takes as many iterations as the first, so the total is exact now.
        bar.set_length(u64::from(args.repeat) * outcome.total_iterations as u64);
        times_ms.push(elapsed_ms);
        if times_ms.len() >= args.repeat as usize {
            break (outcome, inliers);
        }
    };
    bar.finish_and_clear();
    if let StopReason::Failed { error } = outcome.report.stop {
        return Err(error);
    }
    if !outcome.report.chi2.is_finite() {
        return Err(OptimizeError::NotFinite);
    }
    Ok(Solved {
        outcome,
        inliers,
        first_ms: times_ms[0],
        best_ms: times_ms.into_iter().fold(f64::INFINITY, f64::min),
    })
}

fn settings(args: &OptimizeArgs) -> Settings {
    Settings {
        method: match args.method {
            MethodName::Gn => Method::GaussNewton,
            MethodName::Lm => Method::LevenbergMarquardt {
                initial_damping: INITIAL_DAMPING,
            },
        },
        jacobians: JacobianModel::Exact,
        kernel: args.kernel.0,
        max_iterations: args.max_iterations,
        step_tolerance: STEP_TOLERANCE,
        decrease_tolerance: args.tolerance,
        ..Settings::default()
    }
}

/// Solves once; the time of the progress bar is excluded.
fn solve_once(
    optimizer: &mut Optimizer,
    problem: &mut Problem,
    args: &OptimizeArgs,
    bar: &ProgressBar,
) -> Result<(SessionOutcome, Option<InlierCounts>, f64), OptimizeError> {
    let mut clock = CpuClock::start();
    let Some(mut selected) = select(problem, args.robust, settings(args))? else {
        let outcome = solve_session(optimizer, problem, args.init.start(), &mut clock, bar)?;
        return Ok((outcome, None, clock.elapsed_ms()));
    };
    let outcome = solve_session(
        optimizer,
        &mut selected.problem,
        Start::Given,
        &mut clock,
        bar,
    )?;
    let solved = selected.problem.poses();
    problem.poses_mut().copy_from_slice(solved);
    Ok((outcome, Some(selected.inliers), clock.elapsed_ms()))
}

/// Iterates a session; the clock stops at its end.
fn solve_session(
    optimizer: &mut Optimizer,
    problem: &mut Problem,
    start: Start,
    clock: &mut CpuClock,
    bar: &ProgressBar,
) -> Result<SessionOutcome, OptimizeError> {
    let mut session = SolveSession::new(optimizer, problem, start)?;
    loop {
        let more = session.step();
        if !more {
            break;
        }
        clock.pause();
        if let Some(step) = session.last_step() {
            bar.set_message(format!("χ² {:.6e}", step.chi2_before));
        }
        bar.inc(1);
        clock.resume();
    }
    bar.inc(1);
    let outcome = session.finish();
    clock.pause();
    Ok(outcome)
}

/// A progress bar on standard error, hidden if that is not a terminal.
///
/// `most` is the limit of iterations, which the actual number replaces after the first solve.
fn progress_bar(most: u64) -> ProgressBar {
    let style = ProgressStyle::with_template(
        "{wide_bar} {percent}%, {pos} of at most {len} iterations, {msg} ({elapsed})",
    )
    .expect("the template is well formed");
    ProgressBar::new(most).with_style(style)
}
