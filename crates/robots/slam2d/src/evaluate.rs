//! `slam2d evaluate`: accuracy of a trajectory.

use std::path::{Path, PathBuf};

use anyhow::{Context as _, ensure};
use clap::Args;
use robot_io::log::{LogOptions, LogReader as _};
use robot_io::trajectory::{StampedPose, Trajectory};

use crate::grade::ReferenceArgs;
use command_line::log_args::TopicArgs;
use command_line::log_file::{open, open_compared};
use command_line::output::print_json;

/// Evaluate a trajectory against reference relations or the true trajectory.
#[derive(Args, Clone, Debug)]
pub struct EvaluateArgs {
    /// The trajectory: TUM lines, stamp x y z qx qy qz qw.
    trajectory: PathBuf,
    #[command(flatten)]
    reference: ReferenceArgs,
    /// The log it was made from, whose odometry propagates the poses to the scans in between.
    #[arg(long, value_name = "FILE")]
    log: Option<PathBuf>,
    #[command(flatten)]
    options: TopicArgs,
    /// Print one JSON object.
    #[arg(long)]
    json: bool,
}

/// Reads trajectory and reference and prints the errors.
///
/// # Errors
/// If a file cannot be used, or nothing can be compared.
pub fn run(args: &EvaluateArgs) -> anyhow::Result<()> {
    let reference = args.reference.read()?;
    let reference =
        reference.context("no reference is given; use --relations FILE or --truth FILE")?;
    let name = args.trajectory.display().to_string();
    let mut trajectory = Trajectory::read_tum(open(&args.trajectory)?, &name)?;
    if let Some(path) = &args.log {
        let odometry = odometry(path, &args.options.0)?;
        trajectory = trajectory.carried_by(&odometry);
    }
    let grade = reference.grade(&trajectory)?;
    if args.json {
        print_json(&grade);
    } else {
        grade.print();
    }
    Ok(())
}

/// The odometry of a log at its scans, without those whose stamp is not later than the one before.
fn odometry(path: &Path, options: &LogOptions) -> anyhow::Result<Trajectory> {
    let (mut reader, mut progress) = open_compared(path, &[], options)?;
    let mut poses: Vec<StampedPose> = Vec::new();
    while let Some(frame) = reader.next_frame()? {
        progress.report(poses.len());
        let Some(pose) = frame.odometry else { continue };
        let stamp_s = frame.stamp_s;
        if poses.last().is_none_or(|last| stamp_s > last.stamp_s) {
            poses.push(StampedPose { stamp_s, pose });
        }
    }
    progress.end();
    ensure!(
        !poses.is_empty(),
        "{} has no odometry to propagate poses; omit --log",
        path.display()
    );
    Ok(Trajectory::new(poses))
}
