//! `ch16 lap --estimator ml|ml-cycles`: incremental mapping on the frames of the lap.

use ch16_lab::incremental::IncrementalTrace;
use ch16_lab::lap::{Drive, IncrementalKind, LapConfig, LapSummary, NamedChoice};
use ch16_slam2d::digest::Digest;
use ch16_slam2d::metrics::position_error_m;
use incremental_mapping::{CycleClosure, CycleTest, CycleVerdict};
use serde::Serialize;

use super::LapArgs;
use super::report::{LapJson, TickJson, print_errors};
use crate::lap_options::NoiseArgs;
use command_line::output::{print_json, say};

/// Runs incremental mapping on the lap of `config` and prints the result.
pub fn print(kind: IncrementalKind, config: &LapConfig, args: &LapArgs) {
    let drive = Drive::simulate(&config.drive);
    let trace = IncrementalTrace::run(kind, config, &drive);
    if args.json {
        print_json(&json(&trace, &drive, args));
    } else {
        print_text(&trace, args);
    }
}

/// Rows of the results table, and the cycles that were closed.
#[derive(Serialize)]
struct CycleLapJson {
    #[serde(flatten)]
    summary: LapSummary,
    cycles: usize,
}

/// What `--json` prints.
fn json(trace: &IncrementalTrace, drive: &Drive, args: &LapArgs) -> impl Serialize {
    let mut digest = Digest::new();
    let poses = trace.poses.iter().chain(&trace.estimates);
    poses.for_each(|pose| digest.add_pose(pose));
    let ticks = drive.ticks().iter().zip(&trace.estimates);
    LapJson {
        noise: args.noise,
        estimator: args.estimator.name(),
        digest: format!("{:016x}", digest.value()),
        summary: CycleLapJson {
            summary: trace.outcome.summary,
            cycles: trace.outcome.cycles,
        },
        events: trace.tests.clone(),
        keyframe_poses: trace.poses.clone(),
        keyframe_truth: trace.keyframes.iter().map(|k| k.truth).collect(),
        keyframe_errors_m: trace.keyframe_errors_m().collect(),
        per_tick: ticks
            .map(|(tick, &estimate)| TickJson {
                truth: tick.truth,
                dead_reckoning: tick.dead_reckoning,
                estimate,
                registration: None,
            })
            .collect(),
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

fn print_text(trace: &IncrementalTrace, args: &LapArgs) {
    let estimator = args.estimator.label();
    let NoiseArgs { seed, noise } = args.noise;
    say!("seed {seed:#x}, noise ×{noise}, {estimator}");
    print_errors(&trace.outcome.summary);
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
