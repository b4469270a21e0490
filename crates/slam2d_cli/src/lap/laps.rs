//! `slam2d lap --laps N`: repeated laps with one lifelong map.

use std::path::PathBuf;

use anyhow::bail;
use bench_support::process;
use ch16_lab::laps::{LapNumbers, Laps, LapsConfig};
use ch16_slam2d::scan::LaserScan;
use clap::Args;
use pr_sim::Course;
use robot_io::session::Session;
use serde::Serialize;

use crate::in_file::InFile as _;
use crate::numbers;
use crate::optimize::write_whole;
use crate::output::{print_json, say};

/// Arguments of repeated laps.
#[derive(Args, Clone, Debug)]
pub struct LapsArgs {
    /// Drive this many laps in sequence with the parameters for robots, and maintain one map.
    #[arg(long, value_name = "N", value_parser = numbers::laps,
          conflicts_with_all = ["matcher", "front_end", "loop_matcher", "detector", "gate", "information", "frames", "no_loops", "estimator"])]
    pub laps: Option<usize>,
    /// Write the session to this file after the last lap.
    #[arg(long, value_name = "FILE", requires = "laps")]
    session: Option<PathBuf>,
    /// Place a wardrobe in the Apartment and move it before this lap.
    #[arg(long, value_name = "LAP", requires = "laps", value_parser = numbers::laps)]
    wardrobe: Option<usize>,
    /// Disable map pruning: the map only grows.
    #[arg(long, requires = "laps")]
    keep_all: bool,
}

/// A lap in JSON.
#[derive(Serialize)]
struct LapJson {
    lap: usize,
    ticks: usize,
    nodes: usize,
    edges: usize,
    loops: usize,
    removed: usize,
    divergence: f64,
    points_gone: usize,
    wardrobe_points: usize,
    bytes: usize,
    ms_per_tick: f64,
    rms: f64,
    map_rms: f64,
}

#[derive(Serialize)]
struct LapsJson {
    seed: u32,
    noise: f64,
    laps: Vec<LapJson>,
}

/// Runs the laps and prints a line for each.
///
/// # Errors
/// If the session cannot be written.
pub fn run(
    args: &LapsArgs,
    count: usize,
    course: &Course,
    seed: u32,
    noise: f64,
    as_json: bool,
) -> anyhow::Result<()> {
    if args.wardrobe.is_some() && *course != Course::apartment() {
        bail!("--wardrobe applies to the Apartment only; omit --world");
    }
    if let Some(lap) = args.wardrobe.filter(|&lap| lap > count) {
        bail!("--wardrobe {lap} is beyond --laps {count}; use a lap up to {count}");
    }
    let mut config = LapsConfig::new(course, seed, noise);
    config.wardrobe = args.wardrobe;
    if args.keep_all {
        config.map_pruning = None;
    }
    let mut laps = Laps::new(config);
    let mut done = Vec::new();
    let mut session = None;
    if !as_json {
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
        let lap = LapJson::new(&numbers, bytes.len(), ms_per_tick);
        session = Some(bytes);
        if !as_json {
            lap.print();
        }
        done.push(lap);
    }
    if let (Some(path), Some(bytes)) = (&args.session, &session) {
        write_whole(path, bytes).in_file(path)?;
    }
    if as_json {
        print_json(&LapsJson {
            seed,
            noise,
            laps: done,
        });
    }
    Ok(())
}

impl LapJson {
    fn new(numbers: &LapNumbers, bytes: usize, ms_per_tick: f64) -> Self {
        let LapNumbers {
            lap,
            ticks,
            nodes,
            edges,
            loops,
            rms_m,
            map_rms_m,
            removed,
            divergence,
            points_gone,
            wardrobe_points,
        } = *numbers;
        Self {
            lap,
            ticks,
            nodes,
            edges,
            loops,
            removed,
            divergence,
            points_gone,
            wardrobe_points,
            bytes,
            ms_per_tick,
            rms: rms_m,
            map_rms: map_rms_m,
        }
    }

    fn print(&self) {
        say!(
            "{:>3}  {:>5}  {:>5}  {:>5}  {:>9}  {:>4.1}  {:>3.0}  {:>7.3}  {:>7.4}  {:>5.3}",
            self.lap,
            self.nodes,
            self.edges,
            self.loops,
            self.removed,
            self.divergence,
            self.bytes as f64 / 1e3,
            self.ms_per_tick,
            self.rms,
            self.map_rms
        );
    }
}
