//! Playback along one parameter: transport, reduced motion and defaults, the same in every widget with a
//! timeline.

use crate::param::Param;
use crate::playback::{Motion, Playback, SPEED};
use crate::spec::DEFAULTS;
use crate::timeline::{Timeline, TimelineMark};
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

/// The values of a widget, and the playback that moves one of them.
#[derive(Debug)]
pub struct PlayedValues<'a> {
    /// The values.
    pub values: &'a mut Values,
    /// The playback.
    pub playback: &'a mut PlaybackParam,
    /// Last position; `None` while the run is being computed.
    pub end: Option<f64>,
    /// Steps a second at normal speed.
    pub steps_per_s: f64,
}

/// What a button or a frame changed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Moved {
    /// The position: the parameter of that name.
    Position(&'static str),
    /// Every value, by the defaults button.
    Everything,
    /// Nothing.
    Nothing,
}

impl PlayedValues<'_> {
    /// The end, beyond every position while the run is being computed.
    fn last(&self) -> f64 {
        self.end.unwrap_or(self.playback.param.range().1)
    }

    fn go_to(&mut self, position: f64) -> Moved {
        self.values.put(self.playback.param, position);
        Moved::Position(self.playback.param.id)
    }

    /// Presses a transport button or the defaults button.
    pub fn press(&mut self, button: &str) -> Moved {
        let last = self.last();
        let here = self.playback.place(self.values, last);
        if let Some(position) = self.playback.playback.press(button, here, last) {
            return self.go_to(position);
        }
        if button != DEFAULTS.id {
            return Moved::Nothing;
        }
        self.playback.pause();
        self.values.reset();
        Moved::Everything
    }

    /// Advances by that many seconds; stands still while the run is being computed.
    pub fn advance(&mut self, elapsed_s: f64) -> Moved {
        let (true, Some(last)) = (self.playback.is_playing(), self.end) else {
            return Moved::Nothing;
        };
        let rate = self.steps_per_s * self.values.get(&SPEED);
        let here = self.playback.place(self.values, last);
        let next = self.playback.playback.advance(here, last, elapsed_s, rate);
        if next == here {
            return Moved::Nothing;
        }
        self.go_to(next)
    }

    /// Sets whether animations run: with reduced motion a run that plays jumps to its end.
    pub fn set_motion(&mut self, motion: Motion) -> Moved {
        match self.playback.playback.set_motion(motion, self.last()) {
            Some(end) => self.go_to(end),
            None => Moved::Nothing,
        }
    }
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

    /// That many steps, five a second.
    fn played<'a>(
        values: &'a mut Values,
        playback: &'a mut PlaybackParam,
        end: f64,
    ) -> PlayedValues<'a> {
        PlayedValues {
            values,
            playback,
            end: Some(end),
            steps_per_s: 5.0,
        }
    }

    #[test]
    fn a_position_beyond_the_end_is_the_end_and_play_starts_over_there() {
        let (mut values, mut playback) = (Values::defaults(PARAMS), PlaybackParam::along(&STEPS));
        assert_eq!(playback.place(&values, 10.0), 10.0);
        let mut ten = played(&mut values, &mut playback, 10.0);
        assert_eq!(ten.press("play"), Moved::Position("steps"));
        assert_eq!(ten.values.get(&STEPS), 0.0);
        assert_eq!(ten.advance(0.2), Moved::Position("steps"));
        assert_eq!(ten.values.get(&STEPS), 1.0);
        ten.values.store("speed", 4.0);
        ten.advance(0.2);
        assert_eq!(ten.values.get(&STEPS), 5.0, "four times as fast");
        ten.end = None;
        assert_eq!(ten.advance(0.2), Moved::Nothing, "it is being computed");
        assert!(playback.is_playing());
    }

    #[test]
    fn defaults_stop_the_run_and_keep_the_layer_open() {
        let (mut values, mut playback) = (Values::defaults(PARAMS), PlaybackParam::along(&STEPS));
        values.store(MORE.id, 1.0);
        let mut ten = played(&mut values, &mut playback, 10.0);
        ten.press("play");
        assert_eq!(ten.press("defaults"), Moved::Everything);
        assert_eq!(ten.press("quarter-turn"), Moved::Nothing);
        assert_eq!((values.get(&STEPS), playback.is_playing()), (1000.0, false));
        assert!(values.get(&MORE));
    }

    #[test]
    fn reduced_motion_ends_a_playing_run_at_once() {
        let (mut values, mut playback) = (Values::defaults(PARAMS), PlaybackParam::along(&STEPS));
        let mut ten = played(&mut values, &mut playback, 10.0);
        ten.press("play");
        ten.set_motion(Motion::Reduced);
        assert_eq!((values.get(&STEPS), playback.is_playing()), (10.0, false));
    }
}
