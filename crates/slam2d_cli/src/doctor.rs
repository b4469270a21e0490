//! `slam2d doctor`: what is wrong with a recording, and how to correct it.

use std::path::PathBuf;

use clap::Args;
use robot_io::doctor::Checkup;
use robot_io::log::LogReader;

use crate::log_file::{FileError, TopicArgs, open_compared};
use crate::output::{print_json, say};

/// Check a recording: print sensor, odometry, mounting, clocks and file, each with ✓, ! or ✗.
#[derive(Args, Clone, Debug)]
pub struct DoctorArgs {
    /// The log, or the folder of a ROS 2 recording.
    log: PathBuf,
    #[command(flatten)]
    topics: TopicArgs,
    /// Print one JSON object.
    #[arg(long)]
    json: bool,
}

/// Reads the log and prints the diagnosis.
///
/// # Errors
/// If the log cannot be read at all.
pub fn run(args: &DoctorArgs) -> Result<(), FileError> {
    let (mut reader, mut progress) = open_compared(&args.log, &args.topics)?;
    let mut checkup = Checkup::default();
    while let Some(frame) = reader.next_frame()? {
        checkup.add(&frame);
        progress.report(checkup.scans());
    }
    progress.end();
    let name = args.log.file_name().unwrap_or(args.log.as_os_str());
    let motion = reader.motion().cloned().unwrap_or_default();
    let diagnosis = checkup.finish(&name.to_string_lossy(), reader.notes(), &motion);
    if args.json {
        print_json(&diagnosis);
    } else {
        say!("{}", diagnosis.text().trim_end());
    }
    Ok(())
}
