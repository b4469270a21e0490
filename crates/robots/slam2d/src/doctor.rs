//! `slam2d doctor`: what is wrong with a recording, and how to correct it.

use std::path::PathBuf;
use std::process::ExitCode;

use clap::Args;
use robot_io::doctor::Checkup;
use robot_io::log::LogReader;
use robot_io::remark::Condition;
use robot_io::run::LogRun;

use command_line::log_args::OneRobotArgs;
use command_line::log_file::open_compared;
use command_line::output::{print_json, say};

/// Check a recording: print sensor, odometry, mounting, clocks and file, each with ✓, ! or ✗.
///
/// The exit code is 0 if everything is right, 1 if something was repaired or needs attention, and 2 if the recording cannot be
/// mapped, or not to its end.
#[derive(Args, Clone, Debug)]
pub struct DoctorArgs {
    /// The log, or the folder of a ROS recording.
    log: PathBuf,
    /// Further parts of the same recording, such as the files of rosbag record --split, or the odometry of a table of scans.
    #[arg(value_name = "PART")]
    parts: Vec<PathBuf>,
    #[command(flatten)]
    options: OneRobotArgs,
    /// Print one JSON object.
    #[arg(long)]
    json: bool,
}

/// Reads and maps the log and prints the diagnosis; returns the exit code.
///
/// # Errors
/// If the log cannot be read at all.
pub fn run(args: &DoctorArgs) -> anyhow::Result<ExitCode> {
    let (mut reader, mut progress) = open_compared(&args.log, &args.parts, &args.options.0)?;
    let mut checkup = Checkup::default();
    let mut run = LogRun::default();
    let is_whole = loop {
        match reader.next_frame() {
            Ok(Some(frame)) => {
                checkup.add(&frame);
                progress.report(checkup.scans());
                run.step(frame);
            }
            Ok(None) => break true,
            Err(problem) if checkup.scans() > 0 => {
                checkup.stop(&problem);
                break false;
            }
            Err(problem) => return Err(problem.into()),
        }
    };
    run.finish();
    progress.end();
    let name = args.log.file_name().unwrap_or(args.log.as_os_str());
    let motion = reader.motion().cloned().unwrap_or_default();
    let mut diagnosis = checkup.finish(&name.to_string_lossy(), reader.notes(), &motion);
    diagnosis.extend(run.remarks());
    if args.json {
        print_json(&diagnosis);
    } else {
        say!("{}", diagnosis.text().trim_end());
    }
    Ok(ExitCode::from(if !is_whole || !diagnosis.can_be_mapped() {
        2
    } else {
        u8::from(diagnosis.verdict != Condition::Good)
    }))
}
