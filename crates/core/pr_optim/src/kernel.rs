//! Robust kernels: bound the influence of an outlier on the graph.
//!
//! A kernel replaces the squared Mahalanobis norm `s = eᵀΩe` of a factor by a cost `ρ(s)` that grows more slowly.
//! The solver scales Ω by the weight `w(s) = ρ'(s)` (iteratively reweighted least squares), so a kernel needs only
//! these two functions. Neither changes χ², which reports give unweighted.

use pr_geom::math;

/// The cost of a factor as a function of its squared Mahalanobis norm.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub enum RobustKernel {
    /// Plain least squares: `ρ(s) = s`.
    #[default]
    None,
    /// Quadratic up to a Mahalanobis norm of `width`, linear beyond.
    ///
    /// With `m = √s`: `ρ = m²` for `m ≤ width`, else `2·width·m − width²`; `w = width/m`.
    /// Huber, "Robust estimation of a location parameter", 1964.
    Huber {
        /// Mahalanobis norm at which the cost turns linear, above 0.
        width: f64,
    },
    /// Dynamic covariance scaling: smoothly reduces the weight of a factor with a large residual to zero.
    ///
    /// With `c = min(1, 2φ/(φ + s))`: `w = c²`. The cost with that derivative is `ρ = s` for
    /// `s ≤ φ` and `4φ²(1/(2φ) − 1/(φ + s)) + φ` beyond. It is bounded by `3φ`.
    /// Agarwal, Tipaldi, Spinello, Stachniss, Burgard, "Robust map optimization using dynamic
    /// covariance scaling", 2013.
    Dcs {
        /// Squared Mahalanobis norm at which scaling begins, above 0.
        phi: f64,
    },
}

impl RobustKernel {
    /// The factor by which Ω is scaled at this squared Mahalanobis norm.
    #[inline]
    #[must_use]
    pub fn weight(&self, squared_norm: f64) -> f64 {
        match *self {
            Self::None => 1.0,
            Self::Huber { width } => {
                if squared_norm > width * width {
                    width / math::sqrt(squared_norm)
                } else {
                    1.0
                }
            }
            Self::Dcs { phi } => {
                if squared_norm > phi {
                    let scale = 2.0 * phi / (phi + squared_norm);
                    scale * scale
                } else {
                    1.0
                }
            }
        }
    }

    /// The cost `ρ(s)` at this squared Mahalanobis norm.
    #[inline]
    #[must_use]
    pub fn cost(&self, squared_norm: f64) -> f64 {
        match *self {
            Self::None => squared_norm,
            Self::Huber { width } => {
                if squared_norm > width * width {
                    2.0 * width * math::sqrt(squared_norm) - width * width
                } else {
                    squared_norm
                }
            }
            Self::Dcs { phi } => {
                if squared_norm > phi {
                    3.0 * phi - 4.0 * phi * phi / (phi + squared_norm)
                } else {
                    squared_norm
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const KERNELS: [RobustKernel; 3] = [
        RobustKernel::None,
        RobustKernel::Huber { width: 1.5 },
        RobustKernel::Dcs { phi: 2.0 },
    ];

    #[test]
    fn weight_is_the_derivative_of_the_cost() {
        for kernel in KERNELS {
            for squared_norm in [0.1, 1.9, 2.3, 5.0, 80.0] {
                let h = 1e-5;
                let slope =
                    (kernel.cost(squared_norm + h) - kernel.cost(squared_norm - h)) / (2.0 * h);
                // 1e-8: the central difference is off by h² times the third derivative.
                assert!(
                    (slope - kernel.weight(squared_norm)).abs() < 1e-8,
                    "{kernel:?} at {squared_norm}"
                );
            }
        }
    }

    #[test]
    fn huber_scales_by_width_over_norm() {
        // Norm 6 against width 1.5: a quarter.
        assert_eq!(RobustKernel::Huber { width: 1.5 }.weight(36.0), 0.25);
        assert_eq!(RobustKernel::Huber { width: 1.5 }.weight(2.25), 1.0);
    }

    #[test]
    fn dcs_cost_stays_below_three_phi() {
        let kernel = RobustKernel::Dcs { phi: 2.0 };
        assert!(kernel.cost(1e12) < 6.0);
        assert!(kernel.cost(1e12) > 5.999);
    }
}
