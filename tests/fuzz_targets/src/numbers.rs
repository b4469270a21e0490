//! Numbers from outside: moderate, arbitrary, and at the limits of an `f64`.

use arbitrary::{Result, Unstructured};

/// Special values that often reveal faults.
const EDGES: [f64; 20] = [
    0.0,
    -0.0,
    1.0,
    -1.0,
    core::f64::consts::PI,
    -core::f64::consts::PI,
    1e-300,
    -1e-300,
    f64::MIN_POSITIVE,
    5e-324,
    1e-9,
    1e9,
    1e100,
    1e154,
    -1e154,
    1e300,
    -1e300,
    1e308,
    f64::MAX,
    f64::MIN,
];

/// A small number on a grid of sixteenths, so that inputs coincide, like points in a cell.
pub fn tame(bytes: &mut Unstructured<'_>) -> Result<f64> {
    Ok(f64::from(bytes.arbitrary::<i8>()?) / 16.0)
}

/// Any finite number, mostly a moderate one.
pub fn finite(bytes: &mut Unstructured<'_>) -> Result<f64> {
    match bytes.arbitrary::<u8>()? {
        0..=199 => tame(bytes),
        200..=239 => bytes.choose(&EDGES).copied(),
        _ => {
            let any: f64 = bytes.arbitrary()?;
            Ok(if any.is_finite() { any } else { 0.0 })
        }
    }
}

/// Any number, mostly a moderate one.
pub fn any(bytes: &mut Unstructured<'_>) -> Result<f64> {
    match bytes.arbitrary::<u8>()? {
        0..=239 => finite(bytes),
        240..=247 => bytes
            .choose(&[f64::NAN, f64::INFINITY, f64::NEG_INFINITY])
            .copied(),
        _ => bytes.arbitrary(),
    }
}

/// A power of ten between 1e-12 and 1e12.
pub fn scale(bytes: &mut Unstructured<'_>) -> Result<f64> {
    const POWERS: [f64; 9] = [1.0, 1e-12, 1e-6, 1e-3, 10.0, 1e2, 1e3, 1e6, 1e12];
    bytes.choose(&POWERS).copied()
}
