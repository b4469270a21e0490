//! What the values of the parameter list mean to the core.

use ch16_lab::lap::LapConfig;
use kit::values::Values;

/// What the run depends on.
pub fn config(values: &Values) -> LapConfig {
    let config = LapConfig::with_seed_and_noise(values.get("seed") as u32, values.get("noise"));
    if values.get("loops") == 0.0 {
        config.without_loops()
    } else {
        config
    }
}
