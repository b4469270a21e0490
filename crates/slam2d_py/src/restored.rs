//! Pickling and copying: a result is restored from its fields, what can be computed again from its arguments.

use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

use crate::errors::ChoiceError;
use crate::grid_map::GridMap;
use crate::localizer::Fix;
use crate::pose_graph::{OptimizeReport, PoseGraph};
use crate::registration::{IcpResult, NdtResult};
use crate::run_log::LogResult;
use crate::sensor::Sensor;
use crate::simulation::Drive;
use crate::slam::SlamStep;

/// What `__reduce__` returns: the function that restores, and its arguments.
pub type Reduced<'py> = (Bound<'py, PyAny>, Bound<'py, PyTuple>);

macro_rules! restorable {
    ($($class:ident { $($field:ident),+ })+) => {
        /// The attributes that restore a class.
        fn attributes(class: &str) -> &'static [&'static str] {
            match class {
                $(stringify!($class) => &[$(stringify!($field)),+],)+
                _ => &[],
            }
        }

        fn from_fields<'py>(
            py: Python<'py>,
            class: &str,
            fields: &Bound<'py, PyDict>,
        ) -> PyResult<Bound<'py, PyAny>> {
            let field = |name: &str| {
                fields.get_item(name)?.ok_or_else(|| {
                    ChoiceError::new_err(format!("the pickled {class} has no {name}"))
                })
            };
            match class {
                $(stringify!($class) => {
                    let made = $class { $($field: field(stringify!($field))?.extract()?),+ };
                    Ok(Bound::new(py, made)?.into_any())
                })+
                _ => Err(ChoiceError::new_err(format!("there is no class {class}"))),
            }
        }
    };
}

restorable! {
    IcpResult { pose, covariance, information, trace, trace_rmse, pairs, rmse, inliers, iterations, converged, stop }
    NdtResult { pose, trace, score, iterations, stop }
    OptimizeReport { chi2_initial, chi2, cost, iterations, start, converged, stop }
    SlamStep { pose, frame, keyframe, chi2, inliers, rmse, loops }
    LogResult { stamps, trajectory, keyframes, covariances, map, quality, graph, remarks }
    Fix { stamp, verdict, pose, covariance, score, margin }
}

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
        "GridMap" => call(py.get_type::<GridMap>().into_any()),
        "PoseGraph" => call(py.get_type::<PoseGraph>().getattr("from_g2o")?),
        "Drive" => call(
            py.get_type::<Drive>()
                .py()
                .import("rustslam2d")?
                .getattr("simulate")?,
        ),
        _ => from_fields(py, class, fields),
    }
}

/// Reduces a result to its attributes.
pub fn by_attributes<'py>(thing: &Bound<'py, PyAny>) -> PyResult<Reduced<'py>> {
    let class = thing.get_type().name()?.to_string();
    let fields = PyDict::new(thing.py());
    for name in attributes(&class) {
        fields.set_item(name, thing.getattr(*name)?)?;
    }
    by_keywords(&class, fields)
}

/// Reduces an object to keywords of the function that makes it.
pub fn by_keywords<'py>(class: &str, keywords: Bound<'py, PyDict>) -> PyResult<Reduced<'py>> {
    let py = keywords.py();
    let restored = py.import("rustslam2d._rustslam2d")?.getattr("_restored")?;
    Ok((restored, (class, keywords).into_pyobject(py)?))
}
