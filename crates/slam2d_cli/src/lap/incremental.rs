//! `slam2d lap --estimator ml|ml-cycles`: incremental mapping on the frames of the lap.

use ch16_lab::incremental::IncrementalTrace;
use ch16_lab::lap::{Drive, IncrementalKind, LapConfig, NamedChoice};
use ch16_slam2d::digest::Digest;
use ch16_slam2d::metrics::position_error_m;
use incremental_mapping::{CycleClosure, CycleTest, CycleVerdict};
use serde::Serialize;

use super::LapArgs;
use crate::output::{print_json, say};

/// What `--json` prints.
#[derive(Serialize)]
struct IncrementalJson {
    seed: u32,
    noise: f64,
    estimator: &'static str,
    ticks: usize,
    keyframes: usize,
    odometry_end_error: f64,
    odometry_rms: f64,
    keyframe_end_error: f64,
    keyframe_rms: f64,
    map_disagreement: Option<f64>,
    digest: String,
    /// Test of the particles at every keyframe.
    tests: Vec<TestJson>,
    keyframe_poses: Vec<[f64; 3]>,
    keyframe_truth: Vec<[f64; 3]>,
    keyframe_errors: Vec<f64>,
    per_tick: Vec<TickJson>,
}

/// A test of the particles; `from`, `off` and `max_shift` if a cycle was closed.
#[derive(Serialize)]
struct TestJson {
    node: usize,
    spread: f64,
    known: f64,
    fit: Option<f64>,
    verdict: &'static str,
    from: Option<usize>,
    off: Option<f64>,
    max_shift: Option<f64>,
}

#[derive(Serialize)]
struct TickJson {
    truth: [f64; 3],
    dead_reckoning: [f64; 3],
    estimate: [f64; 3],
}

/// Runs incremental mapping on the lap of `config` and prints the result.
pub fn print(kind: IncrementalKind, config: &LapConfig, args: &LapArgs) {
    let drive = Drive::simulate(&config.drive);
    let trace = IncrementalTrace::run(kind, config, &drive);
    if args.json {
        print_json(&IncrementalJson::new(&trace, &drive, args));
    } else {
        print_text(&trace, args);
    }
}

impl IncrementalJson {
    fn new(trace: &IncrementalTrace, drive: &Drive, args: &LapArgs) -> Self {
        let summary = &trace.outcome.summary;
        let mut digest = Digest::new();
        let poses = trace.poses.iter().chain(&trace.estimates);
        poses.for_each(|pose| digest.add_pose(pose));
        Self {
            seed: args.seed,
            noise: args.noise,
            estimator: args.estimator.name(),
            ticks: summary.ticks,
            keyframes: summary.keyframes,
            odometry_end_error: summary.odometry_end_error_m,
            odometry_rms: summary.odometry_rms_m,
            keyframe_end_error: summary.keyframe_end_error_m,
            keyframe_rms: summary.keyframe_rms_m,
            map_disagreement: summary.map_disagreement_m,
            digest: format!("{:016x}", digest.value()),
            tests: trace.tests.iter().map(TestJson::new).collect(),
            keyframe_poses: trace.poses.iter().map(|pose| pose.to_array()).collect(),
            keyframe_truth: trace.keyframes.iter().map(|k| k.truth.to_array()).collect(),
            keyframe_errors: trace.keyframe_errors_m().collect(),
            per_tick: drive
                .ticks()
                .iter()
                .zip(&trace.estimates)
                .map(|(tick, estimate)| TickJson {
                    truth: tick.truth.to_array(),
                    dead_reckoning: tick.dead_reckoning.to_array(),
                    estimate: estimate.to_array(),
                })
                .collect(),
        }
    }
}

fn closure(test: &CycleTest) -> Option<&CycleClosure> {
    match &test.verdict {
        CycleVerdict::Closed(closure) => Some(closure),
        _ => None,
    }
}

fn off_m(closure: &CycleClosure) -> f64 {
    position_error_m(&closure.before, &closure.after)
}

impl TestJson {
    fn new(test: &CycleTest) -> Self {
        let closed = closure(test);
        Self {
            node: test.node,
            spread: test.spread.position_m,
            known: test.known,
            fit: test.fit,
            verdict: match test.verdict {
                CycleVerdict::NewPlace => "new place",
                CycleVerdict::Undecided => "undecided",
                CycleVerdict::PoorFit => "poor fit",
                CycleVerdict::Confirmed => "confirmed",
                CycleVerdict::Closed(_) => "closed",
            },
            from: closed.map(|closure| closure.from_node),
            off: closed.map(off_m),
            max_shift: closed.map(|closure| closure.max_shift_m),
        }
    }
}

fn print_text(trace: &IncrementalTrace, args: &LapArgs) {
    let summary = &trace.outcome.summary;
    let estimator = args.estimator.label();
    say!("seed {:#x}, noise ×{}, {estimator}", args.seed, args.noise);
    say!("ticks             {}", summary.ticks);
    say!("keyframes         {}", summary.keyframes);
    say!("odometry, end     {:.4} m", summary.odometry_end_error_m);
    say!("odometry, rms     {:.4} m", summary.odometry_rms_m);
    say!("keyframes, end    {:.4} m", summary.keyframe_end_error_m);
    say!("keyframes, rms    {:.4} m", summary.keyframe_rms_m);
    match summary.map_disagreement_m {
        Some(value) => say!("map disagreement  {value:.4} m"),
        None => say!("map disagreement  none: no area was scanned twice"),
    }
    for test in &trace.tests {
        if let Some(closure) = closure(test) {
            say!(
                "cycle {} to {}: the particles agree within {:.3} m, the pose is off by {:.3} m, \
                 history moved by {:.3} m",
                closure.to_node,
                closure.from_node,
                test.spread.position_m,
                off_m(closure),
                closure.max_shift_m
            );
        }
    }
}
