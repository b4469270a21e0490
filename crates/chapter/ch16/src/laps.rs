//! `ch16 laps N`: repeated laps with one lifelong map.

use std::path::PathBuf;

use anyhow::bail;
use bench_support::process;
use ch16_lab::laps::{LapNumbers, Laps, LapsConfig};
use ch16_slam2d::scan::LaserScan;
use clap::Args;
use pr_sim::Course;
use robot_io::session::Session;
use serde::Serialize;

use crate::lap_options::NoiseArgs;
use crate::world::WorldArg;
use command_line::in_file::InFile as _;
use command_line::numbers;
use command_line::output::{print_json, say};
use command_line::whole_file::write_whole;

/// Drive laps in sequence with the parameters for robots, and maintain one map.
#[derive(Args, Clone, Debug)]
pub struct LapsArgs {
    /// Number of laps.
    #[arg(value_name = "N", value_parser = numbers::laps)]
    count: usize,
    #[command(flatten)]
    noise: NoiseArgs,
    /// World: apartment, ring, twins, corridor, hall, or a .json file.
    #[arg(long, default_value = "apartment")]
    world: WorldArg,
    /// Write the session to this file after the last lap.
    #[arg(long, value_name = "FILE")]
    session: Option<PathBuf>,
    /// Place a wardrobe in the Apartment and move it before this lap.
    #[arg(long, value_name = "LAP", value_parser = numbers::laps)]
    wardrobe: Option<usize>,
    /// Disable map pruning, so the map only grows.
    #[arg(long)]
    keep_all: bool,
    /// Print one JSON object.
    #[arg(long)]
    json: bool,
}

/// A lap in JSON.
#[derive(Serialize)]
struct LapJson {
    #[serde(flatten)]
    numbers: LapNumbers,
    /// Size of the session.
    bytes: usize,
    /// CPU time.
    ms_per_tick: f64,
}

#[derive(Serialize)]
struct LapsJson {
    #[serde(flatten)]
    noise: NoiseArgs,
    laps: Vec<LapJson>,
}

/// Runs the laps and prints a line for each.
///
/// # Errors
/// If the world cannot be used or the session cannot be written.
pub fn run(args: &LapsArgs) -> anyhow::Result<()> {
    let course = args.world.course()?;
    let (count, NoiseArgs { seed, noise }) = (args.count, args.noise);
    if args.wardrobe.is_some() && course != Course::apartment() {
        bail!("--wardrobe applies to the Apartment only; omit --world");
    }
    if let Some(lap) = args.wardrobe.filter(|&lap| lap > count) {
        bail!("--wardrobe {lap} is beyond the {count} laps; use a lap up to {count}");
    }
    let mut config = LapsConfig::new(&course, seed, noise);
    config.wardrobe = args.wardrobe;
    if args.keep_all {
        config.map_pruning = None;
    }
    let mut laps = Laps::new(config);
    let mut done = Vec::new();
    let mut session = None;
    if !args.json {
        say!("lap  nodes  edges  loops    removed  nats   kB  ms/tick  error m  map m");
    }
    for _ in 0..count {
        let drive = laps.simulate();
        let before_s = process::cpu_s();
        let numbers = laps.estimate(&drive);
        let ms_per_tick = 1e3 * (process::cpu_s() - before_s) / numbers.ticks as f64;
        let saved = Session {
            snapshot: laps.slam().snapshot(),
            mapped: None,
            scan_poses: Vec::new(),
            sensor: Some(LaserScan {
                ranges_m: Vec::new(),
                ..drive.frame(0).scan
            }),
            last_odometry: None,
        };
        let bytes = saved.to_bytes();
        let lap = LapJson {
            numbers,
            bytes: bytes.len(),
            ms_per_tick,
        };
        session = Some(bytes);
        if !args.json {
            lap.print();
        }
        done.push(lap);
    }
    if let (Some(path), Some(bytes)) = (&args.session, &session) {
        write_whole(path, bytes).in_file(path)?;
    }
    if args.json {
        print_json(&LapsJson {
            noise: args.noise,
            laps: done,
        });
    }
    Ok(())
}

impl LapJson {
    fn print(&self) {
        let numbers = &self.numbers;
        say!(
            "{:>3}  {:>5}  {:>5}  {:>5}  {:>9}  {:>4.1}  {:>3.0}  {:>7.3}  {:>7.4}  {:>5.3}",
            numbers.lap,
            numbers.nodes,
            numbers.edges,
            numbers.loops,
            numbers.removed,
            numbers.divergence,
            self.bytes as f64 / 1e3,
            self.ms_per_tick,
            numbers.rms_m,
            numbers.map_rms_m
        );
    }
}
