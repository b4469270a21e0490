//! `slam2d lap`: a lap at one seed and noise factor in the Apartment or another world.

#[cfg(feature = "exercises")]
mod exercises;
mod incremental;
mod laps;

use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use anyhow::bail;
use ch16_lab::lap::{
    Drive, LapConfig, LapEstimator, LapRecord, LapRunner, NamedChoice, RecordedLoopAttempt,
    TickReport,
};
use clap::Args;
use robot_io::json_log::FrameLine;
use serde::Serialize;

use crate::in_file::InFile as _;
use crate::lap_options::{TrialArgs, choice};
use crate::numbers;
use crate::output::{print_json, say};

/// Simulate the lap in the Apartment or another world, and estimate it.
#[derive(Args, Clone, Debug)]
pub struct LapArgs {
    /// Seed of all noise, decimal or 0x….
    #[arg(long, default_value = "0xC0FFEE", value_parser = numbers::seed, allow_hyphen_values = true)]
    seed: u32,
    /// Factor on the six parameters of odometry noise.
    #[arg(long, default_value = "1", value_parser = numbers::noise_factor, allow_hyphen_values = true)]
    noise: f64,
    #[command(flatten)]
    trial: TrialArgs,
    /// Estimator of the lap.
    #[arg(long, default_value = "graph", value_parser = choice::<LapEstimator>())]
    estimator: LapEstimator,
    /// Use the front end without loop closure; same as --estimator front-end.
    #[arg(long, conflicts_with = "estimator")]
    no_loops: bool,
    /// Write the recorded scans to this file, one line of JSON each: a log.
    #[arg(long, value_name = "FILE")]
    frames: Option<PathBuf>,
    /// Let the functions that you wrote in exercises/ drive the lap: docs/teaching/exercises.md.
    #[arg(long, conflicts_with_all = ["front_end", "loop_matcher", "gate", "information", "no_information_cap", "estimator", "laps", "json"])]
    exercises: bool,
    #[command(flatten)]
    laps: laps::LapsArgs,
    /// Print one JSON object with every tick, keyframe and loop event.
    #[arg(long)]
    json: bool,
}

impl LapArgs {
    fn is_without_loops(&self) -> bool {
        self.no_loops || self.estimator == LapEstimator::FrontEnd
    }
}

/// What `--json` prints; `max_shift`, `ate_before` and `ate_after` are null for a rejected loop.
#[derive(Serialize)]
struct LapJson {
    seed: u32,
    noise: f64,
    loops: bool,
    ticks: usize,
    keyframes: usize,
    turn_node: Option<usize>,
    odometry_end_error: f64,
    odometry_rms: f64,
    keyframe_end_error: f64,
    keyframe_rms: f64,
    map_disagreement: Option<f64>,
    chi2: f64,
    occupied_cells: usize,
    free_cells: usize,
    digest: String,
    events: Vec<EventJson>,
    keyframe_poses: Vec<[f64; 3]>,
    keyframe_truth: Vec<[f64; 3]>,
    keyframe_errors: Vec<f64>,
    per_tick: Vec<TickJson>,
}

#[derive(Serialize)]
struct EventJson {
    from: usize,
    to: usize,
    chi2: f64,
    rmse: f64,
    inliers: usize,
    accepted: bool,
    max_shift: Option<f64>,
    ate_before: Option<f64>,
    ate_after: Option<f64>,
}

#[derive(Serialize)]
struct TickJson {
    truth: [f64; 3],
    dead_reckoning: [f64; 3],
    estimate: [f64; 3],
    tau: f64,
    inliers: usize,
    rmse: Option<f64>,
    iterations: usize,
    keyframe: bool,
}

