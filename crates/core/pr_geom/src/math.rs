//! The only entry to transcendental functions.
//!
//! `f64::sin` and related functions call the platform's C library natively and another one in
//! WebAssembly, and the two differ in the last bit. The `libm` crate is plain Rust, so these functions
//! return the same bits everywhere. `sqrt`, `floor`, `abs` are exact by IEEE 754 and are used directly.

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

/// Square root: exact in IEEE 754, so the processor's instruction gives the same bits everywhere.
///
/// `libm::sqrt` is that instruction natively; in WebAssembly it is a loop over integers.
#[inline]
#[must_use]
pub fn sqrt(value: f64) -> f64 {
    value.sqrt()
}

/// Length of `(x, y)` as `sqrt(x² + y²)`, without the rescaling of the C function `hypot`.
#[inline]
#[must_use]
pub fn norm2(x: f64, y: f64) -> f64 {
    sqrt(x * x + y * y)
}

/// The smaller of two numbers; `b` if one of them is NaN.
///
/// One instruction, and no branch. In WebAssembly `f64::min` is a call, because it handles NaN, and
/// engines compile a comparison with a selection to a branch.
#[inline]
#[must_use]
pub fn min(a: f64, b: f64) -> f64 {
    #[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
    {
        use core::arch::wasm32::{f64x2_extract_lane, f64x2_pmin, f64x2_splat};
        f64x2_extract_lane::<0>(f64x2_pmin(f64x2_splat(b), f64x2_splat(a)))
    }
    #[cfg(not(all(target_arch = "wasm32", target_feature = "simd128")))]
    if a < b { a } else { b }
}

/// The larger of two numbers; `b` if one of them is NaN. See [`min`].
#[inline]
#[must_use]
pub fn max(a: f64, b: f64) -> f64 {
    #[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
    {
        use core::arch::wasm32::{f64x2_extract_lane, f64x2_pmax, f64x2_splat};
        f64x2_extract_lane::<0>(f64x2_pmax(f64x2_splat(b), f64x2_splat(a)))
    }
    #[cfg(not(all(target_arch = "wasm32", target_feature = "simd128")))]
    if a > b { a } else { b }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_smaller_and_the_larger_are_those_of_the_standard_library() {
        for (a, b) in [(1.0, 2.0), (2.0, -1.0), (3.0, 3.0), (f64::INFINITY, 0.0)] {
            assert_eq!((min(a, b), max(a, b)), (a.min(b), a.max(b)));
        }
        assert_eq!((min(f64::NAN, 1.0), max(f64::NAN, 1.0)), (1.0, 1.0));
    }

    #[test]
    fn the_square_root_has_the_bits_of_libm() {
        for k in 0..2000 {
            let value = f64::from(k) * 0.37e-3;
            assert_eq!(sqrt(value), libm::sqrt(value));
        }
    }

    #[test]
    fn sin_cos_has_the_bits_of_sin_and_cos() {
        for k in -2000..=2000 {
            let angle = f64::from(k) * 0.0037;
            assert_eq!(sin_cos(angle), (sin(angle), cos(angle)));
        }
    }
}
