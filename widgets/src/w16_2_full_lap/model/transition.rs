//! The animation from the poses before a loop to the poses after it.

use widget_kit::model::Activity;

/// Time for which the old poses stand still first, so that they are seen.
const HOLD_S: f64 = 0.4;

/// Duration of the movement.
const MOVE_S: f64 = 1.1;

/// A running animation.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Transition {
    elapsed_s: f64,
}

impl Transition {
    /// Advances the animation; idle once the new poses are reached.
    pub fn advance(&mut self, elapsed_s: f64) -> Activity {
        // A long gap (a page in the background) counts as a quarter of a second.
        self.elapsed_s += elapsed_s.clamp(0.0, 0.25);
        if self.elapsed_s < HOLD_S + MOVE_S {
            Activity::Busy
        } else {
            Activity::Idle
        }
    }

    /// Fraction of the movement from the old poses (0) to the new ones (1), slow at both ends.
    #[must_use]
    pub fn share(&self) -> f64 {
        let s = ((self.elapsed_s - HOLD_S) / MOVE_S).clamp(0.0, 1.0);
        s * s * (3.0 - 2.0 * s)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_animation_holds_then_moves_once_from_old_to_new() {
        let mut transition = Transition::default();
        let mut shares = vec![transition.share()];
        let mut frames = 0;
        while transition.advance(1.0 / 60.0) == Activity::Busy {
            shares.push(transition.share());
            frames += 1;
        }
        shares.push(transition.share());
        assert_eq!(shares[0], 0.0);
        assert_eq!(*shares.last().unwrap(), 1.0);
        assert!(shares.is_sorted());
        // A second and a half at sixty frames a second.
        assert!((88..=90).contains(&frames), "{frames} frames");
    }

    #[test]
    fn a_page_left_in_the_background_does_not_skip_the_animation() {
        let mut transition = Transition::default();
        assert_eq!(transition.advance(3600.0), Activity::Busy);
        assert_eq!(transition.share(), 0.0);
    }
}
