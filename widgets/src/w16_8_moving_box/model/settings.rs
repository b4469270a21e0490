//! Converts the values of the parameters to the types of the core.

use ch16_lab::moving_box::{BoxConfig, BoxMethods};
use widget_kit::values::Values;

use crate::w16_8_moving_box::spec::{DROPPED, HUBER, MOVED, MOVED_Y, SEED, SHARE, TAU, VARIANT};

/// The sweeps above the curves.
pub fn config(values: &Values) -> BoxConfig {
    BoxConfig {
        seed: values.get(&SEED),
        share: values.get(&SHARE) / 100.0,
        moved_m: [&MOVED, &MOVED_Y].map(|moved| values.get(moved)),
    }
}

/// The treatment of outliers.
pub fn methods(values: &Values) -> BoxMethods {
    BoxMethods {
        variant: values.get(&VARIANT),
        tau_m: values.get(&TAU),
        dropped: values.get(&DROPPED) / 100.0,
        huber_width_m: values.get(&HUBER),
    }
}
