//! Parameters of the estimator by name, for `--set`, for Python and for the checks of a session's file.

use ch16_slam2d::local_map::LocalMapConfig;
use thiserror::Error;

/// A parameter of the estimator.
#[derive(Clone, Copy, Debug)]
pub struct Setting {
    /// Its fields of [`LocalMapConfig`], joined by dots.
    pub name: &'static str,
    /// Unit; empty for shares.
    pub unit: &'static str,
    /// Short description.
    pub about: &'static str,
    field: fn(&mut LocalMapConfig) -> &mut f64,
}

/// Why a parameter was not set.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum SettingError {
    /// There is no parameter with that name.
    #[error("the estimator has no parameter {0}; it has {names}", names = names())]
    Unknown(String),
    /// The value is out of range.
    #[error("{name} must be {least} and at most {MOST}, not {value}", least = least(*is_length))]
    Range {
        /// The parameter.
        name: &'static str,
        /// The rejected value.
        value: f64,
        /// Whether it is a length, which has to be positive.
        is_length: bool,
    },
}

fn least(is_length: bool) -> &'static str {
    if is_length { "positive" } else { "0 or more" }
}

/// Largest plausible value.
const MOST: f64 = 1e6;

/// All parameters, in the order of [`LocalMapConfig`].
pub const SETTINGS: &[Setting] = &[
    Setting {
        name: "scan_cell_m",
        unit: "m",
        about: "cell size of the scan's grid filter",
        field: |config| &mut config.scan_cell_m,
    },
    Setting {
        name: "point_sigma_m",
        unit: "m",
        about: "standard deviation of a point along its normal",
        field: |config| &mut config.point_sigma_m,
    },
    Setting {
        name: "odometry.per_metre",
        unit: "",
        about: "odometry's translational standard deviation per metre",
        field: |config| &mut config.odometry.per_metre,
    },
    Setting {
        name: "odometry.per_rad",
        unit: "",
        about: "odometry's rotational standard deviation per radian",
        field: |config| &mut config.odometry.per_rad,
    },
    Setting {
        name: "keyframe_distance_m",
        unit: "m",
        about: "distance after which a keyframe is added",
        field: |config| &mut config.keyframe_distance_m,
    },
    Setting {
        name: "keyframe_turn_rad",
        unit: "rad",
        about: "turn after which a keyframe is added",
        field: |config| &mut config.keyframe_turn_rad,
    },
    Setting {
        name: "loops.min_path_m",
        unit: "m",
        about: "least path length of a loop",
        field: |config| &mut config.loops.min_path_m,
    },
    Setting {
        name: "loops.max_window_m",
        unit: "m",
        about: "radius of the search for loops",
        field: |config| &mut config.loops.max_window_m,
    },
];

fn names() -> String {
    let names: Vec<&str> = SETTINGS.iter().map(|setting| setting.name).collect();
    names.join(", ")
}

impl Setting {
    /// Finds a parameter by name.
    ///
    /// # Errors
    /// If there is none with that name.
    pub fn named(name: &str) -> Result<&'static Self, SettingError> {
        let found = SETTINGS.iter().find(|setting| setting.name == name);
        found.ok_or_else(|| SettingError::Unknown(name.to_owned()))
    }

    /// Value in a configuration.
    #[must_use]
    pub fn value(&self, config: &LocalMapConfig) -> f64 {
        let mut copy = *config;
        *(self.field)(&mut copy)
    }

    /// Checks whether a value is valid.
    ///
    /// # Errors
    /// If the value is negative, a length of zero, or beyond any plausible one.
    pub fn check(&self, value: f64) -> Result<(), SettingError> {
        in_range(self.name, self.unit, value)
    }

    /// Sets a checked value.
    pub(crate) fn apply(&self, config: &mut LocalMapConfig, value: f64) {
        *(self.field)(config) = value;
    }

    /// Sets the value in a copy of the configuration.
    ///
    /// # Errors
    /// Those of [`Setting::check`].
    pub fn set(&self, config: &LocalMapConfig, value: f64) -> Result<LocalMapConfig, SettingError> {
        self.check(value)?;
        let mut copy = *config;
        self.apply(&mut copy, value);
        Ok(copy)
    }
}

/// Checks all numbers of a configuration that was read from a file.
///
/// # Errors
/// If a number is out of range; the message names the first.
pub(crate) fn checked(config: LocalMapConfig) -> Result<LocalMapConfig, SettingError> {
    let radius = ("scan_normal_radius_m", "m", config.scan_normal_radius_m);
    let settings = SETTINGS
        .iter()
        .map(|setting| (setting.name, setting.unit, setting.value(&config)));
    for (name, unit, value) in settings.chain([radius]) {
        in_range(name, unit, value)?;
    }
    Ok(config)
}

fn in_range(name: &'static str, unit: &str, value: f64) -> Result<(), SettingError> {
    let is_length = unit == "m" && !name.contains('.');
    let is_in_range = (0.0..=MOST).contains(&value) && !(is_length && value == 0.0);
    is_in_range.then_some(()).ok_or(SettingError::Range {
        name,
        value,
        is_length,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn leaves(value: &serde_json::Value, path: &str, names: &mut Vec<String>) {
        let Some(fields) = value.as_object() else {
            return names.push(path.to_owned());
        };
        for (name, value) in fields {
            let dot = if path.is_empty() { "" } else { "." };
            leaves(value, &format!("{path}{dot}{name}"), names);
        }
    }

    #[test]
    fn every_number_that_does_not_follow_from_the_scanner_has_a_setting_that_changes_it_alone() {
        let config = LocalMapConfig::default();
        let mut names = Vec::new();
        leaves(&serde_json::to_value(config).unwrap(), "", &mut names);
        names.retain(|name| name != "scan_normal_radius_m");
        let mut known: Vec<&str> = SETTINGS.iter().map(|setting| setting.name).collect();
        names.sort_unstable();
        known.sort_unstable();
        assert_eq!(names, known);
        for setting in SETTINGS {
            let changed = setting.set(&config, setting.value(&config) + 1.0).unwrap();
            for other in SETTINGS {
                let by = other.value(&changed) - other.value(&config);
                let expected = f64::from(u8::from(other.name == setting.name));
                // 1e-12: one rounding of numbers below 100.
                assert!(
                    (by - expected).abs() < 1e-12,
                    "{} {}",
                    setting.name,
                    other.name
                );
            }
        }
    }

    #[test]
    fn what_cannot_be_set_is_rejected_in_a_sentence() {
        let error = Setting::named("radius").unwrap_err().to_string();
        assert!(
            error.starts_with("the estimator has no parameter radius; it has scan_cell_m, "),
            "{error}"
        );
        let distance = Setting::named("keyframe_distance_m").unwrap();
        assert!(distance.set(&LocalMapConfig::default(), f64::NAN).is_err());
        // A session with such a value could not be opened.
        assert!(distance.set(&LocalMapConfig::default(), 0.0).is_err());
        assert!(distance.set(&LocalMapConfig::default(), 1e7).is_err());
        let error = distance.set(&LocalMapConfig::default(), -1.0).unwrap_err();
        assert_eq!(
            error.to_string(),
            "keyframe_distance_m must be positive and at most 1000000, not -1"
        );
    }
}
