//! `ch16 sweep --nudge`: sensitivity of laps to a start that differs in its last digits.

use ch16_lab::lap::LapRunner;
use ch16_lab::nudge::{CHANGED_M, NUDGE, NudgeStatistics, farthest_keyframe_m, nudged};
use rayon::prelude::*;
use serde::Serialize;

use super::{SweepArgs, progress_bar};
use crate::lap_options::LapOptions;
use command_line::output::{print_json, say};

/// The laps at one noise factor, each with its twin.
#[derive(Serialize)]
struct NudgedLevel {
    noise: f64,
    runs: usize,
    /// Relative change of the start.
    nudge: f64,
    /// Distance between a keyframe and its twin from which a lap counts as changed, m.
    changed_m: f64,
    changed: usize,
    /// Largest distance between a keyframe and its twin, m.
    farthest_m: f64,
}

/// Runs every lap and its twin and prints how many differ.
pub fn print(args: &SweepArgs, trial: &LapOptions) {
    let levels: Vec<NudgedLevel> = args
        .noise
        .iter()
        .map(|&noise| level(args, trial, noise))
        .collect();
    if args.json {
        print_json(&levels);
        return;
    }
    for level in &levels {
        say!(
            "noise ×{}: {} of {} laps change by more than {:e} m, the farthest by {:.3} m, where \
             the start is moved by a relative {:e}",
            level.noise,
            level.changed,
            level.runs,
            level.changed_m,
            level.farthest_m,
            level.nudge
        );
    }
}

fn level(args: &SweepArgs, trial: &LapOptions, noise: f64) -> NudgedLevel {
    let bar = progress_bar(args.seeds.count());
    let moved_m = (args.seeds.first..=args.seeds.last)
        .into_par_iter()
        .map_init(LapRunner::new, |runner, seed| {
            let config = trial.lap(seed, noise);
            let lap = runner.run(&config);
            let twin = runner.run(&nudged(&config, NUDGE));
            bar.inc(1);
            farthest_keyframe_m(&lap, &twin)
        })
        .collect();
    bar.finish_and_clear();
    let statistics = NudgeStatistics { moved_m };
    NudgedLevel {
        noise,
        runs: statistics.moved_m.len(),
        nudge: NUDGE,
        changed_m: CHANGED_M,
        changed: statistics.changed(),
        farthest_m: statistics.farthest_m(),
    }
}
