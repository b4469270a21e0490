//! The numbers of the estimator by name, so that each can be varied and its effect measured.
//!
//! Names are the fields of [`RobotConfig`], joined by points. The values go through serde, which has the
//! same names in a session's file.

use ch16_slam2d::slam::RobotConfig;
use serde_json::{Number, Value};
use thiserror::Error;

/// A number of the estimator.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Setting {
    /// Its fields, joined by points.
    pub name: &'static str,
    /// Its unit; empty for counts and shares.
    pub unit: &'static str,
    /// What it does, in a few words.
    pub about: &'static str,
}

/// Why a number was not set.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum SettingError {
    /// No setting has that name.
    #[error("the estimator has no parameter {0}; docs/robots-parameters.md lists them")]
    Unknown(String),
    /// It is not a number that the setting can take.
    #[error("{name} has to be a finite number that is not negative, not {value}")]
    Range {
        /// The setting.
        name: &'static str,
        /// What it should have become.
        value: f64,
    },
}

/// Larger numbers are no settings.
const MOST: f64 = 1e6;

const fn setting(name: &'static str, unit: &'static str, about: &'static str) -> Setting {
    Setting { name, unit, about }
}

/// All of them, in the order of [`RobotConfig`].
pub const SETTINGS: &[Setting] = &[
    setting("scan_cell_m", "m", "side of the cells that thin a scan"),
    setting(
        "scan_normal_radius_m",
        "m",
        "radius for normals within one scan",
    ),
    setting("window_sweeps", "", "last scans in the local map"),
    setting(
        "window_distance_m",
        "m",
        "distance after which a scan joins it",
    ),
    setting(
        "normal_radius_m",
        "m",
        "radius for normals in the local map",
    ),
    setting(
        "max_correspondence_m",
        "m",
        "largest distance of a pair in the first stage",
    ),
    setting(
        "inlier_distance_m",
        "m",
        "the same in the last stage, and of a point that fits",
    ),
    setting(
        "point_sigma_m",
        "m",
        "standard deviation of a point across its wall",
    ),
    setting(
        "independent_points",
        "",
        "independent points that a scan counts as",
    ),
    setting(
        "unseen_cost",
        "",
        "cost of a point in unseen space, as a share of a miss",
    ),
    setting(
        "good_score",
        "",
        "score below which the window around the prediction is searched",
    ),
    setting("search_m", "m", "half width of that window"),
    setting("search_rad", "rad", "half its range of headings"),
    setting(
        "odometry.floor_m",
        "m",
        "deviation of any motion by odometry",
    ),
    setting("odometry.per_metre", "", "the same for each metre"),
    setting("odometry.metre_per_rad", "m", "the same for each radian"),
    setting(
        "odometry.floor_rad",
        "rad",
        "deviation of the heading of any motion",
    ),
    setting("odometry.per_rad", "", "the same for each radian"),
    setting("odometry.rad_per_metre", "rad", "the same for each metre"),
    setting(
        "keyframe_distance_m",
        "m",
        "distance after which a keyframe is taken",
    ),
    setting("keyframe_turn_rad", "rad", "or turn"),
    setting(
        "loops.bundle",
        "",
        "newest keyframes that are looked for together",
    ),
    setting(
        "loops.min_path_m",
        "m",
        "path length to the submaps they are looked for on",
    ),
    setting(
        "loops.window_sigmas",
        "",
        "standard deviations that the window is wide",
    ),
    setting(
        "loops.max_window_m",
        "m",
        "half width of the window at most",
    ),
    setting(
        "loops.max_turn_rad",
        "rad",
        "half its range of headings at most",
    ),
    setting("loops.min_score", "", "score that a loop needs"),
    setting(
        "loops.min_margin",
        "",
        "lead that it needs over the best other place",
    ),
    setting(
        "loops.unconfirmed_gate_radius_m",
        "m",
        "half width of a window within which it needs no other loop",
    ),
    setting(
        "loops.pending_distance_m",
        "m",
        "path length on which it waits for another one",
    ),
];

impl Setting {
    /// The setting of that name.
    ///
    /// # Errors
    /// Where there is none.
    pub fn named(name: &str) -> Result<&'static Self, SettingError> {
        let found = SETTINGS.iter().find(|setting| setting.name == name);
        found.ok_or_else(|| SettingError::Unknown(name.to_owned()))
    }

    /// Its value.
    #[must_use]
    pub fn value(&self, config: &RobotConfig) -> f64 {
        let tree = tree(config);
        let value = tree.pointer(&self.pointer()).and_then(Value::as_f64);
        value.expect("every setting is a number of the configuration")
    }

    /// Whether it can take a value.
    ///
    /// # Errors
    /// Where that is negative or not finite.
    pub fn check(&self, value: f64) -> Result<(), SettingError> {
        let name = self.name;
        if value.is_finite() && value >= 0.0 {
            Ok(())
        } else {
            Err(SettingError::Range { name, value })
        }
    }

    /// The configuration with another value; a count takes the whole part, at least 1.
    ///
    /// # Errors
    /// Where the value is negative or not finite.
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

/// A configuration that was read from a file, if all its numbers can be used.
///
/// # Errors
/// The first number that is out of its range, in a sentence.
pub(crate) fn checked(config: RobotConfig) -> Result<RobotConfig, String> {
    for setting in SETTINGS {
        let value = setting.value(&config);
        let is_length = setting.unit == "m" && !setting.name.contains('.');
        let is_positive = !is_length || value > 0.0;
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
        let said = reach.set(&RobotConfig::default(), -1.0).unwrap_err();
        assert_eq!(
            said.to_string(),
            "max_correspondence_m has to be a finite number that is not negative, not -1"
        );
    }
}
