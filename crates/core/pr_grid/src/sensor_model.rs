//! The inverse sensor model of one range reading: Thrun, Burgard, Fox 2005, Table 9.2.

use pr_geom::math;

/// The log odds of a probability, `ln(p / (1 − p))`.
#[must_use]
pub fn probability_to_log_odds(probability: f64) -> f64 {
    math::ln(probability / (1.0 - probability))
}

/// The inverse sensor model: occupied in a band of thickness α around the return, free before it,
/// unchanged behind it and outside of the beam's width β.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InverseSensorModel {
    /// Thickness α of an obstacle in metres.
    pub obstacle_thickness_m: f64,
    /// Opening angle β of a beam in radians.
    pub beam_width_rad: f64,
    /// Longest range in metres; a reading at it is not a return.
    pub max_range_m: f64,
    /// Log odds added to a cell in the band.
    pub occupied_log_odds: f64,
    /// Log odds added to a cell before the band.
    pub free_log_odds: f64,
}

impl Default for InverseSensorModel {
    /// α 0.22 m, β 5°, 6 m, probabilities 0.75 and 0.35.
    fn default() -> Self {
        Self {
            obstacle_thickness_m: 0.22,
            beam_width_rad: 5_f64.to_radians(),
            max_range_m: 6.0,
            occupied_log_odds: probability_to_log_odds(0.75),
            free_log_odds: probability_to_log_odds(0.35),
        }
    }
}

impl InverseSensorModel {
    /// Log odds that a reading of `range_m` adds to a cell `distance_m` away on the beam's axis.
    #[inline]
    #[must_use]
    pub fn log_odds(&self, distance_m: f64, range_m: f64) -> f64 {
        let half = self.obstacle_thickness_m / 2.0;
        if distance_m > math::min(range_m + half, self.max_range_m) {
            0.0
        } else if range_m < self.max_range_m && (distance_m - range_m).abs() < half {
            self.occupied_log_odds
        } else if distance_m <= range_m {
            self.free_log_odds
        } else {
            0.0
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn free_then_occupied_then_unknown_along_a_beam() {
        let model = InverseSensorModel::default();
        assert_eq!(model.log_odds(1.0, 2.0), model.free_log_odds);
        assert_eq!(model.log_odds(1.95, 2.0), model.occupied_log_odds);
        assert_eq!(model.log_odds(2.05, 2.0), model.occupied_log_odds);
        assert_eq!(model.log_odds(2.2, 2.0), 0.0);
    }

    #[test]
    fn a_reading_at_the_longest_range_marks_nothing_occupied() {
        let model = InverseSensorModel::default();
        assert_eq!(model.log_odds(5.95, 6.0), model.free_log_odds);
        assert_eq!(model.log_odds(6.01, 6.0), 0.0);
    }

    #[test]
    fn log_odds_of_three_quarters_is_the_log_of_three() {
        assert!((probability_to_log_odds(0.75) - 3_f64.ln()).abs() < 1e-15);
    }
}
