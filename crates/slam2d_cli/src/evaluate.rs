//! `slam2d evaluate`: accuracy of a trajectory.

use std::path::{Path, PathBuf};

use clap::Args;
use robot_io::log::LogReader;
use robot_io::trajectory::{StampedPose, Trajectory};
use thiserror::Error;

use crate::grade::{GradeError, ReferenceArgs};
use crate::log_file::{FileError, OdometryArgs, TopicArgs, open, open_compared};
use crate::output::print_json;

/// Evaluate a trajectory against reference relations or the true trajectory.
#[derive(Args, Clone, Debug)]
pub struct EvaluateArgs {
    /// The trajectory: TUM lines, stamp x y z qx qy qz qw.
    trajectory: PathBuf,
    #[command(flatten)]
    reference: ReferenceArgs,
    /// The log that it was made from: its odometry propagates the poses to the scans in between.
    #[arg(long, value_name = "FILE")]
    log: Option<PathBuf>,
    #[command(flatten)]
    topics: TopicArgs,
    /// Print one JSON object.
    #[arg(long)]
    json: bool,
}

/// Why the evaluation failed.
#[derive(Debug, Error)]
pub enum EvaluateError {
    /// Neither relations nor a true trajectory are given.
    #[error("no reference is given; use --relations FILE or --truth FILE")]
    NoReference,
    /// The log has no odometry for propagating poses.
    #[error("{0} has no odometry to propagate poses; omit --log")]
    NoOdometry(String),
    /// The log cannot be read.
    #[error(transparent)]
    File(#[from] FileError),
    /// The comparison failed.
    #[error(transparent)]
    Grade(#[from] GradeError),
}

/// Reads trajectory and reference and prints the errors.
///
/// # Errors
/// If a file cannot be used, or nothing can be compared.
pub fn run(args: &EvaluateArgs) -> Result<(), EvaluateError> {
    let reference = args.reference.read()?.ok_or(EvaluateError::NoReference)?;
    let name = args.trajectory.display().to_string();
    let mut trajectory =
        Trajectory::read_tum(open(&args.trajectory)?, &name).map_err(GradeError::from)?;
    if let Some(path) = &args.log {
        let odometry = odometry(path, &args.topics)?;
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
fn odometry(path: &Path, topics: &TopicArgs) -> Result<Trajectory, EvaluateError> {
    let (mut reader, mut progress) = open_compared(path, topics, OdometryArgs::default())?;
    let mut poses: Vec<StampedPose> = Vec::new();
    while let Some(frame) = reader.next_frame().map_err(FileError::from)? {
        progress.report(poses.len());
        let Some(pose) = frame.odometry else { continue };
        let stamp_s = frame.stamp_s;
        if poses.last().is_none_or(|last| stamp_s > last.stamp_s) {
            poses.push(StampedPose { stamp_s, pose });
        }
    }
    progress.end();
    if poses.is_empty() {
        return Err(EvaluateError::NoOdometry(path.display().to_string()));
    }
    Ok(Trajectory::new(poses))
}
