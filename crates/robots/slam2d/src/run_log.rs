//! `slam2d run`: runs the estimator on a recorded log.

use std::path::PathBuf;
use std::process::ExitCode;

use clap::Args;
use command_line::interrupt::Interrupt;
use command_line::log_file::{OdometryArgs, TopicArgs};
use command_line::robots::Robots;

use crate::mapping::{Ended, Mapping, MappingArgs};

/// Map a recorded log, and evaluate the trajectory if a reference is given.
#[derive(Args, Clone, Debug)]
pub struct RunArgs {
    /// The log.
    log: PathBuf,
    /// Further parts of the same recording, such as the files of rosbag record --split.
    #[arg(value_name = "PART")]
    parts: Vec<PathBuf>,
    #[command(flatten)]
    topics: TopicArgs,
    #[command(flatten)]
    odometry: OdometryArgs,
    /// Map all robots of a recording into one map, one after the other, if it has scans of several.
    #[arg(long, conflicts_with_all = ["scan_topic", "odom_topic", "odom_frame", "body_frame"])]
    all_robots: bool,
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
    let topics = args.topics.resuming_with(mapping.laser_before);
    let topics = topics.of_all_robots(args.all_robots).of_parts(&args.parts);
    let mut robots = Robots::open(&args.log, &topics, args.odometry)?;
    let mut ended = Ended {
        is_interrupted: true,
        ..Ended::default()
    };
    while !interrupt.came() {
        match robots.next_frame(&mut mapping.run) {
            Ok(Some(frame)) => {
                mapping.step(frame);
                robots.report(mapping.run.scans());
            }
            Ok(None) => {
                ended.is_interrupted = false;
                break;
            }
            Err(error) if mapping.run.scans() == 0 => return Err(error),
            Err(error) => {
                ended.broken = Some(error);
                break;
            }
        }
    }
    (ended.remarks, ended.about) = robots.end(!ended.is_interrupted);
    let title = args.log.file_name().unwrap_or(args.log.as_os_str());
    mapping.end(&name, &title.to_string_lossy(), ended)
}
