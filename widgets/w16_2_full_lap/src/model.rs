//! The state of the widget: parameters, the laps they lead to, playback and animation.
//!
//! A parameter that changes the lap asks for a new one. It is computed in pieces, the newest that was
//! asked for first; the old one stays until the new one is whole, and the moment shown stays.

mod gates;
mod moment;
mod picture;
mod runs;
mod settings;
mod tables;
mod track;
mod transition;
mod words;

use ch16_lab::lap::{LapRecord, LoopAttempt, NewestLap, NewestStep};
use kit::chart::{dragged_to, grab_now};
use kit::model::{
    Activity, Handle, Model, Motion, Outcome, Table, Timeline, TimelineMark, press_preset,
};
use kit::param::{Changed, ParamError, Values};
use kit::playback::{Playback, speed_factor};
use kit::scene::Scene;
use kit::spec::WidgetSpec;

use crate::spec::{LOOP_BUTTONS, SPEC};
use moment::Moment;
use runs::{Results, Runs};
use settings::LapSettings;
use transition::Transition;

/// Ticks a second at speed 1: twice as fast as the robot.
const TICKS_PER_S: f64 = 8.0;

/// The full lap.
pub struct FullLap {
    values: Values,
    /// What is shown.
    runs: Runs,
    /// What is being computed.
    laps: NewestLap,
    /// Buttons that wait for the lap they were pressed for.
    pressed: Vec<&'static str>,
    canonical: Results,
    playback: Playback,
    transition: Option<Transition>,
}

impl Default for FullLap {
    fn default() -> Self {
        Self::new()
    }
}

impl FullLap {
    /// The chapter's run, at its first loop.
    ///
    /// # Panics
    /// Never: a lap that was asked for ends.
    #[must_use]
    pub fn new() -> Self {
        let values = Values::defaults(SPEC.params);
        let mut laps = NewestLap::new();
        laps.ask(LapSettings::read(&values).config());
        let runs = Runs::new(*laps.finish().expect("a lap was asked for"));
        Self {
            canonical: runs.results(),
            values,
            runs,
            laps,
            pressed: Vec::new(),
            playback: Playback::default(),
            transition: None,
        }
    }

    fn tick(&self) -> usize {
        self.values.get("t") as usize
    }

    fn last(&self) -> f64 {
        self.runs.ticks() as f64
    }

    /// Goes to a tick; where a loop was closed in it, the nodes move from old to new.
    fn go_to(&mut self, tick: usize) {
        let tick = (tick as f64).min(self.last());
        self.values
            .set(SPEC.id, "t", tick)
            .expect("a tick of the lap is within the timeline");
        self.animate();
    }

    fn animate(&mut self) {
        let closed = self
            .runs
            .graph
            .attempt_at(self.tick())
            .is_some_and(LoopAttempt::accepted);
        self.transition =
            (closed && self.playback.motion() == Motion::Full).then(Transition::default);
    }

    fn press_loop_button(&mut self, offset: isize) {
        self.playback.pause();
        if let Some(attempt) = self.runs.graph.attempt_near(self.tick()) {
            self.go_to(attempt.tick.saturating_add_signed(offset));
        }
    }

    fn next_loop(&mut self) {
        self.playback.pause();
        let tick = self.tick();
        let attempts = self.runs.graph.attempts();
        let next = attempts.iter().find(|attempt| attempt.tick > tick);
        if let Some(attempt) = next.or(attempts.first()) {
            self.go_to(attempt.tick);
        }
    }

    fn back_to_defaults(&mut self) {
        self.values.reset();
        self.playback.pause();
        self.transition = None;
        self.pressed.clear();
        self.recompute();
    }

    /// Asks for the lap of the settings, where it is not the one that is shown.
    fn recompute(&mut self) {
        self.laps.ask(LapSettings::read(&self.values).config());
    }

    /// Shows a lap that is whole, and does what waited for it.
    fn show(&mut self, record: LapRecord) {
        self.runs = Runs::new(record);
        self.transition = None;
        if self.values.get("t") > self.last() {
            self.go_to(self.runs.ticks());
        }
        if !self.laps.is_running() {
            for button in core::mem::take(&mut self.pressed) {
                self.press_loop(button);
            }
        }
    }

    /// Buttons that go by the loops of the lap; says whether it is one of them.
    fn press_loop(&mut self, id: &str) -> bool {
        let Some(button) = LOOP_BUTTONS.iter().find(|button| button.id == id) else {
            return false;
        };
        if self.laps.is_running() {
            self.pressed.push(button.id);
            return true;
        }
        match button.id {
            "before" => self.press_loop_button(-1),
            "at" => self.press_loop_button(0),
            "after" => self.press_loop_button(1),
            _ => self.next_loop(),
        }
        true
    }

