//! What all estimators of a lap report.

use ch16_lab::lap::{GraphSummary, LapSummary, LapTrace, RecordedLoopAttempt, TickReport};
use pr_geom::SE2;
use serde::Serialize;

use crate::lap_options::NoiseArgs;
use command_line::output::say;

/// What `--json` prints; `summary` and `events` depend on the estimator.
#[derive(Serialize)]
pub struct LapJson<Summary, Event> {
    #[serde(flatten)]
    pub noise: NoiseArgs,
    pub estimator: &'static str,
    pub digest: String,
    #[serde(flatten)]
    pub summary: Summary,
    /// Attempts to close a loop, or tests for a cycle.
    pub events: Vec<Event>,
    pub keyframe_poses: Vec<SE2>,
    pub keyframe_truth: Vec<SE2>,
    pub keyframe_errors_m: Vec<f64>,
    pub per_tick: Vec<TickJson>,
}

/// Rows of the results table, loops and graph of a lap.
#[derive(Serialize)]
pub struct GraphLapJson {
    #[serde(flatten)]
    summary: LapSummary,
    #[serde(flatten)]
    graph: GraphSummary,
}

impl From<&LapTrace> for GraphLapJson {
    fn from(lap: &LapTrace) -> Self {
        Self {
            summary: lap.summary,
            graph: lap.graph_summary,
        }
    }
}

/// An attempt to close a loop, with its verdict.
#[derive(Serialize)]
pub struct AttemptJson {
    #[serde(flatten)]
    attempt: RecordedLoopAttempt,
    accepted: bool,
    /// Why it was not accepted, in words.
    reason: Option<String>,
}

impl AttemptJson {
    /// The verdict of an attempt.
    pub fn new(attempt: &RecordedLoopAttempt) -> Self {
        Self {
            attempt: *attempt,
            accepted: attempt.accepted(),
            reason: attempt.verification.reason(),
        }
    }
}

/// A tick.
#[derive(Serialize)]
pub struct TickJson {
    pub truth: SE2,
    pub dead_reckoning: SE2,
    pub estimate: SE2,
    #[serde(flatten)]
    pub registration: Option<RegistrationJson>,
}

/// The registration of its scan.
#[derive(Serialize)]
pub struct RegistrationJson {
    tau_m: f64,
    inliers: usize,
    /// Null without pairs: infinity is no number of JSON.
    rmse_m: f64,
    iterations: usize,
    is_keyframe: bool,
}

impl TickJson {
    pub fn new(report: &TickReport) -> Self {
        let matched = &report.registration.matched;
        Self {
            truth: report.truth,
            dead_reckoning: report.dead_reckoning,
            estimate: report.estimate,
            registration: Some(RegistrationJson {
                tau_m: report.registration.next_tau_m,
                inliers: matched.inliers,
                rmse_m: matched.rmse_m,
                iterations: matched.iterations,
                is_keyframe: report.new_keyframe.is_some(),
            }),
        }
    }
}

/// Prints the counts of ticks and keyframes, and the errors at the end and on average, m.
pub fn print_errors(summary: &LapSummary) {
    say!("ticks             {}", summary.ticks);
    say!("keyframes         {}", summary.keyframes);
    for (what, error_m) in [
        ("odometry, end", summary.odometry_end_error_m),
        ("odometry, rms", summary.odometry_rms_m),
        ("keyframes, end", summary.keyframe_end_error_m),
        ("keyframes, rms", summary.keyframe_rms_m),
    ] {
        say!("{what:<18}{error_m:.4} m");
    }
    match summary.map_disagreement_m {
        Some(value) => say!("map disagreement  {value:.4} m"),
        None => say!("map disagreement  none: no area was scanned twice"),
    }
}
