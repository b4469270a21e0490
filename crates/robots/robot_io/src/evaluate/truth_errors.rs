//! Errors against true poses: ATE and RPE, as evo computes them.
//!
//! Sturm, Engelhard, Endres, Burgard, Cremers, "A benchmark for the evaluation of RGB-D SLAM
//! systems", 2012. Association, alignment and statistics follow `evo_ape tum` and `evo_rpe tum` with their defaults
//! (Grupp, "evo: Python package for the evaluation of odometry and SLAM", 2017).

use pr_geom::{SE2, math};
use serde::Serialize;
use thiserror::Error;

use super::PoseErrors;
use crate::trajectory::Trajectory;

/// Largest difference between associated stamps, s: evo's default.
const MAX_DIFFERENCE_S: f64 = 0.01;

/// Whether the estimate is aligned with the truth before the comparison.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Alignment {
    /// None: both are in the same frame.
    #[default]
    None,
    /// Least-squares rigid motion in the plane (Umeyama 1991).
    ///
    /// evo aligns in 3-D. It flips the plane if the mirror image fits better, which happens with few poses or a nearly
    /// straight path, and it rejects collinear poses. This planar alignment does neither.
    Se2,
}

/// Why a trajectory cannot be compared with the truth.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum TruthProblem {
    /// Too few stamps match.
    #[error(
        "{matched} stamps of the trajectory are within {MAX_DIFFERENCE_S} s of the truth's, but two are needed; use the same clock for both"
    )]
    NoCommonStamps {
        /// Number of stamps that match.
        matched: usize,
    },
}

/// Errors from one pose to the next.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct RelativeErrors {
    /// Translations, m.
    pub trans: PoseErrors,
    /// Rotations, degrees.
    pub rot_deg: PoseErrors,
}

/// Errors against the truth.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct TruthReport {
    /// Number of poses compared.
    pub n: usize,
    /// Absolute position errors, m.
    pub ate: PoseErrors,
    /// Errors of the relative pose between consecutive compared poses.
    pub rpe: RelativeErrors,
}

/// Compares a trajectory with the truth.
///
/// # Errors
/// If fewer than two poses can be associated.
pub fn truth_errors(
    estimate: &Trajectory,
    truth: &Trajectory,
    alignment: Alignment,
) -> Result<TruthReport, TruthProblem> {
    let (pairs, onto_truth) = pairs_and_motion(estimate, truth, alignment)?;
    let absolute: Vec<f64> = pairs
        .iter()
        .map(|(estimate, truth)| {
            let moved = onto_truth * *estimate;
            math::norm2(moved.x() - truth.x(), moved.y() - truth.y())
        })
        .collect();
    let relative: Vec<SE2> = pairs
        .windows(2)
        .map(|pair| {
            let [(from, true_from), (to, true_to)] = [pair[0], pair[1]];
            true_from.between(&true_to).between(&from.between(&to))
        })
        .collect();
    let turns: Vec<f64> = relative
        .iter()
        .map(|error| error.theta().abs().to_degrees())
        .collect();
    let shifts: Vec<f64> = relative
        .iter()
        .map(|error| math::norm2(error.x(), error.y()))
        .collect();
    Ok(TruthReport {
        n: pairs.len(),
        ate: PoseErrors::from_errors(&absolute),
        rpe: RelativeErrors {
            trans: PoseErrors::from_errors(&shifts),
            rot_deg: PoseErrors::from_errors(&turns),
        },
    })
}

/// The alignment of a trajectory with the truth.
///
/// # Errors
/// If fewer than two poses can be associated.
pub fn onto_truth(
    estimate: &Trajectory,
    truth: &Trajectory,
    alignment: Alignment,
) -> Result<SE2, TruthProblem> {
    Ok(pairs_and_motion(estimate, truth, alignment)?.1)
}

/// Associated pairs (estimate, truth) and their alignment.
fn pairs_and_motion(
    estimate: &Trajectory,
    truth: &Trajectory,
    alignment: Alignment,
) -> Result<(Vec<(SE2, SE2)>, SE2), TruthProblem> {
    let pairs = associate(estimate, truth);
    if pairs.len() < 2 {
        return Err(TruthProblem::NoCommonStamps {
            matched: pairs.len(),
        });
    }
    let onto_truth = match alignment {
        Alignment::None => SE2::identity(),
        Alignment::Se2 => umeyama(&pairs),
    };
    Ok((pairs, onto_truth))
}

