//! `slam2d info`: summary of a recorded log or a session.

mod session_info;

use std::collections::BTreeMap;
use std::path::PathBuf;

use clap::Args;
use robot_io::info::LogInfo;
use serde::Serialize;

use crate::session_file::is_session;
use command_line::log_args::TopicArgs;
use command_line::log_file::open_log;
use command_line::output::{print_json, say};

/// Print a summary of a recorded log or a session: scans, beams, odometry, stamps, and unreadable records.
#[derive(Args, Clone, Debug)]
pub struct InfoArgs {
    /// The log, the session, or the folder of a run.
    log: PathBuf,
    /// Further parts of the same recording, such as the files of rosbag record --split, or the odometry of a table of scans.
    #[arg(value_name = "PART")]
    parts: Vec<PathBuf>,
    #[command(flatten)]
    options: TopicArgs,
    /// Print one JSON object.
    #[arg(long)]
    json: bool,
}

#[derive(Serialize)]
struct InfoJson<'a> {
    records: &'a BTreeMap<String, usize>,
    broken_lines: usize,
    about: &'a [String],
    #[serde(flatten)]
    info: &'a LogInfo,
}

/// Reads the log once and prints its summary.
///
/// # Errors
/// If it cannot be read.
pub fn run(args: &InfoArgs) -> anyhow::Result<()> {
    if is_session(&args.log) {
        return session_info::run(&args.log, args.json);
    }
    let (mut reader, mut progress) = open_log(&args.log, &args.parts, &args.options.0)?;
    let mut info = LogInfo::default();
    while let Some(frame) = reader.next_frame()? {
        info.add(&frame);
        progress.report(info.scans);
    }
    progress.end();
    let notes = reader.notes();
    for sentence in notes.sentences(&args.log.display().to_string()) {
        eprintln!("slam2d: {sentence}");
    }
    if args.json {
        print_json(&InfoJson {
            records: &notes.records,
            broken_lines: notes.broken,
            about: &notes.about,
            info: &info,
        });
        return Ok(());
    }
    for (name, count) in &notes.records {
        say!("{name:<16} {count}");
    }
    for sentence in &notes.about {
        say!("{sentence}");
    }
    say!("scans            {}", info.scans);
    say!(
        "beams            {} to {}",
        info.fewest_beams,
        info.most_beams
    );
    say!("field of view    {:.1}°", info.field_of_view_deg);
    say!("longest return   {:.2} m", info.longest_return_m);
    say!(
        "returns          {:.0} in the median scan",
        info.median_returns
    );
    say!("duration         {:.1} s", info.duration_s);
    say!(
        "stamps           {}",
        if info.late == 0 {
            "in order".to_owned()
        } else {
            format!("{} are not later than the one before", info.late)
        }
    );
    match info.odometry_path_length_m {
        Some(path_length_m) => say!("odometry         {path_length_m:.1} m"),
        None => say!("odometry         none"),
    }
    Ok(())
}
