//! Errors of a trajectory against the truth or against relations.

use pr_geom::SE2;
use pyo3::prelude::*;
use robot_io::evaluate::{Alignment, relation_errors, truth_errors};
use robot_io::relations::Relation;
use robot_io::trajectory::{StampedPose, Trajectory};

use crate::arrays;
use crate::errors::{ArrayError, ChoiceError, EvaluationError, no_choice};

/// Compares a trajectory with the truth, or with relations between two times.
///
/// stamps: times of the poses, s, shape (n,), ascending.
/// poses: world_from_body, shape (n, 3): x and y in m, θ in rad.
/// truth: (stamps, poses) of the true trajectory; stamps that lie within 0.01 s of each other belong together.
/// align: "none", or "se2" to move the trajectory onto the truth by the best rigid motion first.
/// relations: shape (m, 5), rows of t1, t2, x, y, θ: the pose at t2 in the frame of that at t1 (Kümmerle et al. 2009).
///
/// Returns a dict. Against the truth, as evo computes them: n; ate, with rmse, mean, median, std, min, max of the
/// position errors, m; rpe, with trans (m) and rot_deg of the motion from one pose to the next. Against relations: n;
/// trans (m), rot_deg, trans2, rot2, each with mean, std, median, p95.
///
/// Raises EvaluationError if the two have no times in common.
#[pyfunction]
#[pyo3(signature = (stamps, poses, *, truth=None, align="none", relations=None))]
pub fn evaluate<'py>(
    py: Python<'py>,
    stamps: &Bound<'_, PyAny>,
    poses: &Bound<'_, PyAny>,
    truth: Option<(Bound<'_, PyAny>, Bound<'_, PyAny>)>,
    align: &str,
    relations: Option<&Bound<'_, PyAny>>,
) -> PyResult<Bound<'py, PyAny>> {
    let estimate = trajectory(["stamps", "poses"], stamps, poses)?;
    let alignment = match align {
        "none" => Alignment::None,
        "se2" => Alignment::Se2,
        _ => return Err(no_choice("align", align, &["none", "se2"])),
    };
    match (truth, relations) {
        (Some((stamps, poses)), None) => {
            let truth = trajectory(["the truth's stamps", "the truth's poses"], &stamps, &poses)?;
            let report = py.detach(|| truth_errors(&estimate, &truth, alignment));
            let report = report.map_err(|error| EvaluationError::new_err(error.to_string()))?;
            arrays::of_serde(py, &report)
        }
        (None, Some(relations)) => {
            let rows = arrays::relations("relations", relations)?;
            let relations: Vec<Relation> = rows
                .into_iter()
                .map(|[first_s, second_s, x, y, theta]| Relation {
                    first_s,
                    second_s,
                    motion: SE2::new(x, y, theta),
                })
                .collect();
            let report = py
                .detach(|| relation_errors(&estimate, &relations))
                .report();
            if report.n == 0 {
                return Err(EvaluationError::new_err(format!(
                    "none of the {} relations is within the times of the trajectory; use the same clock for both",
                    relations.len()
                )));
            }
            arrays::of_serde(py, &report)
        }
        _ => Err(ChoiceError::new_err(
            "give either truth=(stamps, poses) or relations",
        )),
    }
}

/// Reads stamped poses.
pub fn trajectory(
    [stamps_name, poses_name]: [&str; 2],
    stamps: &Bound<'_, PyAny>,
    poses: &Bound<'_, PyAny>,
) -> PyResult<Trajectory> {
    let stamps = arrays::vector(stamps_name, stamps)?;
    let poses = arrays::poses(poses_name, poses)?;
    if stamps.len() != poses.len() {
        return Err(ArrayError::new_err(format!(
            "{stamps_name} has {} entries, and {poses_name} has {}: give one for each",
            stamps.len(),
            poses.len()
        )));
    }
    // False for NaN.
    let is_ascending = stamps.windows(2).all(|two| two[1] > two[0]);
    if !is_ascending || stamps.iter().any(|stamp| !stamp.is_finite()) {
        return Err(ArrayError::new_err(format!("{stamps_name} has to ascend")));
    }
    let stamped = stamps.into_iter().zip(poses);
    Ok(Trajectory::new(
        stamped
            .map(|(stamp_s, pose)| StampedPose { stamp_s, pose })
            .collect(),
    ))
}
