//! `slam2d-dev buildings`: the default parameters for robots on simulated recordings of office buildings.

use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::PathBuf;

use anyhow::{bail, ensure};
use ch16_lab::buildings::{BuildingRun, Kind, Recording, Robot, recorded_by};
use ch16_lab::lap::NamedChoice;
use clap::Args;
use rayon::prelude::*;
use robot_io::carmen::write_carmen;
use robot_io::log::LogFrame;
use robot_io::settings::{Setting, SettingError};
use serde::Serialize;

use command_line::choice::choice;
use command_line::in_file::InFile as _;
use command_line::numbers::{self, Seeds};
use command_line::output::{print_json, say};
use command_line::setting::setting;

/// Most buildings of one sweep: each takes a second.
const MAX_SEEDS: u64 = 100_000;

/// Run the default parameters for robots on simulated recordings of office buildings.
#[derive(Args, Clone, Debug)]
pub struct BuildingsArgs {
    /// Seeds: A..=B, A..B or one.
    #[arg(long, default_value = "1..=20", value_parser = numbers::seeds, allow_hyphen_values = true)]
    seeds: Seeds,
    /// Kind of environment and scanner.
    #[arg(long, default_value = "ring", value_parser = choice(Kind::NAMED))]
    kind: Kind,
    /// Robot that drives through it; default: the robot of that kind.
    #[arg(long, default_value = "own", value_parser = choice(Robot::NAMED))]
    robot: Robot,
    /// Ignore odometry and match scans alone.
    #[arg(long)]
    no_odometry: bool,
    /// Set a parameter of the estimator; docs/robots.md lists them.
    #[arg(long = "set", value_name = "NAME=VALUE", value_parser = setting)]
    settings: Vec<(String, f64)>,
    /// Write the recording of the first seed as a CARMEN log instead, and its true trajectory next to it.
    #[arg(long, value_name = "FILE")]
    log: Option<PathBuf>,
    /// Print one JSON list with an object for each seed.
    #[arg(long)]
    json: bool,
}

/// Result for one building.
#[derive(Clone, Debug, Serialize)]
struct Row {
    seed: u32,
    scans: usize,
    keyframes: usize,
    loops_tried: usize,
    closed_right: usize,
    closed_wrong: usize,
    links_right: usize,
    links_wrong: usize,
    /// Mean error of the relative poses of nearby keyframes, m.
    relation_m: f64,
    /// Largest of these errors, m.
    worst_relation_m: f64,
    /// Largest error of a keyframe, m.
    worst_m: f64,
    /// 95th percentile of the squared normalized errors; 7.8 if consistent.
    nees_95: f64,
    /// Share of the keyframes within their 95 % ellipsoid.
    within_95: f64,
}

/// Runs the buildings and prints a line for each.
///
/// # Errors
/// If there are too many seeds, a parameter cannot be set, or the log cannot be written.
pub fn run(args: &BuildingsArgs) -> anyhow::Result<()> {
    let seeds = args.seeds.count();
    ensure!(
        seeds <= MAX_SEEDS,
        "{seeds} seeds are too many; use at most {MAX_SEEDS}"
    );
    if args.kind.is_lap() && args.robot != Robot::Own {
        bail!(
            "--robot {} applies to buildings, not to --kind {}; omit it or use another kind",
            args.robot.name(),
            args.kind.name()
        );
    }
    if let Some(path) = &args.log {
        let (recording, _) = recorded_by(args.robot, args.kind, args.seeds.first);
        return write(path, &recording).in_file(path);
    }
    for (name, value) in &args.settings {
        Setting::named(name)?.check(*value)?;
    }
    let rows: Result<Vec<Row>, SettingError> = (args.seeds.first..=args.seeds.last)
        .into_par_iter()
        .map(|seed| row(args, seed))
        .collect();
    let rows = rows?;
    if args.json {
        print_json(&rows);
    } else {
        print(&rows);
    }
    Ok(())
}

