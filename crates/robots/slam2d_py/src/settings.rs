//! The settings of the estimator from a dict, by the names in a session file and in `--set`.

use ch16_slam2d::local_map::LocalMapConfig;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use robot_io::settings::{SETTINGS, Setting};

use crate::errors::SettingError;

/// Settings with their values, as the core names them.
pub type Chosen = Vec<(&'static Setting, f64)>;

/// Reads a dict: `{"keyframe_distance_m": 1.0, "loops": {"max_window_m": 10.0}}`, or the same with `"loops.max_window_m": 10.0`.
pub fn chosen(config: Option<&Bound<'_, PyDict>>) -> PyResult<Chosen> {
    let mut chosen = Vec::new();
    if let Some(config) = config {
        collect(config, "", &mut chosen)?;
    }
    Ok(chosen)
}

fn collect(config: &Bound<'_, PyDict>, above: &str, chosen: &mut Chosen) -> PyResult<()> {
    for (name, value) in config.iter() {
        let name: String = name.extract()?;
        let name = format!("{above}{name}");
        if let Ok(inner) = value.cast::<PyDict>() {
            collect(inner, &format!("{name}."), chosen)?;
            continue;
        }
        let to_error =
            |error: robot_io::settings::SettingError| SettingError::new_err(error.to_string());
        let setting = Setting::named(&name).map_err(to_error)?;
        let value: f64 = value
            .extract()
            .map_err(|_| SettingError::new_err(format!("{name} has to be a number")))?;
        setting.check(value).map_err(to_error)?;
        chosen.push((setting, value));
    }
    Ok(())
}

/// The configuration with these values.
pub fn applied(mut robot: LocalMapConfig, chosen: &Chosen) -> PyResult<LocalMapConfig> {
    for (setting, value) in chosen {
        let set = setting.set(&robot, *value);
        robot = set.map_err(|error| SettingError::new_err(error.to_string()))?;
    }
    Ok(robot)
}

/// The settings of the estimator for recorded logs: name to (default, unit, what it does).
#[pyfunction]
pub fn settings(py: Python<'_>) -> PyResult<Bound<'_, PyDict>> {
    let robot = LocalMapConfig::default();
    let names = PyDict::new(py);
    for setting in SETTINGS {
        names.set_item(
            setting.name,
            (setting.value(&robot), setting.unit, setting.about),
        )?;
    }
    Ok(names)
}
