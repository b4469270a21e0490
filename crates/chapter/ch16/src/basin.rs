//! `ch16 basin`: basin of convergence of ICP in w16.1, from one start or a sweep of headings.

use ch16_lab::basin::{BasinOutcome, BasinScene, BasinStart};
use ch16_slam2d::icp::{IcpConfig, IcpVariant, IcpWorkspace, StopReason};
use clap::{Args, ValueEnum};
use pr_geom::{Point2, SE2, Vector2};
use serde::Serialize;

use command_line::numbers::{self, Headings};
use command_line::output::{pose, print_json, say};

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
    variant: &'static str,
    tau_m: f64,
    /// Points of the target in its sensor's frame, m.
    target: Vec<Point2<f64>>,
    /// Unit normals of the target's points; null for points without one.
    normals: Vec<Option<Vector2<f64>>>,
    /// Points of the source in its sensor's frame, m.
    source: Vec<Point2<f64>>,
    /// The true `target_from_source`.
    truth: SE2,
    runs: Vec<RunJson>,
}

#[derive(Serialize)]
struct RunJson {
    #[serde(flatten)]
    start: BasinStart,
    #[serde(flatten)]
    outcome: BasinOutcome,
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
        let target = scene.target();
        print_json(&BasinJson {
            variant: variant_name,
            tau_m: args.tau,
            target: target.iter().collect(),
            normals: (0..target.len()).map(|k| target.normal(k)).collect(),
            source: scene.source().iter().collect(),
            truth: scene.truth(),
            runs: runs
                .map(|(heading_deg, outcome)| RunJson {
                    start: BasinStart {
                        heading_deg,
                        ..start
                    },
                    outcome,
                })
                .collect(),
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
                StopReason::TooFewNormals { .. } => " (too few normals)",
                StopReason::TooFewInliers { .. } => " (too few inliers)",
                StopReason::Unobservable { .. } => " (unobservable direction)",
                StopReason::NotFinite => " (numeric overflow)",
            },
            pose(&outcome.pose),
        );
    }
}
