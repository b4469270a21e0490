//! Whether the factor of one step solves the next one as well.

/// A step of at most that size, m and rad added, leaves the factor about as it was: headings that turned
/// are what changes it.
const SHORT: f64 = 0.02;

/// A step at most so long as the one before says that the factor leads on.
const SHRINKS: f64 = 0.2;

/// What a solve knows of the factor that its last step was solved with.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct HeldFactor {
    /// Whether the next step is solved by the factor that is there.
    is_held: bool,
    /// Largest step of a node in the last step of this solve; none before the first.
    last_size: Option<f64>,
    /// What that of the next one will be, if it shrinks as the last one did.
    expected_size: Option<f64>,
}

impl HeldFactor {
    /// Another solve begins.
    pub fn forget(&mut self) {
        *self = Self::default();
    }

    /// The factor is another one now, or none.
    pub fn lose(&mut self) {
        self.is_held = false;
    }

    /// Whether the next step is solved by the factor that is there.
    pub fn is_held(&self) -> bool {
        self.is_held
    }

    /// The size that the next step is expected to have; none before the first.
    pub fn expected_size(&self) -> Option<f64> {
        self.expected_size
    }

    /// A step of that size was taken.
    ///
    /// Its own factor serves the next step if it was short; one that served before does if it led on.
    pub fn stepped(&mut self, size: f64) {
        let ratio = self.last_size.map_or(1.0, |last| size / last);
        self.is_held = if self.is_held {
            ratio <= SHRINKS
        } else {
            size <= SHORT
        };
        self.last_size = Some(size);
        self.expected_size = Some(size * ratio.min(1.0));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Whether the factor serves once more after each of these steps.
    fn serves(sizes: &[f64]) -> Vec<bool> {
        let mut held = HeldFactor::default();
        let mut after = |size: &f64| {
            held.stepped(*size);
            held.is_held()
        };
        sizes.iter().map(&mut after).collect()
    }

    #[test]
    fn a_factor_serves_while_steps_are_short_and_shrink() {
        assert_eq!(serves(&[0.01, 1e-3, 1e-4]), [true, true, true]);
        assert_eq!(serves(&[0.5, 0.01, 1e-4]), [false, true, true]);
        // The third step hardly led on: the next one is made with a factor of its own.
        assert_eq!(serves(&[0.01, 1e-3, 9e-4, 1e-6]), [true, true, false, true]);
    }

    #[test]
    fn the_next_step_is_expected_to_shrink_as_the_last_one_did() {
        let mut held = HeldFactor::default();
        assert_eq!(held.expected_size(), None);
        held.stepped(0.25);
        assert_eq!(held.expected_size(), Some(0.25));
        held.stepped(0.125);
        assert_eq!(held.expected_size(), Some(0.0625));
        held.stepped(0.5);
        assert_eq!(held.expected_size(), Some(0.5), "it grew");
    }
}
