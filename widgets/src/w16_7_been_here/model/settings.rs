//! What the values of the parameter list mean to the core.

use ch16_lab::lap::{BuiltInWorld, Choice, LapConfig, LapDetector, LapMatcher};
use kit::values::Values;

/// The lap that is driven: by NDT and without loops, as `slam2d places` drives it.
pub fn config(values: &Values) -> LapConfig {
    let world = BuiltInWorld::ALL[values.get("world") as usize];
    LapConfig::in_world(world, values.get("seed") as u32, values.get("noise"))
        .with_matcher(LapMatcher::Ndt)
        .without_loops()
}

/// Number of the detector that is chosen, in the order of [`LapDetector::ALL`].
pub fn detector(values: &Values) -> usize {
    values.get("detector") as usize
}

/// What a detector's distance is called, with its unit.
pub fn distance_label(detector: usize) -> &'static str {
    match LapDetector::ALL[detector] {
        LapDetector::Nearby => "distance in deviations of the drift",
        LapDetector::Histogram => "χ² distance of the histograms",
        LapDetector::Context => "distance of the contexts",
    }
}
