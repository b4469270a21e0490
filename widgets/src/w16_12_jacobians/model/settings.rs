//! Converts the values of the parameters to the types of the core.

use ch16_lab::jacobians::{Recipe, RingConfig};
use widget_kit::values::Values;

use crate::w16_12_jacobians::spec::{BIAS, SCATTER, SEED, WRONG};

/// The graph and its start.
pub fn ring(values: &Values) -> RingConfig {
    RingConfig {
        turn_bias_rad: values.get(&BIAS).to_radians(),
        scatter: values.get(&SCATTER),
        seed: values.get(&SEED),
    }
}

/// The four solvers, in the order of [`NAMES`](super::NAMES).
pub fn recipes(values: &Values) -> [Recipe; 4] {
    [
        Recipe::Exact,
        Recipe::Approximate,
        Recipe::WrongJacobian(values.get(&WRONG)),
        Recipe::WrongResidual,
    ]
}
