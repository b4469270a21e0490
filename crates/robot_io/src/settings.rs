//! Parameters of the estimator by name, for varying each one and measuring its effect.
//!
//! Names are the fields of [`RobotConfig`], joined by dots. The values pass through serde with the
//! same names as in a session's file.

use ch16_slam2d::slam::RobotConfig;
use serde_json::{Number, Value};
use thiserror::Error;

/// A parameter of the estimator.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Setting {
    /// Its fields, joined by dots.
    pub name: &'static str,
    /// Unit; empty for counts and shares.
    pub unit: &'static str,
    /// Short description.
    pub about: &'static str,
}

/// Why a parameter was not set.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum SettingError {
    /// There is no parameter with that name.
    #[error("the estimator has no parameter {0}; docs/robots-parameters.md lists them")]
    Unknown(String),
    /// The value is out of range.
    #[error("{name} must be a finite non-negative number, not {value}")]
    Range {
        /// The parameter.
        name: &'static str,
        /// The rejected value.
        value: f64,
    },
}

/// Largest plausible value.
const MOST: f64 = 1e6;

const fn setting(name: &'static str, unit: &'static str, about: &'static str) -> Setting {
    Setting { name, unit, about }
}

/// All parameters, in the order of [`RobotConfig`].
pub const SETTINGS: &[Setting] = &[
    setting("scan_cell_m", "m", "cell size of the scan's grid filter"),
    setting(
        "scan_normal_radius_m",
        "m",
        "neighbourhood radius for normals within one scan",
    ),
    setting("window_sweeps", "", "number of scans in the local map"),
    setting(
        "window_distance_m",
        "m",
        "distance after which a scan is added to the local map",
    ),
    setting(
        "normal_radius_m",
        "m",
        "neighbourhood radius for normals in the local map",
    ),
    setting(
        "max_correspondence_m",
        "m",
        "largest correspondence distance in the first stage",
    ),
    setting(
        "inlier_distance_m",
        "m",
        "largest correspondence distance in the last stage, and of an inlier",
    ),
    setting(
        "point_sigma_m",
        "m",
        "standard deviation of a point along its normal",
    ),
    setting(
        "independent_points",
        "",
        "effective number of independent points of a scan",
    ),
    setting(
        "unseen_cost",
        "",
        "cost of a point in unobserved space, as a share of an outlier's cost",
    ),
    setting(
        "good_score",
        "",
        "score below which a window around the prediction is searched",
    ),
    setting("search_m", "m", "half width of the search window"),
    setting(
        "search_rad",
        "rad",
        "half range of headings of the search window",
    ),
    setting(
        "odometry.floor_m",
        "m",
        "constant part of odometry's translational standard deviation",
    ),
    setting(
        "odometry.per_metre",
        "",
        "translational standard deviation per metre",
    ),
    setting(
        "odometry.metre_per_rad",
        "m",
        "translational standard deviation per radian",
    ),
    setting(
        "odometry.floor_rad",
        "rad",
        "constant part of odometry's rotational standard deviation",
    ),
    setting(
        "odometry.per_rad",
        "",
        "rotational standard deviation per radian",
    ),
    setting(
        "odometry.rad_per_metre",
        "rad",
        "rotational standard deviation per metre",
    ),
    setting(
        "keyframe_distance_m",
        "m",
        "distance after which a keyframe is added",
    ),
    setting(
        "keyframe_turn_rad",
        "rad",
        "turn after which a keyframe is added",
    ),
    setting(
        "loops.bundle",
        "",
        "number of latest keyframes matched together",
    ),
    setting(
        "loops.min_path_m",
        "m",
        "least path length to a submap they are matched to",
    ),
    setting(
        "loops.window_sigmas",
        "",
        "half width of the search window in standard deviations",
    ),
    setting(
        "loops.max_window_m",
        "m",
        "largest half width of the search window",
    ),
    setting(
        "loops.max_turn_rad",
        "rad",
        "largest half range of headings of the search window",
    ),
    setting("loops.min_score", "", "least score of a loop"),
    setting(
        "loops.min_margin",
        "",
        "least score margin over the next best pose",
    ),
    setting(
        "loops.unconfirmed_gate_radius_m",
        "m",
        "largest half width of the search window for acceptance without confirmation",
    ),
    setting(
        "loops.pending_distance_m",
        "m",
        "path length on which a loop waits for confirmation",
    ),
];

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
    pub fn value(&self, config: &RobotConfig) -> f64 {
        let tree = tree(config);
        let value = tree.pointer(&self.pointer()).and_then(Value::as_f64);
        value.expect("every setting is a number of the configuration")
    }

    /// Checks whether a value is valid.
    ///
    /// # Errors
    /// If the value is negative, not finite or too large.
    pub fn check(&self, value: f64) -> Result<(), SettingError> {
        let name = self.name;
        if value.is_finite() && value >= 0.0 {
            Ok(())
        } else {
            Err(SettingError::Range { name, value })
        }
    }

    /// Sets the value in a copy of the configuration; a count is truncated, and at least 1.
    ///
    /// # Errors
    /// If the value is negative, not finite or too large.
    pub fn set(&self, config: &RobotConfig, value: f64) -> Result<RobotConfig, SettingError> {
        self.check(value)?;
        let mut tree = tree(config);
        let slot = tree
            .pointer_mut(&self.pointer())
            .expect("every setting is a field of the configuration");
        *slot = if slot.is_u64() {
            Value::from((value as u64).max(1))
        } else {
            Value::from(Number::from_f64(value).expect("it is finite"))
        };
        Ok(serde_json::from_value(tree).expect("only a number was exchanged"))
    }

    fn pointer(&self) -> String {
        format!("/{}", self.name.replace('.', "/"))
    }
}

