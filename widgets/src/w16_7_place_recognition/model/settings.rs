//! Converts the values of the parameters to the types of the core.

use ch16_lab::lap::{LapConfig, LapDetector, LapMatcher};
use ch16_lab::places::GRADED;
use widget_kit::run::NOISE;
use widget_kit::values::Values;

use crate::w16_7_place_recognition::spec::{DETECTOR, SEED, WORLD};

/// The lap: with NDT and without loops, like `ch16 places`.
pub fn config(values: &Values) -> LapConfig {
    LapConfig::in_world(values.get(&WORLD), values.get(&SEED), values.get(&NOISE))
        .with_matcher(LapMatcher::Ndt)
        .without_loops()
}

/// Index of the selected detector, in the order of [`GRADED`].
pub fn detector(values: &Values) -> usize {
    values.get(&DETECTOR)
}

/// Name of a detector's distance, with its unit.
pub fn distance_label(detector: usize) -> &'static str {
    match GRADED[detector] {
        LapDetector::Histogram => "χ² distance of the histograms",
        LapDetector::Context => "distance of the contexts",
        _ => "distance in standard deviations of the drift",
    }
}
