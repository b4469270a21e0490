//! `slam2d register`: one registration of a scan file on a map file, timed.

use std::num::NonZeroU32;
use std::path::{Path, PathBuf};

use ch16_slam2d::cloud::{CsvError, DenseMap, PointCloud};
use ch16_slam2d::icp::{Icp, IcpConfig, IcpSummary, IcpVariant, IcpWorkspace, StopReason};
use clap::{Args, ValueEnum};
use measuring::timed;
use pr_geom::SE2;
use serde::Serialize;
use thiserror::Error;

use crate::numbers;
use crate::output::{pose, print_json, say};

/// Width of a map cell as a share of τ: a query then sees a handful of cells.
const CELL_PER_TAU: f64 = 0.5;
/// Radius in which a map without normals gets them for point-to-plane, m.
const NORMAL_RADIUS_M: f64 = 0.3;

/// Register a scan on a map, both files of x,y[,nx,ny] lines in metres.
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
    /// Register so many times and report the fastest.
    #[arg(long, value_name = "N", default_value = "1")]
    repeat: NonZeroU32,
    /// Print one JSON object.
    #[arg(long)]
    json: bool,
}

/// `--method`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum MethodName {
    /// Distances along normals.
    P2l,
    /// Distances between points.
    P2p,
}

/// Why a file cannot be used.
#[derive(Debug, Error)]
pub enum RegisterFailure {
    /// It cannot be read.
    #[error("{}: {source}", path.display())]
    File {
        /// Which file.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// It holds no cloud.
    #[error("{}: {source}", path.display())]
    Cloud {
        /// Which file.
        path: PathBuf,
        /// What is wrong, and in which line.
        source: CsvError,
    },
}

#[derive(Serialize)]
struct RegisterJson {
    method: &'static str,
    tau: f64,
    map_points: usize,
    scan_points: usize,
    pose: [f64; 3],
    iterations: usize,
    converged: bool,
    rmse: Option<f64>,
    inliers: usize,
    us: f64,
    us_build: f64,
}

/// Registers and prints pose and times.
///
/// # Errors
/// Where a file cannot be read or has a line that is not a point.
pub fn run(args: &RegisterArgs) -> Result<(), RegisterFailure> {
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
            tau: args.tau,
            map_points: map_points.len(),
            scan_points: scan.len(),
            pose: found.pose.to_array(),
            iterations: found.iterations,
            converged: found.stop.converged(),
            rmse: found.rmse_m.is_finite().then_some(found.rmse_m),
            inliers: found.inliers,
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

/// Why a registration ended, as a sentence.
fn why(stop: &StopReason) -> String {
    match stop {
        StopReason::SmallStep { step, tolerance } => {
            format!("converged: the last step, {step:.1e}, is below {tolerance:.1e}")
        }
        StopReason::IterationLimit { max_iterations } => {
            format!("not converged after {max_iterations} iterations")
        }
        StopReason::TooFewPairs { pairs, min_pairs } => format!(
            "too few pairs within tau: {pairs} where {min_pairs} are needed; \
             bring the scan nearer to the map, or take a larger --tau"
        ),
        StopReason::NotFinite => {
            "the next step is out of the range of numbers; bring the points nearer to the origin"
                .to_owned()
        }
    }
}

/// The fastest of `repeat` calls in microseconds of this thread's time.
fn fastest_us(repeat: NonZeroU32, mut call: impl FnMut()) -> f64 {
    (0..repeat.get())
        .map(|_| 1e3 * timed(&mut call).1)
        .fold(f64::INFINITY, f64::min)
}

fn read_points(path: &Path) -> Result<PointCloud, RegisterFailure> {
    let text = std::fs::read(path).map_err(|source| RegisterFailure::File {
        path: path.to_owned(),
        source,
    })?;
    PointCloud::from_csv(&text).map_err(|source| RegisterFailure::Cloud {
        path: path.to_owned(),
        source,
    })
}