    /// Plays on; stops for the animation of every loop on the way.
    fn play(&mut self, elapsed_s: f64) {
        let now = self.values.get("t");
        let rate = TICKS_PER_S * speed_factor(self.values.get("speed"));
        let reached = self.playback.advance(now, self.last(), elapsed_s, rate) as usize;
        let ahead = |attempt: &&LoopAttempt| attempt.tick > now as usize && attempt.tick < reached;
        let stop = self.runs.graph.attempts().iter().find(ahead);
        let target = stop.map_or(reached, |attempt| attempt.tick);
        if target < reached && !self.playback.is_playing() {
            // The end was in reach, but the loop comes first: play on from there.
            self.playback.toggle(target as f64, self.last());
        }
        if target as f64 != now {
            self.go_to(target);
        }
    }

    fn moment(&self) -> Moment<'_> {
        let share = self.transition.as_ref().map_or(1.0, Transition::share);
        let seen_until = if self.values.get("future") == 0.0 {
            self.tick()
        } else {
            self.runs.ticks()
        };
        Moment::new(&self.runs, self.tick(), share, seen_until)
    }
}

impl Model for FullLap {
    fn spec(&self) -> &'static WidgetSpec {
        &SPEC
    }

    fn values(&self) -> &Values {
        &self.values
    }

    fn set(&mut self, id: &str, value: f64) -> Result<(), ParamError> {
        if self.values.set(SPEC.id, id, value)? == Changed::No {
            return Ok(());
        }
        match id {
            "t" => self.go_to(self.tick()),
            "speed" | "more" | "future" => {}
            _ => self.recompute(),
        }
        Ok(())
    }

    fn press(&mut self, id: &str) -> Result<(), ParamError> {
        let now = self.values.get("t");
        if let Some(position) = self.playback.press(id, now, self.last()) {
            if position != now {
                self.go_to(position as usize);
            }
            return Ok(());
        }
        if self.press_loop(id) {
            return Ok(());
        }
        match id {
            "defaults" => self.back_to_defaults(),
            _ => return press_preset(self, id),
        }
        Ok(())
    }

    fn advance(&mut self, elapsed_s: f64) -> Activity {
        if let Some(transition) = &mut self.transition {
            if transition.advance(elapsed_s) == Activity::Idle {
                self.transition = None;
            }
        } else if self.playback.is_playing() {
            self.play(elapsed_s);
        }
        if self.transition.is_some() || self.playback.is_playing() {
            Activity::Busy
        } else {
            Activity::Idle
        }
    }

    /// One tick of the lap that is being computed.
    fn work(&mut self) -> Activity {
        match self.laps.step() {
            NewestStep::Idle => return Activity::Idle,
            NewestStep::Tick => {}
            NewestStep::Finished(record) => self.show(*record),
        }
        Activity::Busy
    }

    fn settle(&mut self) -> Activity {
        let Some(record) = self.laps.finish() else {
            return Activity::Idle;
        };
        self.show(*record);
        Activity::Busy
    }

    fn scene(&self) -> Scene {
        picture::scene(&self.moment())
    }

    fn outcome(&self) -> Outcome {
        words::outcome(&self.runs, self.tick())
    }

    fn summary(&self) -> String {
        words::summary(&self.runs, self.tick())
    }

    fn timeline(&self) -> Option<Timeline> {
        let lap = self.runs.graph.lap();
        let mark = |attempt: &LoopAttempt| TimelineMark {
            at: attempt.tick as f64,
            label: lap.loop_headline(attempt),
            standing: words::standing(lap.judge(attempt)),
        };
        Some(Timeline {
            param: "t",
            last: self.last(),
            playing: self.playback.is_playing(),
            marks: self.runs.graph.attempts().iter().map(mark).collect(),
        })
    }

    fn tables(&self) -> Vec<Table> {
        tables::all(&self.runs, &self.canonical)
    }

    fn shown_tables(&self) -> Vec<Table> {
        tables::shown(&self.runs, &self.canonical)
    }

    /// The line at the moment shown, in every plot over time.
    fn grab(&self, panel: &str, at: [f64; 2], reach: [f64; 2]) -> Option<Handle> {
        let panel = *picture::OVER_TIME.iter().find(|id| **id == panel)?;
        grab_now(panel, self.values.get("t"), at, reach)
    }

    fn drag(&mut self, handle: Handle, at: [f64; 2]) {
        let tick = dragged_to(handle, at) as usize;
        if tick != self.tick() {
            self.go_to(tick);
        }
    }

    fn set_motion(&mut self, motion: Motion) {
        if let Some(end) = self.playback.set_motion(motion, self.last()) {
            self.go_to(end as usize);
        }
        if motion == Motion::Reduced {
            self.transition = None;
        }
    }
}

#[cfg(test)]
mod tests;
