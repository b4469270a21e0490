//! What the values of the parameter list mean to the core.

use ch16_lab::lap::LapConfig;
use kit::run::LOOPS;
use kit::run::NOISE;
use kit::values::Values;

use crate::w16_4_control_room::spec::SEED;

/// What the run depends on.
pub fn config(values: &Values) -> LapConfig {
    let config = LapConfig::with_seed_and_noise(values.get(&SEED), values.get(&NOISE));
    if values.get(&LOOPS) {
        config
    } else {
        config.without_loops()
    }
}