fn row(args: &BuildingsArgs, seed: u32) -> Result<Row, SettingError> {
    let (recording, mut robot) = recorded_by(args.robot, args.kind, seed);
    for (name, value) in &args.settings {
        robot = Setting::named(name)?.set(&robot, *value)?;
    }
    let trial = BuildingRun::run(&recording, robot, !args.no_odometry);
    Ok(Row {
        seed,
        scans: recording.frames.len(),
        keyframes: trial.nees.len() + 1,
        loops_tried: trial.tried,
        closed_right: trial.closed.right,
        closed_wrong: trial.closed.wrong,
        links_right: trial.links.right,
        links_wrong: trial.links.wrong,
        relation_m: trial.relation_m,
        worst_relation_m: trial.worst_relation_m,
        worst_m: trial.worst_m,
        nees_95: {
            let mut sorted = trial.nees.clone();
            sorted.sort_by(f64::total_cmp);
            sorted
                .get(sorted.len() * 95 / 100)
                .copied()
                .unwrap_or_default()
        },
        within_95: trial.within_95(),
    })
}

fn print(rows: &[Row]) {
    say!(
        "{:>6} {:>6} {:>6}  {:>13}  {:>13}  {:>11} {:>9} {:>9}  {:>9} {:>9}",
        "seed",
        "scans",
        "nodes",
        "closed, false",
        "links, false",
        "relations m",
        "worst m",
        "keyframe",
        "in 95 %",
        "nees 95"
    );
    for row in rows {
        say!(
            "{:>6} {:>6} {:>6}  {:>6} {:>6}  {:>6} {:>6}  {:>11.4} {:>9.3} {:>9.3}  {:>9.3} {:>9.2}",
            row.seed,
            row.scans,
            row.keyframes,
            row.closed_right,
            row.closed_wrong,
            row.links_right,
            row.links_wrong,
            row.relation_m,
            row.worst_relation_m,
            row.worst_m,
            row.within_95,
            row.nees_95
        );
    }
    let mut errors: Vec<f64> = rows.iter().map(|row| row.relation_m).collect();
    errors.sort_by(f64::total_cmp);
    let runs = rows.len();
    let share = |is: &dyn Fn(&Row) -> bool| rows.iter().filter(|row| is(row)).count();
    let nodes: f64 = rows.iter().map(|row| row.keyframes as f64 - 1.0).sum();
    let within: f64 = rows
        .iter()
        .map(|row| row.within_95 * (row.keyframes as f64 - 1.0))
        .sum();
    let closed: usize = rows.iter().map(|row| row.closed_right).sum();
    say!(
        "relations {:.4} m in the median run, {:.4} m in the worst; {} of {runs} runs with a keyframe \
         1 m off; {} with a false loop, {} with a false link; {closed} right loops; {:.1} % of the \
         keyframes in 95 %",
        errors[runs / 2],
        errors[runs - 1],
        share(&|row| row.worst_m > 1.0),
        share(&|row| row.closed_wrong > 0),
        share(&|row| row.links_wrong > 0),
        100.0 * within / nodes
    );
}

/// Writes the log, and its true trajectory as TUM.
fn write(path: &PathBuf, recording: &Recording) -> std::io::Result<()> {
    let mut log = BufWriter::new(File::create(path)?);
    let mut truth = BufWriter::new(File::create(path.with_extension("tum"))?);
    for frame in &recording.frames {
        let line = LogFrame {
            stamp_s: frame.stamp_s,
            odometry: Some(frame.odometry),
            scan: frame.scan.clone(),
        };
        write_carmen(&line, &mut log)?;
        let [x, y, theta] = frame.truth.to_array();
        let (sin, cos) = (0.5 * theta).sin_cos();
        writeln!(truth, "{} {x} {y} 0 0 0 {sin} {cos}", frame.stamp_s)?;
    }
    log.flush()?;
    truth.flush()
}
