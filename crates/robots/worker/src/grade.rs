//! Evaluates a trajectory against the user's reference: relations or true poses.

use log_messages::GradeReport;
use pr_geom::math;
use robot_io::evaluate::{Alignment, onto_truth, relation_errors, truth_errors};
use robot_io::relations::{Relation, read_relations};
use robot_io::trajectory::{StampedPose, Trajectory};

/// Largest time between a true pose and a keyframe, s.
const SLACK_S: f64 = 0.1;
/// Tolerance of a unit quaternion's length.
const UNIT_SLACK: f64 = 1e-3;

/// Reference of the evaluation.
#[derive(Clone, Debug, PartialEq)]
pub enum DroppedReference {
    /// Relations between two times.
    Relations(Vec<Relation>),
    /// True poses.
    Truth(Trajectory),
}

impl DroppedReference {
    /// Reads either, by the file name, or else by whether the last four numbers are a unit quaternion.
    ///
    /// # Errors
    /// If a line is malformed; the message is one sentence.
    pub fn read(bytes: &[u8], name: &str) -> Result<Self, String> {
        let ends = |end: &str| name.to_ascii_lowercase().ends_with(end);
        let is_truth = ends(".tum") || (!ends(".relations") && has_quaternions(bytes));
        let read = if is_truth {
            Trajectory::read_tum(bytes, name).map(Self::Truth)
        } else {
            read_relations(bytes, name).map(Self::Relations)
        };
        read.map_err(|problem| problem.to_string())
    }

    /// The errors in words, their mean, and that of each keyframe.
    ///
    /// # Errors
    /// If the two have no common times; the message is one sentence.
    pub fn grade(
        &self,
        trajectory: &Trajectory,
        keyframes: &Trajectory,
        name: &str,
    ) -> Result<GradeReport, String> {
        match self {
            Self::Relations(relations) => {
                let report = relation_errors(trajectory, relations).report();
                if report.n == 0 {
                    return Err(format!(
                        "{name}: none of its {} relations is within the times of the trajectory; use the same clock for both",
                        relations.len()
                    ));
                }
                let words = format!(
                    "{} relations: mean {:.3} m, median {:.3} m; mean {:.2}°",
                    report.n, report.trans.mean, report.trans.median, report.rot_deg.mean
                );
                Ok(GradeReport {
                    words,
                    error_m: report.trans.mean,
                    errors_m: errors_by_relation(trajectory, relations, keyframes),
                })
            }
            Self::Truth(truth) => {
                let named =
                    |problem: robot_io::evaluate::TruthProblem| format!("{name}: {problem}");
                let report = truth_errors(trajectory, truth, Alignment::Se2).map_err(named)?;
                let onto = onto_truth(trajectory, truth, Alignment::Se2).map_err(named)?;
                let ate = report.ate;
                let words = format!(
                    "{} poses: RMSE {:.3} m, at most {:.3} m from the truth",
                    report.n, ate.rmse, ate.max
                );
                let off = |pose: &StampedPose| {
                    let truth = truth.at(pose.stamp_s, SLACK_S)?;
                    let moved = onto * pose.pose;
                    Some(math::norm2(moved.x() - truth.x(), moved.y() - truth.y()))
                };
                let errors = keyframes.poses().iter();
                Ok(GradeReport {
                    words,
                    error_m: ate.rmse,
                    errors_m: errors.map(|pose| off(pose).unwrap_or(f64::NAN)).collect(),
                })
            }
        }
    }
}

/// The largest error of the relations that end at a keyframe or its following scans.
fn errors_by_relation(
    trajectory: &Trajectory,
    relations: &[Relation],
    keyframes: &Trajectory,
) -> Vec<f64> {
    let mut errors = vec![f64::NAN; keyframes.poses().len()];
    for relation in relations {
        let one = relation_errors(trajectory, core::slice::from_ref(relation));
        let Some(&error_m) = one.translations_m.first() else {
            continue;
        };
        let poses = keyframes.poses();
        let after = poses.partition_point(|pose| pose.stamp_s <= relation.second_s);
        if let Some(slot) = errors.get_mut(after.saturating_sub(1)) {
            // `max` ignores NaN.
            *slot = slot.max(error_m);
        }
    }
    errors
}

/// Whether the last four numbers of the first line have length 1.
fn has_quaternions(bytes: &[u8]) -> bool {
    let lines = bytes.split(|&byte| byte == b'\n').take(1000);
    let mut lines = lines.filter_map(|line| core::str::from_utf8(line).ok());
    let Some(line) = lines.find(|line| !line.trim().is_empty() && !line.trim().starts_with('#'))
    else {
        return false;
    };
    let numbers: Vec<f64> = line
        .split_ascii_whitespace()
        .filter_map(|word| word.parse().ok())
        .collect();
    let Some(last) = numbers.last_chunk::<4>().filter(|_| numbers.len() == 8) else {
        return false;
    };
    let square: f64 = last.iter().map(|part| part * part).sum();
    (math::sqrt(square) - 1.0).abs() < UNIT_SLACK
}
