//! Arrays of numpy in and out.
//!
//! Inputs may be anything that `numpy.asarray` accepts: any numeric type, any order, contiguous or not. An array of
//! float64 is read without a copy. Results keep the memory that the core has filled.

use ch16_slam2d::cloud::PointCloud;
use nalgebra::{Matrix3, Point2, Vector2};
use numpy::ndarray::{ArrayView1, ArrayView2, Ix1, Ix2};
use numpy::{
    PyArray1, PyArray2, PyArray3, PyArrayMethods as _, PyReadonlyArrayDyn,
    PyUntypedArrayMethods as _,
};
use pr_geom::{Rotation, SE2, math};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict, PyString};

use crate::errors::ArrayError;

/// Largest error of a number of a homogeneous matrix: float32 rounds to 1e-7.
const MATRIX_TOLERANCE: f64 = 1e-6;

/// A Python value as an array of float64 of any shape.
fn numbers<'py>(name: &str, value: &Bound<'py, PyAny>) -> PyResult<PyReadonlyArrayDyn<'py, f64>> {
    if value.hasattr("mask")? && value.hasattr("filled")? {
        return Err(ArrayError::new_err(format!(
            "{name} has a mask, which would be lost: pass {name}.filled(numpy.nan) for ranges, and points without the masked rows"
        )));
    }
    let py = value.py();
    let rejected = || ArrayError::new_err(format!("{name} cannot be read as an array of numbers"));
    let numpy = py.import("numpy")?;
    let array = numpy.call_method1("asarray", (value,));
    let array = array.map_err(|_| rejected())?;
    let kind: String = array.getattr("dtype")?.getattr("kind")?.extract()?;
    // numpy would drop the imaginary parts with a warning, and read numbers from text.
    let held = match kind.as_str() {
        "c" => "complex numbers",
        "S" | "U" => "text",
        "O" if holds_text(&array)? => "text",
        "b" | "i" | "u" | "f" | "O" => "",
        _ => return Err(rejected()),
    };
    if !held.is_empty() {
        return Err(ArrayError::new_err(format!(
            "{name} holds {held}, but has to hold real numbers"
        )));
    }
    let options = PyDict::new(py);
    options.set_item("dtype", "float64")?;
    let array = numpy.call_method("asarray", (array,), Some(&options));
    array
        .map_err(|_| rejected())?
        .extract()
        .map_err(|_| rejected())
}

/// Whether an array of objects holds text.
fn holds_text(array: &Bound<'_, PyAny>) -> PyResult<bool> {
    for element in array.getattr("flat")?.try_iter()? {
        let element = element?;
        if element.is_instance_of::<PyString>() || element.is_instance_of::<PyBytes>() {
            return Ok(true);
        }
    }
    Ok(false)
}

fn wrong_shape(name: &str, wanted: &str, shape: &[usize]) -> PyErr {
    let sides: Vec<String> = shape.iter().map(ToString::to_string).collect();
    let shape = match &sides[..] {
        [one] => format!("({one},)"),
        _ => format!("({})", sides.join(", ")),
    };
    ArrayError::new_err(format!(
        "{name} has to have the shape {wanted}, not {shape}"
    ))
}

fn all_finite<'a>(name: &str, numbers: impl IntoIterator<Item = &'a f64>) -> PyResult<()> {
    if numbers.into_iter().all(|number| number.is_finite()) {
        return Ok(());
    }
    Err(ArrayError::new_err(format!(
        "{name} holds a value that is not a finite number"
    )))
}

/// Reads an array of shape (n,) whose numbers need not be finite.
pub fn vector(name: &str, value: &Bound<'_, PyAny>) -> PyResult<Vec<f64>> {
    let array = numbers(name, value)?;
    let view = array.as_array();
    let view: ArrayView1<'_, f64> = view
        .into_dimensionality::<Ix1>()
        .map_err(|_| wrong_shape(name, "(n,)", array.shape()))?;
    Ok(view.to_vec())
}

