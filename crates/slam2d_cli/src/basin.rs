//! `slam2d basin`: basin of convergence of ICP in w16.1, from one start or a sweep of headings.

use ch16_lab::basin::{BasinOutcome, BasinScene, BasinStart};
use ch16_slam2d::cloud::PointCloud;
use ch16_slam2d::icp::{IcpConfig, IcpVariant, IcpWorkspace, StopReason};
use clap::{Args, ValueEnum};
use serde::Serialize;

use crate::numbers::{self, Headings};
use crate::output::{pose, print_json, say};

/// Register the two scans of room A from a perturbed initial guess.
#[derive(Args, Clone, Debug)]
pub struct BasinArgs {
    /// Error that the increments minimize.
    #[arg(long, value_enum, default_value_t = VariantName::PointToPoint)]
    variant: VariantName,
    /// Correspondence distance τ, m.
    #[arg(long, default_value = "0.7", value_parser = numbers::tau_m, allow_hyphen_values = true)]
    tau: f64,
    /// Added to the true x, m.
    #[arg(long, default_value = "0.55", value_parser = numbers::offset_m, allow_hyphen_values = true)]
    dx: f64,
    /// Added to the true y, m.
    #[arg(long, default_value = "0.45", value_parser = numbers::offset_m, allow_hyphen_values = true)]
    dy: f64,
    /// Added to the true heading, degrees: A, or A:B:STEP with both ends included.
    #[arg(
        long,
        value_name = "A[:B:STEP]",
        default_value = "25",
        value_parser = numbers::headings_deg,
        allow_hyphen_values = true
    )]
    heading_deg: Headings,
    /// Largest number of iterations.
    #[arg(long, default_value_t = BasinScene::MAX_ITERS)]
    max_iterations: usize,
    /// Print one JSON object.
    #[arg(long)]
    json: bool,
}

/// `--variant`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum VariantName {
    /// Point-to-point distances.
    #[value(alias = "p2p")]
    PointToPoint,
    /// Point-to-plane distances, along normals.
    #[value(alias = "p2l")]
    PointToPlane,
}

#[derive(Serialize)]
struct BasinJson {
    /// Points of the target in its sensor's frame, m.
    target: Vec<[f64; 2]>,
    /// Unit normals of the target's points; null for points without one.
    normals: Vec<Option<[f64; 2]>>,
    /// Points of the source in its sensor's frame, m.
    source: Vec<[f64; 2]>,
    /// The true `target_from_source`.
    truth: [f64; 3],
    runs: Vec<RunJson>,
}

#[derive(Serialize)]
struct RunJson {
    heading_deg: f64,
    dx: f64,
    dy: f64,
    variant: &'static str,
    tau: f64,
    pose: [f64; 3],
    iterations: usize,
    converged: bool,
    rmse: Option<f64>,
    inliers: usize,
    error_m: f64,
    error_deg: f64,
    minimum: &'static str,
}

/// Registers from every heading and prints the outcomes.
pub fn run(args: &BasinArgs) {
    let scene = BasinScene::new();
    let (variant, variant_name) = match args.variant {
        VariantName::PointToPoint => (IcpVariant::PointToPoint, "point-to-point"),
        VariantName::PointToPlane => (IcpVariant::PointToPlane, "point-to-plane"),
    };
    let config = IcpConfig {
        max_iterations: args.max_iterations,
        ..BasinScene::config(variant, args.tau)
    };
    let start = BasinStart {
        dx_m: args.dx,
        dy_m: args.dy,
        ..BasinStart::default()
    };
    let headings = || args.heading_deg.0.iter().copied();
    let mut workspace = IcpWorkspace::new();
    let outcomes = scene.sweep(start, headings(), &config, &mut workspace);
    let runs = headings().zip(outcomes);
    if args.json {
        let run_json = |(heading_deg, outcome): (f64, BasinOutcome)| RunJson {
            heading_deg,
            dx: args.dx,
            dy: args.dy,
            variant: variant_name,
            tau: args.tau,
            pose: outcome.pose.to_array(),
            iterations: outcome.iterations,
            converged: outcome.stop.converged(),
            rmse: outcome.rmse_m.is_finite().then_some(outcome.rmse_m),
            inliers: outcome.inliers,
            error_m: outcome.error_m,
            error_deg: outcome.error_deg,
            minimum: outcome.ending.name(),
        };
        let target = scene.target();
        print_json(&BasinJson {
            target: points(target),
            normals: (0..target.len())
                .map(|index| target.normal(index).map(Into::into))
                .collect(),
            source: points(scene.source()),
            truth: scene.truth().to_array(),
            runs: runs.map(run_json).collect(),
        });
        return;
    }
    say!(
        "{variant_name}, tau {} m, offset ({}, {}) m",
        args.tau,
        args.dx,
        args.dy
    );
    for (heading_deg, outcome) in runs {
        say!(
            "{heading_deg:>8.2}°  {:<22} error {:.3} m, {:.1}°  rmse {:.3} m  {} pairs  \
             {} iterations{}  {}",
            outcome.ending.name(),
            outcome.error_m,
            outcome.error_deg,
            outcome.rmse_m,
            outcome.inliers,
            outcome.iterations,
            match outcome.stop {
                StopReason::SmallStep { .. } => "",
                StopReason::IterationLimit { .. } => " (used up)",
                StopReason::TooFewPairs { .. } => " (too few pairs)",
                StopReason::NotFinite => " (numeric overflow)",
            },
            pose(&outcome.pose),
        );
    }
}

fn points(cloud: &PointCloud) -> Vec<[f64; 2]> {
    cloud.iter().map(Into::into).collect()
}
