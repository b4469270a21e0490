//! Rigid motions of the plane, with the same bits as the core.

use numpy::{PyArray1, PyArray2};
use pr_geom::Vector3;
use pyo3::prelude::*;

use crate::arrays;

/// The pose a ∘ b: first b, then a. With a = world_from_robot and b = robot_from_laser, world_from_laser.
///
/// a, b: shape (3,), (x, y, θ) in m, m, rad.
#[pyfunction]
pub fn compose<'py>(
    py: Python<'py>,
    a: &Bound<'_, PyAny>,
    b: &Bound<'_, PyAny>,
) -> PyResult<Bound<'py, PyArray1<f64>>> {
    let motion = arrays::pose("a", a)? * arrays::pose("b", b)?;
    Ok(arrays::of_pose(py, &motion))
}

/// The motion from a to b, a⁻¹ ∘ b: pose of b in the frame of a.
///
/// a, b: shape (3,), (x, y, θ) in m, m, rad. Of two poses of wheel odometry it is the motion that `Slam.step` takes.
#[pyfunction]
pub fn between<'py>(
    py: Python<'py>,
    a: &Bound<'_, PyAny>,
    b: &Bound<'_, PyAny>,
) -> PyResult<Bound<'py, PyArray1<f64>>> {
    let motion = arrays::pose("a", a)?.between(&arrays::pose("b", b)?);
    Ok(arrays::of_pose(py, &motion))
}

/// The inverse of a pose of shape (3,).
#[pyfunction]
pub fn inverse<'py>(
    py: Python<'py>,
    pose: &Bound<'_, PyAny>,
) -> PyResult<Bound<'py, PyArray1<f64>>> {
    Ok(arrays::of_pose(py, &arrays::pose("pose", pose)?.inverse()))
}

/// The points R p + t of shape (n, 2), in m, for a pose of shape (3,).
#[pyfunction]
pub fn transform<'py>(
    py: Python<'py>,
    pose: &Bound<'_, PyAny>,
    points: &Bound<'_, PyAny>,
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let pose = arrays::pose("pose", pose)?;
    let cloud = arrays::cloud("points", points)?;
    arrays::of_points(py, cloud.transformed(&pose).iter())
}

/// The pose reached by following a twist (v_x, v_y, ω) of shape (3,) for unit time (Solà et al. 2018, eq. 156).
#[pyfunction]
pub fn exp<'py>(py: Python<'py>, twist: &Bound<'_, PyAny>) -> PyResult<Bound<'py, PyArray1<f64>>> {
    let [x, y, omega] = three("twist", twist)?;
    let motion = pr_geom::SE2::exp(&Vector3::new(x, y, omega));
    Ok(arrays::of_pose(py, &motion))
}

/// The twist (v_x, v_y, ω) of shape (3,) whose `exp` is the pose; ω lies in (−π, π].
#[pyfunction]
pub fn log<'py>(py: Python<'py>, pose: &Bound<'_, PyAny>) -> PyResult<Bound<'py, PyArray1<f64>>> {
    let twist = arrays::pose("pose", pose)?.log();
    Ok(PyArray1::from_vec(py, twist.as_slice().to_vec()))
}

/// Three numbers; ω may turn more than once.
fn three(name: &str, value: &Bound<'_, PyAny>) -> PyResult<[f64; 3]> {
    arrays::pose(name, value)?;
    let numbers = arrays::vector(name, value)?;
    Ok(core::array::from_fn(|at| numbers[at]))
}