/// Reads finite rows of `columns` numbers each.
fn rows<T>(
    name: &str,
    value: &Bound<'_, PyAny>,
    columns: usize,
    read: impl Fn(ArrayView2<'_, f64>) -> T,
) -> PyResult<T> {
    let array = numbers(name, value)?;
    let view = array.as_array().into_dimensionality::<Ix2>();
    let view = view.ok().filter(|view| view.ncols() == columns);
    let wanted = format!("(n, {columns})");
    let view = view.ok_or_else(|| wrong_shape(name, &wanted, array.shape()))?;
    all_finite(name, view.iter())?;
    Ok(read(view))
}

/// Reads points, an array of shape (n, 2).
pub fn cloud(name: &str, value: &Bound<'_, PyAny>) -> PyResult<PointCloud> {
    rows(name, value, 2, |view| {
        let points = view.outer_iter();
        points
            .map(|point| Point2::new(point[0], point[1]))
            .collect()
    })
}

/// Reads poses, an array of shape (n, 3).
pub fn poses(name: &str, value: &Bound<'_, PyAny>) -> PyResult<Vec<SE2>> {
    rows(name, value, 3, |view| {
        let poses = view.outer_iter();
        poses
            .map(|pose| SE2::new(pose[0], pose[1], pose[2]))
            .collect()
    })
}

/// Reads relations, an array of shape (n, 5).
pub fn relations(name: &str, value: &Bound<'_, PyAny>) -> PyResult<Vec<[f64; 5]>> {
    rows(name, value, 5, |view| {
        let rows = view.outer_iter();
        rows.map(|row| core::array::from_fn(|column| row[column]))
            .collect()
    })
}

/// Reads a pose or a motion: an array of shape (3,), or a homogeneous matrix of shape (3, 3) or (4, 4).
pub fn pose(name: &str, value: &Bound<'_, PyAny>) -> PyResult<SE2> {
    let numbers = numbers(name, value)?;
    let view = numbers.as_array();
    all_finite(name, view.iter())?;
    let (size, shape) = match view.shape() {
        [3] => return Ok(SE2::new(view[[0]], view[[1]], view[[2]])),
        [3, 3] => (3, "3×3"),
        [4, 4] => (4, "4×4"),
        other => return Err(wrong_shape(name, "(3,), (3, 3) or (4, 4)", other)),
    };
    let at = |row: usize, column: usize| view[[row, column]];
    let last = size - 1;
    let pose = SE2::new(at(0, last), at(1, last), math::atan2(at(1, 0), at(0, 0)));
    let expected = homogeneous(&pose, size);
    let differs = |(k, number): (usize, &f64)| (number - expected[k]).abs() > MATRIX_TOLERANCE;
    if view.iter().enumerate().any(differs) {
        return Err(ArrayError::new_err(format!(
            "{name} is a {shape} matrix, but not a motion of the plane: a rotation by one angle, a position, and zeros and \
             ones elsewhere"
        )));
    }
    Ok(pose)
}

/// The homogeneous matrix of a pose, by rows.
fn homogeneous(pose: &SE2, size: usize) -> Vec<f64> {
    let Rotation { cos, sin } = pose.rotation();
    let last = size - 1;
    let mut matrix = vec![0.0; size * size];
    for k in 2..size {
        matrix[k * size + k] = 1.0;
    }
    matrix[..2].copy_from_slice(&[cos, -sin]);
    matrix[size..size + 2].copy_from_slice(&[sin, cos]);
    matrix[last] = pose.x();
    matrix[size + last] = pose.y();
    matrix
}

/// The pose of a result as a homogeneous matrix, shape (3, 3).
pub fn matrix_of<'py>(pose: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyArray2<f64>>> {
    sized_matrix_of(pose, 3)
}

/// The pose of a result as a homogeneous matrix of space, shape (4, 4).
pub fn matrix_3d_of<'py>(pose: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyArray2<f64>>> {
    sized_matrix_of(pose, 4)
}

