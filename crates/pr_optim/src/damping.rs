//! How much a Levenberg–Marquardt step is damped: Nielsen's schedule.
//!
//! Source: Nielsen, "Damping parameter in Marquardt's method", 1999.

/// Largest damping that is tried before the solve gives up.
pub(crate) const DAMPING_LIMIT: f64 = 1e12;

/// The damping λ of the next step, and the factor by which a refused step raises it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Damping {
    value: f64,
    growth: f64,
}

impl Default for Damping {
    fn default() -> Self {
        Self::new(0.0)
    }
}

impl Damping {
    /// A schedule that begins at `value`.
    pub fn new(value: f64) -> Self {
        Self { value, growth: 2.0 }
    }

    /// λ, relative to the diagonal of H.
    pub fn value(&self) -> f64 {
        self.value
    }

    /// Whether a step that changed the cost by `−decrease` is accepted; sets the damping of the next.
    ///
    /// With the gain ratio `ϱ = decrease / predicted`, an accepted step multiplies λ by
    /// `max(1/3, 1 − (2ϱ − 1)³)`. Refused ones multiply it by 2, 4, 8 and so on. A step that
    /// leaves the cost as it is counts as accepted with `ϱ = 0`: near the optimum rounding decides.
    pub fn update(&mut self, decrease: f64, predicted: f64) -> bool {
        // Written so that a cost that is not a number is refused.
        if decrease >= 0.0 {
            let shortfall = 2.0 * (decrease / predicted) - 1.0;
            // `max` drops the NaN of 0/0: there was nothing to win, and no step.
            self.value *= (1.0 - shortfall * shortfall * shortfall).max(1.0 / 3.0);
            self.growth = 2.0;
            true
        } else {
            // From zero no product leads away. Less than this changes no digit of a sum.
            self.value = (self.value * self.growth).max(f64::EPSILON);
            self.growth *= 2.0;
            false
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_step_as_good_as_promised_divides_the_damping_by_three() {
        let mut damping = Damping::new(0.6);
        assert!(damping.update(2.0, 2.0));
        assert_eq!(damping.value(), 0.6 / 3.0);
    }

    #[test]
    fn half_of_what_was_promised_leaves_the_damping_as_it_is() {
        let mut damping = Damping::new(0.6);
        assert!(damping.update(1.0, 2.0));
        assert_eq!(damping.value(), 0.6);
    }

    #[test]
    fn refused_steps_raise_the_damping_faster_each_time() {
        let mut damping = Damping::new(1.0);
        for expected in [2.0, 8.0, 64.0] {
            assert!(!damping.update(-1.0, 1.0));
            assert_eq!(damping.value(), expected);
        }
        assert!(damping.update(1.0, 2.0));
        assert!(!damping.update(f64::NAN, 1.0));
        assert_eq!(damping.value(), 128.0);
    }

    #[test]
    fn a_refused_step_leads_away_from_no_damping() {
        let mut damping = Damping::new(0.0);
        assert!(!damping.update(-1.0, 1.0));
        assert!(damping.value() > 0.0);
    }

    #[test]
    fn nothing_won_where_nothing_was_promised_is_accepted() {
        let mut damping = Damping::new(0.3);
        assert!(damping.update(0.0, 0.0));
        assert_eq!(damping.value(), 0.3 / 3.0);
    }
}
