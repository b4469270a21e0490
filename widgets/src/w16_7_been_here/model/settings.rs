//! What the values of the parameter list mean to the core.

use ch16_lab::lap::{Choice, LapConfig, LapDetector, LapMatcher};
use kit::run::NOISE;
use kit::values::Values;

use crate::w16_7_been_here::spec::{DETECTOR, SEED, WORLD};

/// The lap that is driven: by NDT and without loops, as `slam2d places` drives it.
pub fn config(values: &Values) -> LapConfig {
    LapConfig::in_world(values.get(&WORLD), values.get(&SEED), values.get(&NOISE))
        .with_matcher(LapMatcher::Ndt)
        .without_loops()
}

/// Number of the detector that is chosen, in the order of [`LapDetector::ALL`].
pub fn detector(values: &Values) -> usize {
    values.get(&DETECTOR)
}

/// What a detector's distance is called, with its unit.
pub fn distance_label(detector: usize) -> &'static str {
    match LapDetector::ALL[detector] {
        LapDetector::Nearby => "distance in deviations of the drift",
        LapDetector::Histogram => "χ² distance of the histograms",
        LapDetector::Context => "distance of the contexts",
    }
}