fn sized_matrix_of<'py>(
    at: &Bound<'py, PyAny>,
    size: usize,
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let matrix = homogeneous(&pose("the pose", at)?, size);
    PyArray1::from_vec(at.py(), matrix).reshape([size, size])
}

/// A pose; the given default for Python's `None`.
pub fn pose_or(name: &str, value: Option<&Bound<'_, PyAny>>, other: SE2) -> PyResult<SE2> {
    value.map_or(Ok(other), |value| pose(name, value))
}

/// Reads a symmetric matrix, an array of shape (3, 3).
pub fn symmetric(name: &str, value: &Bound<'_, PyAny>) -> PyResult<Matrix3<f64>> {
    let numbers = numbers(name, value)?;
    let view = numbers.as_array();
    if view.shape() != [3, 3] {
        return Err(wrong_shape(name, "(3, 3)", view.shape()));
    }
    all_finite(name, view.iter())?;
    let matrix = Matrix3::from_fn(|row, column| view[[row, column]]);
    // Rounding of numpy's products.
    if (matrix - matrix.transpose()).abs().max() > 1e-9 * matrix.abs().max() {
        return Err(ArrayError::new_err(format!("{name} is not symmetric")));
    }
    Ok(matrix)
}

/// An array of shape (3,) with a pose: x and y in m, θ in rad.
pub fn of_pose<'py>(py: Python<'py>, pose: &SE2) -> Bound<'py, PyArray1<f64>> {
    PyArray1::from_vec(py, pose.to_array().to_vec())
}

/// An array of shape (n, 3) with poses.
pub fn of_poses<'py>(
    py: Python<'py>,
    poses: impl IntoIterator<Item = SE2>,
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let numbers: Vec<f64> = poses.into_iter().flat_map(|pose| pose.to_array()).collect();
    let count = numbers.len() / 3;
    PyArray1::from_vec(py, numbers).reshape([count, 3])
}

/// An array of shape (n, 2) with points.
pub fn of_points<'py>(
    py: Python<'py>,
    points: impl IntoIterator<Item = Point2<f64>>,
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let numbers: Vec<f64> = points.into_iter().flat_map(|p| [p.x, p.y]).collect();
    let count = numbers.len() / 2;
    PyArray1::from_vec(py, numbers).reshape([count, 2])
}

/// An array of shape (n, 2) with unit normals; a row of NaN where there is none.
pub fn of_normals<'py>(
    py: Python<'py>,
    normals: impl IntoIterator<Item = Option<Vector2<f64>>>,
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let none = Vector2::repeat(f64::NAN);
    let normals = normals.into_iter().map(|normal| normal.unwrap_or(none));
    of_points(py, normals.map(Point2::from))
}

/// An array of shape (3, 3) with a symmetric matrix.
pub fn of_matrix<'py>(
    py: Python<'py>,
    matrix: &Matrix3<f64>,
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    // Symmetric: column-major order equals row-major order.
    PyArray1::from_vec(py, matrix.as_slice().to_vec()).reshape([3, 3])
}

/// An array of shape (n, 3, 3) with symmetric matrices.
pub fn of_matrices<'py>(
    py: Python<'py>,
    matrices: &[Matrix3<f64>],
) -> PyResult<Bound<'py, PyArray3<f64>>> {
    let numbers = matrices.iter().flat_map(|matrix| matrix.iter().copied());
    PyArray1::from_vec(py, numbers.collect()).reshape([matrices.len(), 3, 3])
}

/// A serializable value as Python's dicts, lists and numbers.
pub fn of_serde<'py>(
    py: Python<'py>,
    value: &impl serde::Serialize,
) -> PyResult<Bound<'py, PyAny>> {
    let text = serde_json::to_string(value).expect("plain numbers, strings and lists");
    py.import("json")?.call_method1("loads", (text,))
}
