//! Converts the values of the parameters to the types of the core.

use ch16_lab::lap::{LapSettings, LoopClosure};
use ch16_slam2d::chi_squared::gate_threshold;
use widget_kit::run::LOOPS;
use widget_kit::run::NOISE;
use widget_kit::values::Values;

use crate::w16_2_full_lap::spec::{GATE, GATE_MODEL, INFORMATION, MATCHER, SEED, WORLD};

/// Reads the values.
pub fn read(values: &Values) -> LapSettings {
    LapSettings {
        world: values.get(&WORLD),
        seed: values.get(&SEED),
        noise_factor: values.get(&NOISE),
        loop_closure: if values.get(&LOOPS) {
            LoopClosure::On
        } else {
            LoopClosure::Off
        },
        gate_chi2: gate_threshold(values.get(&GATE)),
        gate_model: values.get(&GATE_MODEL),
        matcher: values.get(&MATCHER),
        information_frame: values.get(&INFORMATION),
    }
}
