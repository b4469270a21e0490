//! Playback along one parameter: transport, reduced motion and defaults, the same in every widget with a
//! timeline.

use crate::model::{Activity, Motion, Timeline, TimelineMark};
use crate::param::Param;
use crate::playback::{Playback, SPEED};
use crate::spec::DEFAULTS;
use crate::values::Values;

/// The playback of a widget, and the parameter that holds the position.
///
/// A position beyond the end means the end, so a link to the end stays right if a run gets longer. Each call
/// gets the last position, because most settings change it.
#[derive(Clone, Copy, Debug)]
pub struct PlaybackParam {
    param: &'static Param<f64>,
    playback: Playback,
}

/// The kind of a button in [`PlaybackParam::press`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pressed {
    /// A transport button: the position is set.
    Transport,
    /// The defaults button: every value is reset, and the caller has to update what depends on them.
    Defaults,
    /// Another button: no change.
    Other,
}

impl PlaybackParam {
    /// A paused playback along that parameter.
    #[must_use]
    pub fn along(param: &'static Param<f64>) -> Self {
        Self {
            param,
            playback: Playback::default(),
        }
    }

    /// Whether it plays.
    #[must_use]
    pub fn is_playing(&self) -> bool {
        self.playback.is_playing()
    }

    /// Whether animations run.
    #[must_use]
    pub fn motion(&self) -> Motion {
        self.playback.motion()
    }

    /// The current position.
    #[must_use]
    pub fn place(&self, values: &Values, last: f64) -> f64 {
        values.get(self.param).min(last)
    }

    /// [`Playback::part`].
    #[must_use]
    pub fn part(&self) -> f64 {
        self.playback.part()
    }

    /// Stops at the current position.
    pub fn pause(&mut self) {
        self.playback.pause();
    }

    /// Presses a transport button or the defaults button.
    pub fn press(&mut self, values: &mut Values, button: &str, last: f64) -> Pressed {
        let here = self.place(values, last);
        if let Some(position) = self.playback.press(button, here, last) {
            values.put(self.param, position);
            return Pressed::Transport;
        }
        if button != DEFAULTS.id {
            return Pressed::Other;
        }
        self.pause();
        values.reset();
        Pressed::Defaults
    }

    /// Advances by that many seconds, at a rate of steps a second at normal speed.
    pub fn advance(
        &mut self,
        values: &mut Values,
        last: f64,
        elapsed_s: f64,
        steps_per_s: f64,
    ) -> Activity {
        if !self.is_playing() {
            return Activity::Idle;
        }
        let rate = steps_per_s * values.get(&SPEED);
        let here = self.place(values, last);
        let next = self.playback.advance(here, last, elapsed_s, rate);
        values.put(self.param, next);
        Activity::Busy
    }

    /// Sets whether animations run: with reduced motion a run that plays jumps to its end.
    pub fn set_motion(&mut self, values: &mut Values, motion: Motion, last: f64) {
        if let Some(end) = self.playback.set_motion(motion, last) {
            values.put(self.param, end);
        }
    }

    /// The timeline with its marks.
    #[must_use]
    pub fn timeline(&self, last: f64, marks: Vec<TimelineMark>) -> Timeline {
        Timeline {
            param: self.param.id,
            last,
            playing: self.is_playing(),
            marks,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::param::{MORE, ParamSpec};

    static STEPS: Param<f64> = Param::timeline("steps", "steps", 1000.0).default(1000.0);
    const PARAMS: &[&ParamSpec] = &[&STEPS.spec, &SPEED.spec, &MORE.spec];

    #[test]
    fn a_position_beyond_the_end_is_the_end_and_play_starts_over_there() {
        let (mut values, mut run) = (Values::defaults(PARAMS), PlaybackParam::along(&STEPS));
        assert_eq!(run.place(&values, 10.0), 10.0);
        assert_eq!(run.press(&mut values, "play", 10.0), Pressed::Transport);
        assert_eq!((values.get(&STEPS), run.is_playing()), (0.0, true));
        assert_eq!(run.advance(&mut values, 10.0, 0.2, 5.0), Activity::Busy);
        assert_eq!(values.get(&STEPS), 1.0);
        values.store("speed", 4.0);
        run.advance(&mut values, 10.0, 0.2, 5.0);
        assert_eq!(values.get(&STEPS), 5.0, "four times as fast");
    }

    #[test]
    fn defaults_stop_the_run_and_keep_the_layer_open() {
        let (mut values, mut run) = (Values::defaults(PARAMS), PlaybackParam::along(&STEPS));
        values.store(MORE.id, 1.0);
        run.press(&mut values, "play", 10.0);
        assert_eq!(run.press(&mut values, "defaults", 10.0), Pressed::Defaults);
        assert_eq!((values.get(&STEPS), run.is_playing()), (1000.0, false));
        assert!(values.get(&MORE));
        assert_eq!(run.press(&mut values, "quarter-turn", 10.0), Pressed::Other);
    }

    #[test]
    fn reduced_motion_ends_a_playing_run_at_once() {
        let (mut values, mut run) = (Values::defaults(PARAMS), PlaybackParam::along(&STEPS));
        run.press(&mut values, "play", 10.0);
        run.set_motion(&mut values, Motion::Reduced, 10.0);
        assert_eq!((values.get(&STEPS), run.is_playing()), (10.0, false));
    }
}
