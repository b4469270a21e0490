//! The χ² distribution with three degrees of freedom: converts the quantile of a loop gate to the threshold of the
//! squared innovation.
//!
//! A relative pose has three components, so for a true loop whose innovation has the covariance that the gate
//! assumes, `eᵀΩe` follows χ²₃: `F(x) = erf(√(x/2)) − √(2x/π) e^(−x/2)`, with the density
//! `f(x) = √(x/2π) e^(−x/2)` (Abramowitz & Stegun 1964, 26.4.4 for ν = 3).

use core::f64::consts::PI;

use pr_geom::math;

/// The quantile of the chapter's gate. It rejects one true loop in twenty if the robot does not move, more after a drive.
pub const CHAPTER_QUANTILE: f64 = 0.95;

/// The chapter's gate: the threshold of [`CHAPTER_QUANTILE`], as tables print it.
pub const CHAPTER_GATE: f64 = 7.815;

/// Threshold of the quantile 0.99, as tables print it: one true loop in a hundred is beyond it.
pub const GATE_99: f64 = pr_optim::robust::LOOP_CHI2;

/// Threshold of the quantile 0.999, as tables print it.
pub const GATE_999: f64 = 16.266;

/// Quantiles for which [`gate_threshold`] is defined: below 1, and with a threshold above 0.
const QUANTILES: core::ops::RangeInclusive<f64> = 1e-6..=0.999_999;

/// Probability that a χ²₃ variable is at most `x`; 0 for x ≤ 0.
#[must_use]
pub fn cdf3(x: f64) -> f64 {
    if x <= 0.0 {
        return 0.0;
    }
    math::erf(math::sqrt(0.5 * x)) - math::sqrt(2.0 * x / PI) * math::exp(-0.5 * x)
}

/// The `x` with `cdf3(x) = quantile`, to 1e-12; the quantile is clamped to 1e-6…0.999999.
///
/// Newton steps inside a shrinking bracket, with the density in closed form.
#[must_use]
pub fn quantile3(quantile: f64) -> f64 {
    let quantile = quantile.clamp(*QUANTILES.start(), *QUANTILES.end());
    let (mut below, mut above) = (0.0, 64.0);
    let mut x = 3.0;
    for _ in 0..100 {
        let excess = cdf3(x) - quantile;
        if excess < 0.0 {
            below = x;
        } else {
            above = x;
        }
        let density = math::sqrt(x / (2.0 * PI)) * math::exp(-0.5 * x);
        let newton = x - excess / density;
        let next = if newton > below && newton < above {
            newton
        } else {
            0.5 * (below + above)
        };
        if (next - x).abs() < 1e-13 * x {
            return next;
        }
        x = next;
    }
    x
}

/// The gate of a quantile, rounded to the three digits of printed tables.
///
/// The chapter gates with the printed 7.815, not with 7.8147…; rounding gives every quantile the
/// threshold that a reader finds in a table.
#[must_use]
pub fn gate_threshold(quantile: f64) -> f64 {
    (quantile3(quantile) * 1000.0).round() / 1000.0
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Critical values for ν = 3, NIST/SEMATECH e-Handbook of Statistical Methods, 1.3.6.7.4.
    const TABLE: [(f64, f64); 6] = [
        (0.900, 6.251),
        (0.950, 7.815),
        (0.975, 9.348),
        (0.990, 11.345),
        (0.999, 16.266),
        (0.050, 0.352),
    ];

    #[test]
    fn thresholds_are_those_of_the_printed_tables() {
        for (quantile, threshold) in TABLE {
            assert_eq!(gate_threshold(quantile), threshold, "quantile {quantile}");
        }
    }

    #[test]
    fn named_gates_are_those_of_their_quantiles() {
        assert_eq!(gate_threshold(0.99), GATE_99);
        assert_eq!(gate_threshold(0.999), GATE_999);
    }

    #[test]
    fn the_chapter_gates_at_exactly_7_815() {
        assert_eq!(
            gate_threshold(CHAPTER_QUANTILE).to_bits(),
            CHAPTER_GATE.to_bits()
        );
        // Unrounded it is not the printed figure.
        assert!((quantile3(CHAPTER_QUANTILE) - 7.814_727_903_251_18).abs() < 1e-11);
    }

    #[test]
    fn quantile_and_cdf_undo_each_other() {
        for k in 1..1000 {
            let quantile = f64::from(k) / 1000.0;
            let back = cdf3(quantile3(quantile));
            // 1e-13: a few last bits of erf, whose values are near 1.
            assert!(
                (back - quantile).abs() < 1e-13,
                "{quantile} came back as {back}"
            );
        }
    }

    #[test]
    fn the_density_is_the_slope_of_the_cdf() {
        // Central differences at h = 1e-4 are off by h²/6 times the third derivative, below 1e-8.
        for x in [0.5, 1.0, 3.0, 7.815, 16.0] {
            let slope = (cdf3(x + 1e-4) - cdf3(x - 1e-4)) / 2e-4;
            let density = math::sqrt(x / (2.0 * PI)) * math::exp(-0.5 * x);
            assert!((slope - density).abs() < 1e-8);
        }
    }

    #[test]
    fn quantiles_beyond_the_range_stay_finite() {
        for quantile in [-1.0, 0.0, 1.0, 2.0] {
            assert!(quantile3(quantile).is_finite());
        }
    }
}
