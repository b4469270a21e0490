//! What the estimator reports of one scan.

use ch16_slam2d::slam::{LoopAttempt, SlamReport};
use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays;
use crate::reduced::{self, Reduced};

/// Result of one scan.
#[pyclass(frozen, module = "rustslam2d")]
pub struct SlamStep {
    /// Estimated pose world_from_body after the scan, shape (3,): x and y in m, θ in rad.
    #[pyo3(get)]
    pub pose: Py<PyArray1<f64>>,
    /// Number of the scan, counted from 0.
    #[pyo3(get)]
    pub frame: usize,
    /// Number of the keyframe that it became, or None.
    #[pyo3(get)]
    pub keyframe: Option<usize>,
    /// χ² of the pose graph.
    #[pyo3(get)]
    pub chi2: f64,
    /// Pairs of the registration; None for the first scan.
    #[pyo3(get)]
    pub inliers: Option<usize>,
    /// Root mean square residual of the pairs, m; None for the first scan.
    #[pyo3(get)]
    pub rmse: Option<f64>,
    /// Loops that were tried: dicts with from, to, chi2, gate_chi2, rmse, inliers, accepted, reason.
    #[pyo3(get)]
    pub loops: Vec<Py<PyDict>>,
}

reduced::restorable! {
    SlamStep { pose, frame, keyframe, chi2, inliers, rmse, loops }
}

#[pymethods]
impl SlamStep {
    /// The pose as a homogeneous matrix, shape (3, 3).
    #[getter]
    fn matrix<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        arrays::matrix_of(self.pose.bind(py).as_any())
    }

    /// The pose as a homogeneous matrix of space, shape (4, 4).
    #[getter]
    fn matrix_3d<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        arrays::matrix_3d_of(self.pose.bind(py).as_any())
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Reduced<'py>> {
        reduced::by_attributes(slf)
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        Ok(format!(
            "SlamStep(frame={}, pose={}, keyframe={}, {} loops tried)",
            self.frame,
            self.pose.bind(py).repr()?,
            self.keyframe.map_or("None".to_owned(), |k| k.to_string()),
            self.loops.len()
        ))
    }
}

impl SlamStep {
    /// The result of a scan as the estimator reports it.
    pub fn from_report(py: Python<'_>, report: SlamReport) -> PyResult<Self> {
        let matched = report.registration.map(|found| found.matched);
        let loops = report.loop_attempts.iter();
        Ok(Self {
            pose: arrays::of_pose(py, &report.estimate).unbind(),
            frame: report.frame,
            keyframe: report.new_keyframe,
            chi2: report.chi2,
            inliers: matched.as_ref().map(|matched| matched.inliers),
            rmse: matched.as_ref().map(|matched| matched.rmse_m),
            loops: loops
                .map(|attempt| tried(py, attempt))
                .collect::<PyResult<_>>()?,
        })
    }
}

/// A loop that was tried, as a dict.
pub fn tried(py: Python<'_>, attempt: &LoopAttempt) -> PyResult<Py<PyDict>> {
    let found = &attempt.verification;
    let dict = PyDict::new(py);
    dict.set_item("from", found.from_node)?;
    dict.set_item("to", found.candidate.node)?;
    dict.set_item("chi2", found.gate.chi2)?;
    dict.set_item("gate_chi2", found.gate.gate_chi2)?;
    dict.set_item("rmse", found.rmse_m)?;
    dict.set_item("inliers", found.inliers)?;
    dict.set_item("accepted", attempt.accepted())?;
    dict.set_item("reason", found.reason())?;
    Ok(dict.unbind())
}
