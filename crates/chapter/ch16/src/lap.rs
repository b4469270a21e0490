//! `ch16 lap`: a lap at one seed and noise factor in the Apartment or another world.

#[cfg(feature = "exercises")]
mod exercises;
mod incremental;
pub mod report;

use std::fs::File;
use std::io::{self, BufWriter};
use std::path::{Path, PathBuf};

use anyhow::bail;
use ch16_lab::lap::{Drive, LapConfig, LapEstimator, LapRecord, LapRunner, NamedChoice};
use clap::Args;
use robot_io::json_log::write_frames;
use serde::Serialize;

use crate::lap_options::{NoiseArgs, TrialArgs};
use command_line::choice::choice;
use command_line::in_file::InFile as _;
use command_line::output::{print_json, say};
use report::{AttemptJson, GraphLapJson, LapJson, TickJson, print_errors};

/// Simulate the lap in the Apartment or another world, and estimate it.
#[derive(Args, Clone, Debug)]
pub struct LapArgs {
    #[command(flatten)]
    noise: NoiseArgs,
    #[command(flatten)]
    trial: TrialArgs,
    /// Estimator of the lap.
    #[arg(long, default_value = "graph", value_parser = choice(LapEstimator::NAMED))]
    estimator: LapEstimator,
    /// Use the front end without loop closure; same as --estimator front-end.
    #[arg(long, conflicts_with = "estimator")]
    no_loops: bool,
    /// Write the recorded scans to this file, one line of JSON each: a log.
    #[arg(long, value_name = "FILE")]
    frames: Option<PathBuf>,
    /// Let the functions that you wrote in exercises/ drive the lap: teaching/guide/exercises.md.
    #[arg(long, conflicts_with_all = ["front_end", "loop_matcher", "gate", "information", "no_information_cap", "estimator", "json"])]
    exercises: bool,
    /// Print one JSON object with every tick, keyframe and loop event.
    #[arg(long)]
    json: bool,
}

impl LapArgs {
    fn estimator(&self) -> LapEstimator {
        if self.no_loops {
            LapEstimator::FrontEnd
        } else {
            self.estimator
        }
    }
}

/// Runs the lap and prints it.
///
/// # Errors
/// If the world file cannot be used, or the frames cannot be written.
pub fn run(args: &LapArgs) -> anyhow::Result<()> {
    let NoiseArgs { seed, noise } = args.noise;
    let mut config = args.trial.trial()?.lap(seed, noise);
    if args.estimator() == LapEstimator::FrontEnd {
        config = config.without_loops();
    }
    if let Some(path) = &args.frames {
        let drive = Drive::simulate(&config.drive);
        write_drive(path, &drive).in_file(path)?;
    }
    if let LapEstimator::IncrementalKind(kind) = args.estimator {
        if let Some(argument) = args.trial.of_the_graph() {
            bail!(
                "{argument} has no effect on the estimator {}; omit it or use --estimator graph",
                args.estimator.name()
            );
        }
        incremental::print(kind, &config, args);
        return Ok(());
    }
    if args.exercises {
        return run_exercises(&config, args);
    }
    let record = LapRunner::new().run(&config);
    if args.json {
        print_json(&json(&record, args));
    } else {
        print_text(&record, args);
    }
    Ok(())
}

#[cfg(feature = "exercises")]
fn run_exercises(config: &LapConfig, args: &LapArgs) -> anyhow::Result<()> {
    let driven = exercises::drive(config)?;
    print_text(&driven.record, args);
    driven.print();
    Ok(())
}

#[cfg(not(feature = "exercises"))]
fn run_exercises(_: &LapConfig, _: &LapArgs) -> anyhow::Result<()> {
    bail!(
        "this ch16 was built without your exercises: cargo run -p ch16 --features exercises -- lap --exercises"
    )
}

/// Writes every frame of a drive with the true pose.
fn write_drive(path: &Path, drive: &Drive) -> io::Result<()> {
    let mut file = BufWriter::new(File::create(path)?);
    let frames = drive.log_frames().enumerate();
    write_frames(
        frames.map(|(tick, frame)| (frame, drive.truth(tick))),
        &mut file,
    )
}

/// What `--json` prints.
fn json(record: &LapRecord, args: &LapArgs) -> impl Serialize {
    let lap = &record.lap;
    let poses = lap.poses(record.ticks());
    LapJson {
        noise: args.noise,
        estimator: args.estimator().name(),
        digest: format!("{:016x}", record.digest()),
        summary: GraphLapJson::from(lap),
        events: lap.loop_attempts().map(AttemptJson::new).collect(),
        keyframe_poses: poses.to_vec(),
        keyframe_truth: lap.keyframes.iter().map(|k| k.truth).collect(),
        keyframe_errors_m: lap.keyframe_errors_m(record.ticks()).collect(),
        per_tick: lap.reports.iter().map(TickJson::new).collect(),
    }
}

fn print_text(record: &LapRecord, args: &LapArgs) {
    say!("seed {:#x}, noise ×{}", args.noise.seed, args.noise.noise);
    print_errors(&record.lap.summary);
    say!("graph chi2        {:.4}", record.lap.graph_summary.chi2);
    for attempt in record.lap.loop_attempts() {
        let found = &attempt.verification;
        let verdict = match attempt.effect {
            Some(effect) => format!("accepted, history moved by {:.3} m", effect.max_shift_m),
            None => "rejected".to_owned(),
        };
        say!(
            "loop {} to {}: chi2 {:.3} (gate {:.3}), rmse {:.3} m, {} pairs: {verdict}",
            found.from_node,
            found.candidate.node,
            found.gate.chi2,
            found.gate.gate_chi2,
            found.rmse_m,
            found.inliers,
        );
    }
}
