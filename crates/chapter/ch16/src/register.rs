//! `ch16 register`: registers a scan file on a map file and measures the time.

use std::num::NonZeroU32;
use std::path::{Path, PathBuf};

use bench_support::timed;
use ch16_slam2d::cloud::{DenseMap, PointCloud};
use ch16_slam2d::icp::{Icp, IcpConfig, IcpSummary, IcpVariant, IcpWorkspace, StopReason};
use clap::{Args, ValueEnum};
use pr_geom::SE2;
use serde::Serialize;

use command_line::in_file::InFile as _;
use command_line::numbers;
use command_line::output::{pose, print_json, say};

/// Map cell size as a share of τ: a query then visits a handful of cells.
const CELL_PER_TAU: f64 = 0.5;
/// Neighbourhood radius for the normals of a map without them, for point-to-plane, m.
const NORMAL_RADIUS_M: f64 = 0.3;

/// Register a scan on a map; both files have lines x,y[,nx,ny] in metres.
#[derive(Args, Clone, Debug)]
pub struct RegisterArgs {
    /// Points of the map.
    #[arg(value_name = "MAP.csv")]
    map: PathBuf,
    /// Points of the scan.
    #[arg(value_name = "SCAN.csv")]
    scan: PathBuf,
    /// Point-to-plane or point-to-point.
    #[arg(long, value_enum, default_value_t = MethodName::P2l)]
    method: MethodName,
    /// Correspondence distance τ, m.
    #[arg(long, default_value = "0.5", value_parser = numbers::tau_m, allow_hyphen_values = true)]
    tau: f64,
    /// Register this many times and report the fastest.
    #[arg(long, value_name = "N", default_value = "1")]
    repeat: NonZeroU32,
    /// Print one JSON object.
    #[arg(long)]
    json: bool,
}

/// `--method`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum MethodName {
    /// Point-to-plane distances, along normals.
    P2l,
    /// Point-to-point distances.
    P2p,
}

#[derive(Serialize)]
struct RegisterJson {
    method: &'static str,
    tau_m: f64,
    map_points: usize,
    scan_points: usize,
    #[serde(flatten)]
    found: IcpSummary,
    us: f64,
    us_build: f64,
}

/// Registers and prints pose and times.
///
/// # Errors
/// If a file cannot be read or has a malformed line.
pub fn run(args: &RegisterArgs) -> anyhow::Result<()> {
    let map_points = read_points(&args.map)?;
    let scan = read_points(&args.scan)?;
    let (variant, method) = match args.method {
        MethodName::P2l => (IcpVariant::PointToPlane, "p2l"),
        MethodName::P2p => (IcpVariant::PointToPoint, "p2p"),
    };
    let config = IcpConfig {
        variant,
        tau_m: args.tau,
        ..IcpConfig::default()
    };
    let needs_normals = variant == IcpVariant::PointToPlane && !map_points.has_normals();
    let mut map = DenseMap::new(CELL_PER_TAU * args.tau, usize::MAX);
    let us_build = fastest_us(args.repeat, || {
        if needs_normals {
            let mut with_normals = map_points.clone();
            with_normals.estimate_normals(NORMAL_RADIUS_M);
            map.rebuild(&with_normals);
        } else {
            map.rebuild(&map_points);
        }
    });
    let mut workspace = IcpWorkspace::new();
    let mut register = || Icp::new(&scan, &map, SE2::identity(), &config, &mut workspace).run();
    let found: IcpSummary = register();
    let us = fastest_us(args.repeat, || {
        std::hint::black_box(register());
    });
    if args.json {
        print_json(&RegisterJson {
            method,
            tau_m: args.tau,
            map_points: map_points.len(),
            scan_points: scan.len(),
            found,
            us,
            us_build,
        });
        return Ok(());
    }
    say!("pose        {}", pose(&found.pose));
    say!("pairs       {} of {}", found.inliers, scan.len());
    if found.rmse_m.is_finite() {
        say!("rmse        {:.5} m", found.rmse_m);
    } else {
        say!("rmse        none, without pairs");
    }
    say!("iterations  {}", found.iterations);
    say!("stop        {}", why(&found.stop));
    say!("time        {us:.1} µs, map {us_build:.1} µs");
    Ok(())
}

/// Why a registration ended.
fn why(stop: &StopReason) -> String {
    match stop {
        StopReason::SmallStep { step, tolerance } => {
            format!("converged: the last step, {step:.1e}, is below {tolerance:.1e}")
        }
        StopReason::IterationLimit { max_iterations } => {
            format!("not converged after {max_iterations} iterations")
        }
        StopReason::TooFewPairs { pairs, min_pairs } => format!(
            "too few pairs within tau: {pairs}, {min_pairs} are needed; \
             move the scan closer to the map, or use a larger --tau"
        ),
        StopReason::TooFewNormals {
            normals,
            pairs,
            min_normals,
        } => format!(
            "not registered: {normals} of {pairs} pairs have a normal, {min_normals} are needed; \
             give the map more points or its normals, or use --method p2p"
        ),
        StopReason::TooFewInliers { .. } => format!("not converged: {stop}"),
        StopReason::Unobservable { .. } => {
            format!("not converged: {stop}; along it the pose stays at the start")
        }
        StopReason::NotFinite => {
            "the next step overflows; move the points closer to the origin".to_owned()
        }
    }
}

/// The fastest of `repeat` calls in microseconds of this thread's time.
fn fastest_us(repeat: NonZeroU32, mut call: impl FnMut()) -> f64 {
    (0..repeat.get())
        .map(|_| 1e3 * timed(&mut call).1)
        .fold(f64::INFINITY, f64::min)
}

fn read_points(path: &Path) -> anyhow::Result<PointCloud> {
    let text = std::fs::read(path).in_file(path)?;
    PointCloud::from_csv(&text).in_file(path)
}
