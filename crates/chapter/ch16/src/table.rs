//! `ch16 table`: computes the chapter's results table.

use ch16_lab::lap::{LapConfig, LapRunner, LapSummary};
use clap::Args;
use serde::Serialize;

use crate::lap::report::GraphLapJson;
use command_line::output::{print_json, say};

/// Print the chapter's results table from the canonical run.
#[derive(Args, Clone, Debug)]
pub struct TableArgs {
    /// Print one JSON object.
    #[arg(long)]
    json: bool,
}

/// The summaries of both estimators; each has the figures of odometry, too.
#[derive(Serialize)]
struct TableJson {
    seed: u32,
    front_end: GraphLapJson,
    with_loops: GraphLapJson,
}

/// Runs the canonical lap and prints its table.
pub fn run(args: &TableArgs) {
    let config = LapConfig::default();
    let record = LapRunner::new().run(&config);
    let (front_end, lap) = (record.front_end.summary, record.lap.summary);
    if args.json {
        print_json(&TableJson {
            seed: config.drive.seed,
            front_end: GraphLapJson::from(&record.front_end),
            with_loops: GraphLapJson::from(&record.lap),
        });
        return;
    }
    say!(
        "canonical run, seed {:#X}: {} ticks, {} keyframes",
        config.drive.seed,
        lap.ticks,
        lap.keyframes
    );
    let loops = format!("+ {} loop factors", record.lap.graph_summary.loops);
    print_row("", ["odometry", "front end", &loops]);
    let row = |name, odometry: Option<String>, of: fn(&LapSummary) -> String| {
        let odometry = odometry.unwrap_or_default();
        print_row(name, [&odometry, &of(&front_end), &of(&lap)]);
    };
    let four = |value_m: f64| Some(format!("{value_m:.4}"));
    row(
        "position error at the end (m)",
        four(lap.odometry_end_error_m),
        |of| format!("{:.4}", of.keyframe_end_error_m),
    );
    row("rms position error (m)", four(lap.odometry_rms_m), |of| {
        format!("{:.4}", of.keyframe_rms_m)
    });
    row("last nine keyframes (m)", None, |of| {
        let (low_m, high_m) = of.last_keyframes_m;
        format!("{low_m:.2}–{high_m:.2}")
    });
    row("largest keyframe error (m)", None, |of| {
        format!("{:.2}", of.keyframe_max_m)
    });
    row("map self-disagreement (m)", None, |of| {
        let value_m = of.map_disagreement_m;
        value_m.map_or_else(String::new, |value_m| format!("{value_m:.4}"))
    });
}

fn print_row(name: &str, [odometry, front_end, with_loops]: [&str; 3]) {
    say!("{name:<30} {odometry:>10} {front_end:>12} {with_loops:>17}");
}
