//! Evaluates a trajectory against a file of relations or the true trajectory.

use std::path::PathBuf;

use anyhow::bail;
use clap::{Args, ValueEnum};
use robot_io::evaluate::{Alignment, RelationReport, TruthReport, relation_errors, truth_errors};
use robot_io::relations::{Relation, read_relations};
use robot_io::trajectory::{StampedPose, Trajectory};
use serde::Serialize;

use command_line::log_file::open;
use command_line::output::say;

/// Reference of the evaluation.
#[derive(Args, Clone, Debug)]
pub struct ReferenceArgs {
    /// Reference relations: lines of t1 t2 x y z roll pitch yaw.
    #[arg(long, value_name = "FILE", conflicts_with = "truth")]
    pub relations: Option<PathBuf>,
    /// The true trajectory: TUM lines.
    #[arg(long, value_name = "FILE")]
    pub truth: Option<PathBuf>,
    /// Whether the trajectory is aligned with the true one before the comparison.
    #[arg(long, value_enum, default_value = "none")]
    pub align: AlignArg,
}

/// Command line values of [`Alignment`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum AlignArg {
    /// None: both are in the same frame.
    None,
    /// Least-squares rigid motion in the plane.
    Se2,
}

impl From<AlignArg> for Alignment {
    fn from(align: AlignArg) -> Self {
        match align {
            AlignArg::None => Self::None,
            AlignArg::Se2 => Self::Se2,
        }
    }
}

/// The reference, read before the run.
pub enum Reference {
    /// Relations between two times.
    Relations(Vec<Relation>),
    /// True poses.
    Truth(Trajectory, Alignment),
}

/// Errors against a reference.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Grade {
    /// Against relations.
    Relations(RelationReport),
    /// Against the truth.
    Truth(TruthReport),
}

/// The grade as JSON has it: against relations, and against the truth.
pub fn by_reference(grade: Option<Grade>) -> (Option<Grade>, Option<Grade>) {
    match grade {
        Some(Grade::Relations(_)) => (grade, None),
        Some(Grade::Truth(_)) | None => (None, grade),
    }
}

impl ReferenceArgs {
    /// Reads the reference, if one is given.
    ///
    /// # Errors
    /// If its file cannot be used.
    pub fn read(&self) -> anyhow::Result<Option<Reference>> {
        if let Some(path) = &self.relations {
            let relations = read_relations(open(path)?, &path.display().to_string())?;
            return Ok(Some(Reference::Relations(relations)));
        }
        if let Some(path) = &self.truth {
            let truth = Trajectory::read_tum(open(path)?, &path.display().to_string())?;
            return Ok(Some(Reference::Truth(truth, self.align.into())));
        }
        Ok(None)
    }
}

impl Reference {
    /// Evaluates a trajectory; reports skipped relations on standard error, and an ATE that a rigid motion more than
    /// halves: the two are probably in different frames.
    ///
    /// # Errors
    /// If nothing can be compared.
    pub fn grade(&self, trajectory: &Trajectory) -> anyhow::Result<Grade> {
        match self {
            Self::Relations(relations) => {
                let errors = relation_errors(trajectory, relations);
                let report = errors.report();
                if report.n == 0 {
                    let stamp_s =
                        |pose: Option<&StampedPose>| pose.map_or(0.0, |pose| pose.stamp_s);
                    bail!(
                        "none of the {} relations is within the times of the trajectory, {} s to {} s; use the same clock for both",
                        relations.len(),
                        stamp_s(trajectory.poses().first()),
                        stamp_s(trajectory.poses().last())
                    );
                }
                if errors.outside > 0 {
                    eprintln!(
                        "slam2d: {} of {} relations are outside the trajectory's times and are ignored",
                        errors.outside,
                        relations.len()
                    );
                }
                Ok(Grade::Relations(report))
            }
            Self::Truth(truth, alignment) => {
                let report = truth_errors(trajectory, truth, *alignment)?;
                let aligned_m = truth_errors(trajectory, truth, Alignment::Se2)?.ate.rmse;
                if 2.0 * aligned_m < report.ate.rmse {
                    eprintln!(
                        "slam2d: the ATE's rms is {:.4} m as given and {aligned_m:.4} m after a rigid motion; if the two trajectories are in different frames, add --align se2",
                        report.ate.rmse
                    );
                }
                Ok(Grade::Truth(report))
            }
        }
    }
}

impl Grade {
    /// Prints the errors as text.
    pub fn print(&self) {
        match self {
            Self::Relations(report) => {
                say!("relations        {}", report.n);
                for (name, unit, spread) in [
                    ("translation", "m", report.trans),
                    ("rotation", "°", report.rot_deg),
                    ("translation²", "m²", report.trans2),
                    ("rotation²", "°²", report.rot2),
                ] {
                    say!(
                        "{name:<16} {:.4} ± {:.4} {unit}, median {:.4}, 95% below {:.4}",
                        spread.mean,
                        spread.std,
                        spread.median,
                        spread.p95
                    );
                }
            }
            Self::Truth(report) => {
                say!("poses compared   {}", report.n);
                for (name, unit, errors) in [
                    ("ATE", "m", report.ate),
                    ("RPE", "m", report.rpe.trans),
                    ("RPE, rotation", "°", report.rpe.rot_deg),
                ] {
                    say!(
                        "{name:<16} rms {:.4} {unit}, mean {:.4}, median {:.4}, largest {:.4}",
                        errors.rmse,
                        errors.mean,
                        errors.median,
                        errors.max
                    );
                }
            }
        }
    }
}
