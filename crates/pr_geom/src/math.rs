//! The one door to transcendental functions.
//!
//! `f64::sin` and its kin call the platform's C library natively and another one in WebAssembly,
//! and the two differ in the last bit. The `libm` crate is plain Rust, so what goes through here
//! gives the same bits everywhere. `sqrt`, `floor`, `abs` are exact by IEEE 754 and need no door.

/// Sine of an angle in radians.
#[inline]
#[must_use]
pub fn sin(angle_rad: f64) -> f64 {
    libm::sin(angle_rad)
}

/// Cosine of an angle in radians.
#[inline]
#[must_use]
pub fn cos(angle_rad: f64) -> f64 {
    libm::cos(angle_rad)
}

/// Sine and cosine of an angle in radians, in this order, the same bits as [`sin`] and [`cos`].
#[inline]
#[must_use]
pub fn sin_cos(angle_rad: f64) -> (f64, f64) {
    libm::sincos(angle_rad)
}

/// Angle of the vector `(x, y)` in radians, in [−π, π].
#[inline]
#[must_use]
pub fn atan2(y: f64, x: f64) -> f64 {
    libm::atan2(y, x)
}

/// Natural exponential.
#[inline]
#[must_use]
pub fn exp(exponent: f64) -> f64 {
    libm::exp(exponent)
}

/// Natural logarithm.
#[inline]
#[must_use]
pub fn ln(value: f64) -> f64 {
    libm::log(value)
}

/// Error function `2/√π ∫₀ˣ e^(−t²) dt`.
#[inline]
#[must_use]
pub fn erf(value: f64) -> f64 {
    libm::erf(value)
}

/// Square root: exact in IEEE 754, kept here so that `no_std` crates find it beside the rest.
#[inline]
#[must_use]
pub fn sqrt(value: f64) -> f64 {
    libm::sqrt(value)
}

/// Length of `(x, y)` as `sqrt(x² + y²)`, without the rescaling of the C function `hypot`.
#[inline]
#[must_use]
pub fn norm2(x: f64, y: f64) -> f64 {
    libm::sqrt(x * x + y * y)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sin_cos_has_the_bits_of_sin_and_cos() {
        for k in -2000..=2000 {
            let angle = f64::from(k) * 0.0037;
            assert_eq!(sin_cos(angle), (sin(angle), cos(angle)));
        }
    }
}
