//! Converts the values of the parameters to the types of the core.

use ch16_lab::lap::LapConfig;
use widget_kit::run::LOOPS;
use widget_kit::run::NOISE;
use widget_kit::values::Values;

use crate::w16_4_control_room::spec::SEED;

/// The configuration of the run.
pub fn config(values: &Values) -> LapConfig {
    let config = LapConfig::with_seed_and_noise(values.get(&SEED), values.get(&NOISE));
    if values.get(&LOOPS) {
        config
    } else {
        config.without_loops()
    }
}
