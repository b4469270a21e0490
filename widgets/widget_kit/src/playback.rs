//! Play, step, reset, speed: seconds in, positions on a timeline out.
//!
//! Reduced motion is handled only here: with it a run never plays and its end is shown at once.

use crate::one_of;
use crate::param::OneOf;
use crate::spec::{PLAY, RESET, STEP};

/// The speed factor of the playback: a parameter that every widget with a timeline lists.
pub static SPEED: OneOf<f64> = one_of!(
    f64,
    "speed",
    "speed",
    &[
        (0.25, "quarter", "×¼"),
        (0.5, "half", "×½"),
        (1.0, "normal", "×1"),
        (2.0, "double", "×2"),
        (4.0, "fourfold", "×4"),
    ],
)
.default("normal")
.help("How fast the run plays.");

/// Whether animations run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Motion {
    /// Animations run.
    #[default]
    Full,
    /// The system asks for reduced motion: animations jump to their end.
    Reduced,
}

/// A playback: whether it runs, and the elapsed fraction of a step.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Playback {
    playing: bool,
    part: f64,
    motion: Motion,
}

impl Playback {
    /// Whether it runs.
    #[must_use]
    pub fn is_playing(&self) -> bool {
        self.playing
    }

    /// Whether animations run.
    #[must_use]
    pub fn motion(&self) -> Motion {
        self.motion
    }

    /// Presses a button of the transport, [`PLAY`], [`STEP`] or [`RESET`]. Returns the new position, or
    /// `None` for any other button.
    pub fn press(&mut self, button: &str, position: f64, last: f64) -> Option<f64> {
        if button == PLAY.id {
            return Some(self.toggle(position, last));
        }
        let target = if button == STEP.id {
            (position + 1.0).min(last)
        } else if button == RESET.id {
            0.0
        } else {
            return None;
        };
        self.pause();
        Some(target)
    }

    /// Starts from here, or from the start if the end is reached; stops a run that plays. Returns the
    /// position. Under [`Motion::Reduced`] that is the end, and nothing plays.
    pub fn toggle(&mut self, position: f64, last: f64) -> f64 {
        if self.motion == Motion::Reduced {
            return last;
        }
        self.playing = !self.playing;
        self.part = 0.0;
        if self.playing && position >= last {
            0.0
        } else {
            position
        }
    }

    /// The part of the next step that has passed while it plays, 0…1: for motion between two steps.
    #[must_use]
    pub fn part(&self) -> f64 {
        self.part
    }

    /// Stops at the current position.
    pub fn pause(&mut self) {
        self.playing = false;
        self.part = 0.0;
    }

    /// Sets whether animations run. Returns the new position `last` if that ends a run.
    pub fn set_motion(&mut self, motion: Motion, last: f64) -> Option<f64> {
        self.motion = motion;
        let ends = motion == Motion::Reduced && self.playing;
        ends.then(|| {
            self.pause();
            last
        })
    }

    /// The position after `elapsed_s` at `steps_per_s`; stops at `last`.
    ///
    /// A long gap (a page in the background) counts as a quarter of a second.
    pub fn advance(&mut self, position: f64, last: f64, elapsed_s: f64, steps_per_s: f64) -> f64 {
        if !self.playing {
            return position;
        }
        self.part += elapsed_s.clamp(0.0, 0.25) * steps_per_s;
        let whole = self.part.floor();
        self.part -= whole;
        let next = position + whole;
        if next >= last {
            self.pause();
            return last;
        }
        next
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn playing_covers_the_timeline_once_and_stops_at_its_end() {
        let mut playback = Playback::default();
        let mut position = playback.toggle(0.0, 10.0);
        let mut frames = 0;
        while playback.is_playing() {
            position = playback.advance(position, 10.0, 1.0 / 60.0, 5.0);
            frames += 1;
        }
        assert_eq!(position, 10.0);
        // Ten steps at five a second are two seconds of sixty frames.
        assert!((119..=121).contains(&frames), "{frames} frames");
        assert_eq!(playback.toggle(position, 10.0), 0.0);
    }

    #[test]
    fn stepping_and_resetting_stop_the_run_and_stay_on_the_timeline() {
        let mut playback = Playback::default();
        for (button, from, to) in [
            ("step", 3.0, 4.0),
            ("step", 10.0, 10.0),
            ("reset", 7.0, 0.0),
        ] {
            playback.toggle(from, 20.0);
            assert_eq!(playback.press(button, from, 10.0), Some(to), "{button}");
            assert!(!playback.is_playing(), "{button}");
        }
        assert_eq!(playback.press("play", 3.0, 10.0), Some(3.0));
        assert_eq!(playback.press("defaults", 3.0, 10.0), None);
        assert!(playback.is_playing(), "another button does not stop it");
    }

    #[test]
    fn a_page_left_in_the_background_does_not_jump_ahead() {
        let mut playback = Playback::default();
        playback.toggle(0.0, 1000.0);
        assert!(playback.advance(0.0, 1000.0, 3600.0, 8.0) <= 2.0);
    }

    #[test]
    fn with_reduced_motion_play_jumps_to_the_end_and_needs_no_frame() {
        let mut playback = Playback::default();
        assert_eq!(playback.set_motion(Motion::Reduced, 10.0), None);
        for position in [0.0, 4.0, 10.0] {
            assert_eq!(playback.toggle(position, 10.0), 10.0);
            assert!(!playback.is_playing());
        }
        // Presets pause; this must not reset reduced motion.
        playback.pause();
        assert_eq!(playback.motion(), Motion::Reduced);
    }

    #[test]
    fn reduced_motion_ends_a_run_and_changes_no_other_state() {
        let mut playback = Playback::default();
        playback.toggle(3.0, 10.0);
        assert_eq!(playback.set_motion(Motion::Reduced, 10.0), Some(10.0));
        assert!(!playback.is_playing());
        assert_eq!(playback.set_motion(Motion::Full, 10.0), None);
        assert_eq!(playback.toggle(3.0, 10.0), 3.0, "it plays again from here");
        assert!(playback.is_playing());
    }
}
