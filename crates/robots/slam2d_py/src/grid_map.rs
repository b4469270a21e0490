//! Occupancy grids.

use std::fs;
use std::path::PathBuf;

use numpy::{PyArray1, PyArray2, PyArrayMethods as _, PyReadonlyArray2};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use robot_io::map_image::{MapImage, MapMode};

use crate::errors::{ArrayError, ChoiceError, os_error, within};
use crate::pictures;
use crate::reduced::{self, Reduced};

/// An occupancy grid.
///
/// log_odds: shape (rows, columns); 0 is unknown, above is occupied. The first row is the one with the highest y.
/// origin: the lower left corner, world frame, m.
/// cell: side of a cell, m.
#[pyclass(frozen, module = "rustslam2d")]
pub struct GridMap {
    height: usize,
    width: usize,
    log_odds: Vec<f64>,
    origin_m: [f64; 2],
    cell_m: f64,
}

impl GridMap {
    /// The grid of the core.
    pub fn new(image: &MapImage) -> Self {
        Self {
            height: image.height,
            width: image.width,
            log_odds: image.log_odds(),
            origin_m: image.origin_m,
            cell_m: image.cell_m,
        }
    }
}

#[pymethods]
impl GridMap {
    #[new]
    #[pyo3(signature = (log_odds, *, origin=(0.0, 0.0), cell), text_signature = "(log_odds, *, origin=(0.0, 0.0), cell)")]
    fn from_parts(
        log_odds: PyReadonlyArray2<'_, f64>,
        origin: (f64, f64),
        cell: f64,
    ) -> PyResult<Self> {
        let odds = log_odds.as_array();
        if odds.iter().any(|odds| odds.is_nan()) {
            return Err(ArrayError::new_err("log_odds holds NaN; 0 is unknown"));
        }
        if !origin.0.is_finite() || !origin.1.is_finite() {
            return Err(ArrayError::new_err(
                "origin holds a value that is not a finite number",
            ));
        }
        Ok(Self {
            height: odds.nrows(),
            width: odds.ncols(),
            log_odds: odds.iter().copied().collect(),
            origin_m: [origin.0, origin.1],
            cell_m: within("cell", cell, 1e-3, 100.0, " m")?,
        })
    }

    /// Log odds of occupancy, shape (rows, columns); 0 is unknown. The first row is the one with the highest y.
    #[getter]
    fn log_odds<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let log_odds = PyArray1::from_slice(py, &self.log_odds);
        log_odds.reshape([self.height, self.width])
    }

    /// The lower left corner, world frame, m.
    #[getter]
    fn origin(&self) -> (f64, f64) {
        (self.origin_m[0], self.origin_m[1])
    }

    /// Side of a cell, m.
    #[getter]
    fn cell(&self) -> f64 {
        self.cell_m
    }

    /// Saves the map for a map server of ROS: `path`, which ends in .yaml, and the image beside it, in PGM.
    ///
    /// Raises ChoiceError for another ending, OSError if a file cannot be written.
    fn save(&self, py: Python<'_>, path: PathBuf) -> PyResult<()> {
        if path
            .extension()
            .is_none_or(|end| end != "yaml" && end != "yml")
        {
            return Err(ChoiceError::new_err(format!(
                "path has to end in .yaml, not {:?}; the image is written beside it",
                path.display().to_string()
            )));
        }
        py.detach(|| {
            let picture = path.with_extension("pgm");
            let mut pgm = format!("P5\n{} {}\n255\n", self.width, self.height).into_bytes();
            pgm.extend(MapImage::pixels(&self.log_odds));
            fs::write(&picture, pgm).map_err(|error| os_error(&picture, &error))?;
            let name = picture.file_name().unwrap_or_default().to_string_lossy();
            let yaml = MapImage::yaml_of(&name, MapMode::Trinary, self.cell_m, self.origin_m);
            fs::write(&path, yaml).map_err(|error| os_error(&path, &error))
        })
    }

    /// Draws the map with matplotlib, occupied dark and unknown grey; returns the axes.
    ///
    /// ax: the axes to draw into; without it new ones.
    #[pyo3(signature = (*, ax=None))]
    fn plot(slf: Bound<'_, Self>, ax: Option<Bound<'_, PyAny>>) -> PyResult<Py<PyAny>> {
        pictures::draw("grid", slf.into_any(), ax)
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Reduced<'py>> {
        let keywords = PyDict::new(slf.py());
        keywords.set_item("log_odds", slf.get().log_odds(slf.py())?)?;
        keywords.set_item("origin", slf.get().origin())?;
        keywords.set_item("cell", slf.get().cell())?;
        reduced::by_keywords("GridMap", keywords)
    }

    pub fn __repr__(&self) -> String {
        let Self {
            height,
            width,
            cell_m,
            ..
        } = self;
        format!("GridMap({height} × {width} cells of {cell_m} m)")
    }
}
