//! Unpickling and copying: calls what makes an object of a class.

use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::errors::ChoiceError;
use crate::grid_map::GridMap;
use crate::localizer::Fix;
use crate::pose_graph::{OptimizeReport, PoseGraph};
use crate::reduced::Restorable as _;
use crate::registration::{IcpResult, NdtResult};
use crate::run_log::{LogResult, Pipeline};
use crate::sensor::Sensor;
use crate::simulation::Drive;
use crate::slam::Slam;
use crate::slam_step::SlamStep;

/// Restores a pickled object.
#[pyfunction]
pub fn _restored<'py>(
    py: Python<'py>,
    class: &str,
    fields: &Bound<'py, PyDict>,
) -> PyResult<Bound<'py, PyAny>> {
    let call = |made: Bound<'py, PyAny>| made.call((), Some(fields));
    match class {
        "Sensor" => call(py.get_type::<Sensor>().into_any()),
        "Pipeline" => call(py.get_type::<Pipeline>().into_any()),
        "Slam" => call(py.get_type::<Slam>().getattr("_from_bytes")?),
        "GridMap" => call(py.get_type::<GridMap>().into_any()),
        "PoseGraph" => call(py.get_type::<PoseGraph>().getattr("from_g2o")?),
        "Drive" => call(
            py.get_type::<Drive>()
                .py()
                .import("rustslam2d")?
                .getattr("simulate")?,
        ),
        "IcpResult" => IcpResult::restore(py, fields),
        "NdtResult" => NdtResult::restore(py, fields),
        "OptimizeReport" => OptimizeReport::restore(py, fields),
        "SlamStep" => SlamStep::restore(py, fields),
        "LogResult" => LogResult::restore(py, fields),
        "Fix" => Fix::restore(py, fields),
        _ => Err(ChoiceError::new_err(format!("there is no class {class}"))),
    }
}
