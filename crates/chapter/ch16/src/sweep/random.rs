//! `ch16 sweep --random`: laps at configurations drawn from the documented ranges.

use std::panic::catch_unwind;

use anyhow::bail;
use ch16_lab::lap::{LapRunner, random_config};
use rayon::prelude::*;
use serde::Serialize;

use super::{SweepArgs, progress_bar};
use command_line::output::{print_json, say};

/// Results of random laps.
#[derive(Serialize)]
struct RandomJson {
    laps: usize,
    /// Number of laps with only finite figures.
    sound: usize,
    /// Number of accepted loops in total.
    loops: usize,
    /// Number of ticks in total.
    ticks: usize,
}

/// Result of one lap.
struct Random {
    seed: u32,
    loops: usize,
    ticks: usize,
    fault: Option<String>,
}

/// Runs a lap at a random configuration for every seed, and prints whether all succeeded.
///
/// # Errors
/// If a lap panicked or has a figure that is not finite; the first one is returned.
pub fn print(args: &SweepArgs) -> anyhow::Result<()> {
    let bar = progress_bar(args.seeds.count());
    let laps: Vec<Random> = (args.seeds.first..=args.seeds.last)
        .into_par_iter()
        .map(|seed| {
            let lap = run(seed);
            bar.inc(1);
            lap
        })
        .collect();
    bar.finish_and_clear();
    let sum = |count: fn(&Random) -> usize| laps.iter().map(count).sum();
    let summary = RandomJson {
        laps: laps.len(),
        sound: laps.iter().filter(|lap| lap.fault.is_none()).count(),
        loops: sum(|lap| lap.loops),
        ticks: sum(|lap| lap.ticks),
    };
    if args.json {
        print_json(&summary);
    } else {
        say!(
            "{} of {} laps at random configurations ended with finite figures only; {} ticks, {} loops \
             closed",
            summary.sound,
            summary.laps,
            summary.ticks,
            summary.loops
        );
    }
    match laps.into_iter().find(|lap| lap.fault.is_some()) {
        None => Ok(()),
        Some(Random { seed, fault, .. }) => bail!(
            "the lap at the random configuration {seed} failed: {}",
            fault.unwrap_or_default()
        ),
    }
}

/// Runs one lap; a panic counts as a fault, so the seed is reported.
fn run(seed: u32) -> Random {
    let lap = catch_unwind(|| LapRunner::new().run(&random_config(seed)));
    match lap {
        Ok(record) => Random {
            seed,
            loops: record.lap.graph_summary.loops,
            ticks: record.ticks(),
            fault: record.first_fault(),
        },
        Err(_) => Random {
            seed,
            loops: 0,
            ticks: 0,
            fault: Some("it panicked".to_owned()),
        },
    }
}
