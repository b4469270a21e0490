//! A correspondence distance that adapts to the errors of the predictions.

use pr_geom::{SE2, math};

/// Deviations needed before the threshold adapts.
const MIN_SAMPLES: usize = 3;

/// The adaptive threshold of KISS-ICP: τ is three times the root mean square deviation of the
/// registered pose from the predicted one.
///
/// A deviation `(Δt, Δθ)` counts as `δ = ‖Δt‖ + 2 r_max sin(|Δθ|/2)`, the largest displacement of a point
/// of the scan. Deviations below `min_motion_m` are ignored. τ keeps its initial value until there are three.
///
/// Source: Vizzo et al. 2023, "KISS-ICP", section III-B.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AdaptiveThreshold {
    initial_m: f64,
    min_motion_m: f64,
    max_range_m: f64,
    sum_of_squares_m2: f64,
    samples: usize,
}

impl AdaptiveThreshold {
    /// A threshold that starts at `initial_m` for a sensor with a range of `max_range_m`.
    #[must_use]
    pub fn new(initial_m: f64, min_motion_m: f64, max_range_m: f64) -> Self {
        Self {
            initial_m,
            min_motion_m,
            max_range_m,
            sum_of_squares_m2: 0.0,
            samples: 0,
        }
    }

    /// The current τ, m.
    #[must_use]
    pub fn tau_m(&self) -> f64 {
        if self.samples < MIN_SAMPLES {
            return self.initial_m;
        }
        3.0 * math::sqrt(self.sum_of_squares_m2 / self.samples as f64)
    }

    /// Sum of the squared deviations so far (m²), and their number.
    #[must_use]
    pub fn seen(&self) -> (f64, usize) {
        (self.sum_of_squares_m2, self.samples)
    }

    /// The threshold after these deviations; see [`seen`](Self::seen).
    #[must_use]
    pub fn having_seen(self, sum_of_squares_m2: f64, samples: usize) -> Self {
        Self {
            sum_of_squares_m2,
            samples,
            ..self
        }
    }

    /// Adds one registration: the predicted and the registered pose, in the same frame.
    pub fn update(&mut self, predicted: &SE2, registered: &SE2) {
        let deviation = predicted.between(registered);
        let delta_m = math::norm2(deviation.x(), deviation.y())
            + 2.0 * self.max_range_m * math::sin(0.5 * deviation.theta().abs());
        if delta_m < self.min_motion_m {
            return;
        }
        self.sum_of_squares_m2 += delta_m * delta_m;
        self.samples += 1;
    }
}
