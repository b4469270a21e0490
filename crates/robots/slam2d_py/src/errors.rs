//! The errors of the core as Python exceptions, each with the core's sentence.

use std::io;
use std::path::Path;

use pyo3::create_exception;
use pyo3::exceptions::{PyIndexError, PyOSError, PyValueError};
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::{PyDict, PyType};

create_exception!(
    rustslam2d,
    SlamError,
    PyValueError,
    "What every error of this package is, a ValueError; the message is one sentence."
);
create_exception!(
    rustslam2d,
    ArrayError,
    SlamError,
    "An array has the wrong shape, or holds a value that is not a finite number."
);
create_exception!(
    rustslam2d,
    ChoiceError,
    SlamError,
    "An argument is out of its range, or none of the choices has its name."
);
create_exception!(
    rustslam2d,
    SettingError,
    SlamError,
    "The estimator has no setting of that name, or it cannot take that value."
);
create_exception!(
    rustslam2d,
    FrameError,
    SlamError,
    "A scan cannot be used; the estimator stays as it was."
);
create_exception!(
    rustslam2d,
    GraphError,
    SlamError,
    "A pose graph has a wrong edge or is malformed as text."
);
create_exception!(
    rustslam2d,
    OptimizeError,
    SlamError,
    "The normal equations cannot be solved; the poses stay as they were."
);
create_exception!(
    rustslam2d,
    LogError,
    SlamError,
    "A file is not a readable log, or no scan of it could be used."
);
create_exception!(
    rustslam2d,
    EvaluationError,
    SlamError,
    "A trajectory and its reference have no times in common."
);

/// `ChoiceError` for a name that is none of `names`.
pub fn no_choice(argument: &str, name: &str, names: &[&str]) -> PyErr {
    let names = names.join(", ");
    ChoiceError::new_err(format!("{argument} has to be one of {names}, not {name:?}"))
}

/// A number in its range, or `ChoiceError`.
pub fn within(argument: &str, value: f64, low: f64, high: f64, unit: &str) -> PyResult<f64> {
    if (low..=high).contains(&value) {
        return Ok(value);
    }
    Err(ChoiceError::new_err(format!(
        "{argument} has to be within {low} to {high}{unit}, not {value}"
    )))
}

/// The largest count that an argument may be.
const MOST: f64 = 1e9;

/// A whole number that is not negative, or `ChoiceError`.
pub fn count(argument: &str, value: f64) -> PyResult<usize> {
    whole(argument, value, MOST).map(|value| value as usize)
}

/// A whole number from 0 to `most`, or `ChoiceError`. It comes as a float, because an integer of Python that has no place in
/// one of Rust raises `OverflowError`, which is no `SlamError`.
pub fn whole(argument: &str, value: f64, most: f64) -> PyResult<f64> {
    if value.fract() == 0.0 && (0.0..=most).contains(&value) {
        return Ok(value);
    }
    Err(ChoiceError::new_err(format!(
        "{argument} has to be a whole number from 0 to {most}, not {value}"
    )))
}

static NUMBER_ERROR: PyOnceLock<Py<PyType>> = PyOnceLock::new();

/// `NumberError`, which is a `SlamError` and an `IndexError`; `create_exception` takes one base.
pub fn number_error(py: Python<'_>) -> PyResult<&Bound<'_, PyType>> {
    let made = NUMBER_ERROR.get_or_try_init(py, || {
        let bases = (py.get_type::<SlamError>(), py.get_type::<PyIndexError>());
        let members = PyDict::new(py);
        members.set_item("__module__", "rustslam2d")?;
        let says = "There is no node or keyframe of that number; also an IndexError.";
        members.set_item("__doc__", says)?;
        let made = py
            .get_type::<PyType>()
            .call1(("NumberError", bases, members))?;
        Ok::<_, PyErr>(made.cast_into::<PyType>()?.unbind())
    })?;
    Ok(made.bind(py))
}

/// The index of a node or a keyframe, `what`, among `count` of them, which `whose` has; or `NumberError`.
pub fn index(what: &str, number: f64, whose: &str, count: usize) -> PyResult<usize> {
    if number.fract() == 0.0 && number >= 0.0 && number < count as f64 {
        return Ok(number as usize);
    }
    let problem = format!("there is no {what} {number}: {whose} has {count}");
    Err(Python::attach(|py| match number_error(py) {
        Ok(kind) => PyErr::from_type(kind.clone(), problem),
        Err(error) => error,
    }))
}

/// The `OSError` for a file error of the system.
pub fn os_error(path: &Path, error: &io::Error) -> PyErr {
    let name = path.display().to_string();
    match error.raw_os_error() {
        // Python derives FileNotFoundError and others from the number.
        Some(number) => {
            let message = error.to_string();
            let message = message.split(" (os error").next().unwrap_or_default();
            PyOSError::new_err((number, message.to_owned(), name))
        }
        None => PyOSError::new_err(format!("{name}: {error}")),
    }
}
