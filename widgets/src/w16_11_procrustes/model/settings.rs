//! Converts the values of the parameters to the types of the core.

use ch16_lab::procrustes::{Handedness, Pairs, Shape};
use widget_kit::values::Values;

use crate::w16_11_procrustes::spec::{MOVED, SEED, SHAPE, TRIED};

/// The selected shape.
pub fn shape(values: &Values) -> Shape {
    values.get(&SHAPE)
}

/// The pairs as observed.
pub fn seen(values: &Values) -> Pairs {
    Pairs::seen(shape(values), values.get(&SEED))
}

/// The pairs with the points of the target as moved by the reader.
pub fn pairs(values: &Values) -> Pairs {
    let mut pairs = seen(values);
    for (point, [x, y]) in pairs.target.iter_mut().zip(&MOVED) {
        point.x += values.get(x);
        point.y += values.get(y);
    }
    pairs
}

/// The selected kind of matrices.
pub fn tried(values: &Values) -> Handedness {
    values.get(&TRIED)
}