/// Pairs (estimate, truth): each pose of the shorter trajectory with the nearest in time of the longer one.
fn associate(estimate: &Trajectory, truth: &Trajectory) -> Vec<(SE2, SE2)> {
    let estimate_is_longer = estimate.poses().len() > truth.poses().len();
    let (short, long) = if estimate_is_longer {
        (truth.poses(), estimate.poses())
    } else {
        (estimate.poses(), truth.poses())
    };
    let mut pairs = Vec::new();
    for one in short {
        let after = long.partition_point(|other| other.stamp_s <= one.stamp_s);
        let gap_s = |index: usize| (long[index].stamp_s - one.stamp_s).abs();
        let above = (after < long.len()).then_some(after);
        let best = match (after.checked_sub(1), above) {
            (Some(below), Some(above)) if gap_s(above) < gap_s(below) => Some(above),
            (below, above) => below.or(above),
        };
        if let Some(best) = best.filter(|&best| gap_s(best) <= MAX_DIFFERENCE_S) {
            let other = long[best].pose;
            pairs.push(if estimate_is_longer {
                (other, one.pose)
            } else {
                (one.pose, other)
            });
        }
    }
    pairs
}

/// The rigid motion that aligns the estimated positions with the true ones.
fn umeyama(pairs: &[(SE2, SE2)]) -> SE2 {
    let count = pairs.len() as f64;
    let sum = |of: fn(&(SE2, SE2)) -> f64| pairs.iter().map(of).sum::<f64>() / count;
    let (ex, ey) = (sum(|pair| pair.0.x()), sum(|pair| pair.0.y()));
    let (tx, ty) = (sum(|pair| pair.1.x()), sum(|pair| pair.1.y()));
    let (mut along, mut across) = (0.0, 0.0);
    for (estimate, truth) in pairs {
        let (a, b) = (estimate.x() - ex, estimate.y() - ey);
        let (c, d) = (truth.x() - tx, truth.y() - ty);
        along += a * c + b * d;
        across += a * d - b * c;
    }
    let turn = SE2::new(0.0, 0.0, math::atan2(across, along));
    let (x, y) = turn.rotation().rotate(ex, ey);
    SE2::new(tx - x, ty - y, turn.theta())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::trajectory::StampedPose;

    fn arc(count: usize, frame: SE2) -> Trajectory {
        let poses = (0..count).map(|k| StampedPose {
            stamp_s: 0.1 * k as f64,
            pose: frame * SE2::exp(&(pr_geom::Vector3::new(0.2, 0.0, 0.05) * k as f64)),
        });
        Trajectory::new(poses.collect())
    }

    #[test]
    fn a_frame_that_is_moved_is_an_error_only_without_alignment() {
        let truth = arc(40, SE2::identity());
        let moved = arc(40, SE2::new(3.0, 4.0, 0.0));
        let as_is = truth_errors(&moved, &truth, Alignment::None).unwrap();
        assert!((as_is.ate.mean - 5.0).abs() < 1e-12 && as_is.ate.std < 1e-12);
        // A relative pose does not depend on the frame.
        assert!(as_is.rpe.trans.max < 1e-12);
        let turned = arc(40, SE2::new(3.0, 4.0, 2.0));
        let aligned = truth_errors(&turned, &truth, Alignment::Se2).unwrap();
        assert!(aligned.ate.max < 1e-12, "{:?}", aligned.ate);
    }

    #[test]
    fn stamps_that_lie_apart_are_rejected() {
        let truth = arc(10, SE2::identity());
        let late = Trajectory::new(
            truth
                .poses()
                .iter()
                .map(|pose| StampedPose {
                    stamp_s: pose.stamp_s + 100.0,
                    ..*pose
                })
                .collect(),
        );
        let problem = truth_errors(&late, &truth, Alignment::None).unwrap_err();
        assert_eq!(problem, TruthProblem::NoCommonStamps { matched: 0 });
    }
}
