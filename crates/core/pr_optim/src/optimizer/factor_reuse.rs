//! Reuse of a step's factor for the next step.

/// A step of at most this size, m and rad added, hardly changes the factor, because headings hardly turn.
const SHORT_STEP: f64 = 0.02;

/// A reused factor still converges if each step is at most this fraction of the one before.
const MAX_STEP_RATIO: f64 = 0.2;

/// Decides whether the factor of the last step is reused.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct FactorReuse {
    /// Whether the next step uses the present factor.
    is_reused: bool,
    /// Largest step of a node in the last step of this solve; `None` before the first.
    last_size: Option<f64>,
    /// Expected size of the next step, if it shrinks like the last one.
    expected_size: Option<f64>,
}

impl FactorReuse {
    /// Resets the state for a new solve.
    pub fn reset(&mut self) {
        *self = Self::default();
    }

    /// Records that the factor was replaced or dropped.
    pub fn invalidate(&mut self) {
        self.is_reused = false;
    }

    /// Whether the next step uses the present factor.
    pub fn is_reused(&self) -> bool {
        self.is_reused
    }

    /// The expected size of the next step; `None` before the first.
    pub fn expected_size(&self) -> Option<f64> {
        self.expected_size
    }

    /// Records a step of this size.
    ///
    /// A fresh factor is reused if its step was short; a reused one is reused again if the step shrank
    /// enough.
    pub fn record_step(&mut self, size: f64) {
        let ratio = self.last_size.map_or(1.0, |last| size / last);
        self.is_reused = if self.is_reused {
            ratio <= MAX_STEP_RATIO
        } else {
            size <= SHORT_STEP
        };
        self.last_size = Some(size);
        self.expected_size = Some(size * ratio.min(1.0));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Whether the factor is reused after each of these steps.
    fn reuses(sizes: &[f64]) -> Vec<bool> {
        let mut reuse = FactorReuse::default();
        let mut after = |size: &f64| {
            reuse.record_step(*size);
            reuse.is_reused()
        };
        sizes.iter().map(&mut after).collect()
    }

    #[test]
    fn a_factor_is_reused_while_steps_are_short_and_shrink() {
        assert_eq!(reuses(&[0.01, 1e-3, 1e-4]), [true, true, true]);
        assert_eq!(reuses(&[0.5, 0.01, 1e-4]), [false, true, true]);
        // The third step hardly shrank: the next one gets a new factor.
        assert_eq!(reuses(&[0.01, 1e-3, 9e-4, 1e-6]), [true, true, false, true]);
    }

    #[test]
    fn the_next_step_is_expected_to_shrink_as_the_last_one_did() {
        let mut reuse = FactorReuse::default();
        assert_eq!(reuse.expected_size(), None);
        reuse.record_step(0.25);
        assert_eq!(reuse.expected_size(), Some(0.25));
        reuse.record_step(0.125);
        assert_eq!(reuse.expected_size(), Some(0.0625));
        reuse.record_step(0.5);
        assert_eq!(reuse.expected_size(), Some(0.5), "it grew");
    }
}
