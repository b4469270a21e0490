//! What the values of the parameter list mean to the core.

use ch16_lab::jacobians::{Recipe, RingConfig, WrongJacobian};
use kit::values::Values;

/// The graph and its start.
pub fn ring(values: &Values) -> RingConfig {
    RingConfig {
        turn_bias_rad: values.get("bias").to_radians(),
        scatter: values.get("scatter"),
        seed: values.get("seed") as u32,
    }
}

/// The four solvers, in the order of [`NAMES`](super::NAMES).
pub fn recipes(values: &Values) -> [Recipe; 4] {
    let wrong = if values.get("wrong") == 0.0 {
        WrongJacobian::TwiceTooLong
    } else {
        WrongJacobian::LeftForRight
    };
    [
        Recipe::Exact,
        Recipe::Approximate,
        Recipe::WrongJacobian(wrong),
        Recipe::WrongResidual,
    ]
}