/// Runs the lap and prints it.
///
/// # Errors
/// If the world file cannot be used, or the frames cannot be written.
pub fn run(args: &LapArgs) -> anyhow::Result<()> {
    if let Some(count) = args.laps.laps {
        let course = args.trial.course()?;
        return laps::run(&args.laps, count, &course, args.seed, args.noise, args.json);
    }
    let mut config = args.trial.trial()?.lap(args.seed, args.noise);
    if args.is_without_loops() {
        config = config.without_loops();
    }
    if let Some(path) = &args.frames {
        let drive = Drive::simulate(&config.drive);
        write_frames(path, &drive).in_file(path)?;
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
        print_json(&LapJson::new(&record, args));
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
        "this slam2d was built without your exercises: cargo run -p slam2d_cli --features exercises -- lap --exercises"
    )
}

/// Writes every frame of a drive with the true pose.
fn write_frames(path: &Path, drive: &Drive) -> io::Result<()> {
    let mut file = BufWriter::new(File::create(path)?);
    for (tick, frame) in drive.log_frames().enumerate() {
        let line = FrameLine {
            truth: Some(drive.truth(tick).to_array()),
            ..FrameLine::from(&frame)
        };
        line.write(&mut file)?;
    }
    file.flush()
}

impl LapJson {
    fn new(record: &LapRecord, args: &LapArgs) -> Self {
        let (lap, summary) = (&record.lap, &record.lap.summary);
        let grid = record.occupancy_grid(record.ticks());
        let poses = lap.poses(record.ticks());
        Self {
            seed: args.seed,
            noise: args.noise,
            loops: !args.is_without_loops(),
            ticks: summary.ticks,
            keyframes: summary.keyframes,
            turn_node: lap.turn_node,
            odometry_end_error: summary.odometry_end_error_m,
            odometry_rms: summary.odometry_rms_m,
            keyframe_end_error: summary.keyframe_end_error_m,
            keyframe_rms: summary.keyframe_rms_m,
            map_disagreement: summary.map_disagreement_m,
            chi2: summary.chi2,
            occupied_cells: grid.occupied_cells(),
            free_cells: grid.free_cells(),
            digest: format!("{:016x}", record.digest()),
            events: lap.loop_attempts().map(EventJson::new).collect(),
            keyframe_poses: poses.iter().map(|pose| pose.to_array()).collect(),
            keyframe_truth: lap.keyframes.iter().map(|k| k.truth.to_array()).collect(),
            keyframe_errors: lap.keyframe_errors_m(record.ticks()).collect(),
            per_tick: lap.reports.iter().map(TickJson::new).collect(),
        }
    }
}

impl EventJson {
    fn new(attempt: &RecordedLoopAttempt) -> Self {
        let found = &attempt.verification;
        let rms = attempt.effect.map(|effect| effect.keyframe_rms_m);
        Self {
            from: found.from_node,
            to: found.candidate.node,
            chi2: found.gate.chi2,
            rmse: found.rmse_m,
            inliers: found.inliers,
            accepted: attempt.accepted(),
            max_shift: attempt.effect.map(|effect| effect.max_shift_m),
            ate_before: rms.map(|rms| rms.before),
            ate_after: rms.map(|rms| rms.after),
        }
    }
}

impl TickJson {
    fn new(report: &TickReport) -> Self {
        let matched = &report.registration.matched;
        Self {
            truth: report.truth.to_array(),
            dead_reckoning: report.dead_reckoning.to_array(),
            estimate: report.estimate.to_array(),
            tau: report.registration.next_tau_m,
            inliers: matched.inliers,
            // Infinite without pairs, which JSON cannot represent.
            rmse: matched.rmse_m.is_finite().then_some(matched.rmse_m),
            iterations: matched.iterations,
            keyframe: report.new_keyframe.is_some(),
        }
    }
}

fn print_text(record: &LapRecord, args: &LapArgs) {
    let summary = &record.lap.summary;
    say!("seed {:#x}, noise ×{}", args.seed, args.noise);
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
    say!("graph chi2        {:.4}", summary.chi2);
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
