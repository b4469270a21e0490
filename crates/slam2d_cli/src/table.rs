//! `slam2d table`: computes the chapter's results table.

use ch16_lab::lap::{LapConfig, LapRunner, LapSummary};
use clap::Args;
use serde::Serialize;

use crate::output::{print_json, say};

/// Print the chapter's results table from the canonical run.
#[derive(Args, Clone, Debug)]
pub struct TableArgs {
    /// Print one JSON object.
    #[arg(long)]
    json: bool,
}

#[derive(Serialize)]
struct TableJson {
    seed: u32,
    ticks: usize,
    keyframes: usize,
    loops: usize,
    odometry: ColumnJson,
    front_end: ColumnJson,
    with_loops: ColumnJson,
}

/// A column of the table; rows that odometry lacks are null.
#[derive(Serialize)]
struct ColumnJson {
    end_error: f64,
    rms: f64,
    last_nine: Option<(f64, f64)>,
    largest_keyframe_error: Option<f64>,
    map_disagreement: Option<f64>,
}

impl ColumnJson {
    fn from_keyframes(summary: &LapSummary) -> Self {
        Self {
            end_error: summary.keyframe_end_error_m,
            rms: summary.keyframe_rms_m,
            last_nine: Some(summary.last_keyframes_m),
            largest_keyframe_error: Some(summary.keyframe_max_m),
            map_disagreement: summary.map_disagreement_m,
        }
    }

    fn from_odometry(summary: &LapSummary) -> Self {
        Self {
            end_error: summary.odometry_end_error_m,
            rms: summary.odometry_rms_m,
            last_nine: None,
            largest_keyframe_error: None,
            map_disagreement: None,
        }
    }
}

/// Runs the canonical lap and prints its table.
pub fn run(args: &TableArgs) {
    let config = LapConfig::default();
    let record = LapRunner::new().run(&config);
    let lap = &record.lap.summary;
    let columns = [
        ColumnJson::from_odometry(lap),
        ColumnJson::from_keyframes(&record.front_end.summary),
        ColumnJson::from_keyframes(lap),
    ];
    if args.json {
        let [odometry, front_end, with_loops] = columns;
        print_json(&TableJson {
            seed: config.drive.seed,
            ticks: lap.ticks,
            keyframes: lap.keyframes,
            loops: lap.loops,
            odometry,
            front_end,
            with_loops,
        });
        return;
    }
    say!(
        "canonical run, seed {:#X}: {} ticks, {} keyframes",
        config.drive.seed,
        lap.ticks,
        lap.keyframes
    );
    say!(
        "{:<30} {:>10} {:>12} {:>17}",
        "",
        "odometry",
        "front end",
        format!("+ {} loop factors", lap.loops)
    );
    print_row("position error at the end (m)", &columns, |c| {
        Some(format!("{:.4}", c.end_error))
    });
    print_row("rms position error (m)", &columns, |c| {
        Some(format!("{:.4}", c.rms))
    });
    print_row("last nine keyframes (m)", &columns, |c| {
        c.last_nine.map(|(low, high)| format!("{low:.2}–{high:.2}"))
    });
    print_row("largest keyframe error (m)", &columns, |c| {
        c.largest_keyframe_error.map(|value| format!("{value:.2}"))
    });
    print_row("map self-disagreement (m)", &columns, |c| {
        c.map_disagreement.map(|value| format!("{value:.4}"))
    });
}

fn print_row(name: &str, columns: &[ColumnJson; 3], entry: impl Fn(&ColumnJson) -> Option<String>) {
    let [odometry, front_end, with_loops] =
        columns.each_ref().map(|c| entry(c).unwrap_or_default());
    say!("{name:<30} {odometry:>10} {front_end:>12} {with_loops:>17}");
}
