//! Options of a log and of a robot that drives, as Python gives them.

use std::str::FromStr;

use pyo3::prelude::*;
use pyo3::types::PyBool;
use robot_io::log::LogOptions;
use robot_io::motion::OdometryUse;

use crate::errors::{ChoiceError, no_choice, within};

/// What is asked for, beside topics and frames.
pub struct Asked {
    /// Mounting of the laser.
    pub laser: Option<String>,
    /// Heights of the points of a 3-D sensor, the lower one first, m.
    pub heights: Option<(f64, f64)>,
    /// Shorter ranges are no points, m.
    pub min_range: Option<f64>,
    /// Back, right, front and left end of the robot, m.
    pub footprint: Option<(f64, f64, f64, f64)>,
    /// Columns of a table.
    pub columns: Option<String>,
}

/// The options, without topics and frames; or `ChoiceError`.
pub fn options(asked: &Asked) -> PyResult<LogOptions> {
    if let Some((low, high)) = asked.heights
        && !(low < high && low.is_finite() && high.is_finite())
    {
        return Err(ChoiceError::new_err(format!(
            "heights has to be two numbers, the lower one first, not ({low}, {high})"
        )));
    }
    let footprint = asked.footprint;
    let footprint =
        footprint.map(|(back, right, front, left)| format!("{back},{right},{front},{left}"));
    Ok(LogOptions {
        laser: parsed("laser", asked.laser.as_deref())?,
        heights_m: asked.heights,
        min_range_m: asked
            .min_range
            .map(|range_m| within("min_range", range_m, 0.0, 1e6, " m"))
            .transpose()?,
        footprint: parsed("footprint", footprint.as_deref())?,
        columns: parsed("columns", asked.columns.as_deref())?,
        ..LogOptions::default()
    })
}

/// How the odometry is taken: by its name, or a truth value.
pub fn odometry_use(wanted: Option<&Bound<'_, PyAny>>) -> PyResult<OdometryUse> {
    let Some(wanted) = wanted else {
        return Ok(OdometryUse::Check);
    };
    if let Ok(is_used) = wanted.cast::<PyBool>() {
        return Ok(if is_used.is_true() {
            OdometryUse::Check
        } else {
            OdometryUse::Ignore
        });
    }
    let name: String = wanted.str()?.extract()?;
    let found = OdometryUse::ALL.into_iter().find(|one| one.name() == name);
    found.ok_or_else(|| no_choice("odometry", &name, &OdometryUse::ALL.map(OdometryUse::name)))
}

/// An option as the command reads it.
fn parsed<T: FromStr<Err = String>>(name: &str, text: Option<&str>) -> PyResult<Option<T>> {
    let read = |text: &str| {
        let found = text.parse();
        found.map_err(|problem| ChoiceError::new_err(format!("{name}: {problem}, not {text:?}")))
    };
    text.map(read).transpose()
}