/// Checks all numbers of a configuration that was read from a file.
///
/// # Errors
/// If a number is out of range; the message names the first.
pub(crate) fn checked(config: RobotConfig) -> Result<RobotConfig, String> {
    for setting in SETTINGS {
        let value = setting.value(&config);
        let is_plausible_length = setting.unit == "m" && !setting.name.contains('.');
        let is_positive = !is_plausible_length || value > 0.0;
        if setting.check(value).is_err() || value > MOST || !is_positive {
            return Err(format!("{} cannot be {value}", setting.name));
        }
    }
    Ok(config)
}

fn tree(config: &RobotConfig) -> Value {
    serde_json::to_value(config).expect("the numbers of a configuration are finite")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn leaves(value: &Value, path: &str, names: &mut Vec<String>) {
        match value {
            Value::Object(fields) => {
                for (name, value) in fields {
                    let path = if path.is_empty() {
                        name.clone()
                    } else {
                        format!("{path}.{name}")
                    };
                    leaves(value, &path, names);
                }
            }
            _ => names.push(path.to_owned()),
        }
    }

    #[test]
    fn every_number_of_the_estimator_has_a_setting_that_changes_it_alone() {
        let config = RobotConfig::default();
        let mut names = Vec::new();
        leaves(&tree(&config), "", &mut names);
        let mut known: Vec<&str> = SETTINGS.iter().map(|setting| setting.name).collect();
        names.sort_unstable();
        known.sort_unstable();
        assert_eq!(names, known);
        for setting in SETTINGS {
            let changed = setting.set(&config, setting.value(&config) + 1.0).unwrap();
            for other in SETTINGS {
                let by = other.value(&changed) - other.value(&config);
                let expected = f64::from(u8::from(other == setting));
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
    fn what_cannot_be_set_is_refused_in_a_sentence() {
        assert!(Setting::named("radius").is_err());
        let reach = Setting::named("max_correspondence_m").unwrap();
        assert!(reach.set(&RobotConfig::default(), f64::NAN).is_err());
        let error = reach.set(&RobotConfig::default(), -1.0).unwrap_err();
        assert_eq!(
            error.to_string(),
            "max_correspondence_m must be a finite non-negative number, not -1"
        );
    }
}
