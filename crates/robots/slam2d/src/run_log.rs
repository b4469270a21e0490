//! `slam2d run`: runs the estimator on a recorded log.

use std::path::PathBuf;
use std::process::ExitCode;

use clap::Args;
use command_line::interrupt::Interrupt;
use command_line::log_args::AllLogArgs;
use command_line::log_file::open_robots;
use robot_io::log::{LogOptions, LogReader as _};

use crate::mapping::{Ended, Mapping, MappingArgs};

/// Map a recorded log, and evaluate the trajectory if a reference is given.
#[derive(Args, Clone, Debug)]
pub struct RunArgs {
    /// The log.
    log: PathBuf,
    /// Further parts of the same recording, such as the files of rosbag record --split, or the odometry of a table of scans.
    #[arg(value_name = "PART")]
    parts: Vec<PathBuf>,
    #[command(flatten)]
    options: AllLogArgs,
    #[command(flatten)]
    mapping: MappingArgs,
}

/// Runs the estimator on the log and prints the result; the exit code tells whether it reached the end of the log.
///
/// # Errors
/// If a file cannot be used. What was mapped before is written.
pub fn run(args: &RunArgs) -> anyhow::Result<ExitCode> {
    let name = args.log.display().to_string();
    let interrupt = Interrupt::watch();
    let mut mapping = Mapping::start(&args.mapping)?;
    let options = LogOptions {
        laser_before: mapping.laser_before,
        ..args.options.0.clone()
    };
    let (mut reader, mut progress) = open_robots(&args.log, &args.parts, &options)?;
    let mut ended = Ended {
        is_interrupted: true,
        ..Ended::default()
    };
    while !interrupt.came() {
        let Some(frame) = mapping.run.next_frame(&mut reader)? else {
            ended.is_interrupted = mapping.run.broken().is_some();
            break;
        };
        mapping.step(frame);
        progress.report(mapping.run.scans());
    }
    let broken = mapping.run.broken().map(str::to_owned);
    ended.broken = broken.map(anyhow::Error::msg);
    progress.end();
    ended.remarks = reader.notes().sentences(&name);
    ended.about.clone_from(&reader.notes().about);
    let title = args.log.file_name().unwrap_or(args.log.as_os_str());
    mapping.end(&name, &title.to_string_lossy(), ended)
}
