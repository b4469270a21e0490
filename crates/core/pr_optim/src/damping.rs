//! Damping schedule of Levenberg–Marquardt, after Nielsen.
//!
//! Source: Nielsen, "Damping parameter in Marquardt's method", 1999.

/// Largest damping tried before the solve gives up.
pub(crate) const DAMPING_LIMIT: f64 = 1e12;

/// The damping λ of the next step, and the factor by which a rejected step raises it.
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
    /// A schedule that starts at `value`.
    pub fn new(value: f64) -> Self {
        Self { value, growth: 2.0 }
    }

    /// λ, relative to the diagonal of H.
    pub fn value(&self) -> f64 {
        self.value
    }

    /// Whether a step that changed the cost by `−decrease` is accepted; sets the damping of the next.
    ///
    /// With the gain ratio `ϱ = decrease / predicted`, an accepted step multiplies λ by `max(1/3, 1 − (2ϱ − 1)³)`.
    /// Rejected steps multiply it by 2, 4, 8 and so on. A step with zero decrease is accepted with `ϱ = 0`: near
    /// the optimum rounding decides.
    pub fn update(&mut self, decrease: f64, predicted: f64) -> bool {
        // Written to reject a NaN cost.
        if decrease >= 0.0 {
            let shortfall = 2.0 * (decrease / predicted) - 1.0;
            // `max` ignores the NaN of 0/0: zero predicted decrease and zero step.
            self.value *= (1.0 - shortfall * shortfall * shortfall).max(1.0 / 3.0);
            self.growth = 2.0;
            true
        } else {
            // A product cannot leave zero. A smaller value than this would not change any digit of a sum.
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
    fn a_gain_ratio_of_one_divides_the_damping_by_three() {
        let mut damping = Damping::new(0.6);
        assert!(damping.update(2.0, 2.0));
        assert_eq!(damping.value(), 0.6 / 3.0);
    }

    #[test]
    fn a_gain_ratio_of_one_half_keeps_the_damping() {
        let mut damping = Damping::new(0.6);
        assert!(damping.update(1.0, 2.0));
        assert_eq!(damping.value(), 0.6);
    }

    #[test]
    fn rejected_steps_raise_the_damping_faster_each_time() {
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
    fn a_rejected_step_raises_a_damping_of_zero() {
        let mut damping = Damping::new(0.0);
        assert!(!damping.update(-1.0, 1.0));
        assert!(damping.value() > 0.0);
    }

    #[test]
    fn a_zero_decrease_is_accepted_if_zero_was_predicted() {
        let mut damping = Damping::new(0.3);
        assert!(damping.update(0.0, 0.0));
        assert_eq!(damping.value(), 0.3 / 3.0);
    }
}
