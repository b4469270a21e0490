//! The solve of `slam2d optimize`: settings, repeats, times, progress.

use indicatif::{ProgressBar, ProgressStyle};
use measuring::CpuClock;
use pr_optim::{
    JacobianModel, Method, OptimizeError, Optimizer, Outcome, Problem, Session, Settings, Start,
    StopReason,
};

use super::args::{MethodName, OptimizeArgs};
use super::robust::{InlierCounts, select};

/// First damping of `--method lm`, relative to the diagonal.
const INITIAL_DAMPING: f64 = 1e-6;

/// Largest step, m and rad added, at which a graph without contradictions counts as solved: its
/// cost is rounding noise, of which no share is ever small.
const STEP_TOLERANCE: f64 = 1e-10;

/// What a solve found, and how long it took.
pub struct Solved {
    /// The last solve; all are the same.
    pub outcome: Outcome,
    /// What `--robust` inliers.
    pub inliers: Option<InlierCounts>,
    /// CPU time of the first solve, with ordering and symbolic analysis, ms.
    pub first_ms: f64,
    /// CPU time of the fastest solve, ms.
    pub best_ms: f64,
}

/// Solves from the file's poses `repeat` times; the analysis of the graph is kept after the first.
///
/// # Errors
/// Where no step could be computed, or the cost is not finite at the end.
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
        // Every solve takes as many iterations as the first: from now on the share is exact.
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

/// One solve; the time of the progress bar is not counted.
fn solve_once(
    optimizer: &mut Optimizer,
    problem: &mut Problem,
    args: &OptimizeArgs,
    bar: &ProgressBar,
) -> Result<(Outcome, Option<InlierCounts>, f64), OptimizeError> {
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

/// The steps of a session; the clock stands still at its end.
fn solve_session(
    optimizer: &mut Optimizer,
    problem: &mut Problem,
    start: Start,
    clock: &mut CpuClock,
    bar: &ProgressBar,
) -> Result<Outcome, OptimizeError> {
    let mut session = Session::new(optimizer, problem, start)?;
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

/// A bar on a terminal's standard error; nothing where it is not a terminal.
///
/// `most` is the limit of the iterations, which the first solve replaces by their number.
fn progress_bar(most: u64) -> ProgressBar {
    let style = ProgressStyle::with_template(
        "{wide_bar} {percent} %, {pos} of at most {len} iterations, {msg} ({elapsed})",
    )
    .expect("the template is well formed");
    ProgressBar::new(most).with_style(style)
}
