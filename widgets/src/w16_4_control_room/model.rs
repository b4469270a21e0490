//! The state of the control room: one recorded run, the current tick, its grid and registration.
//!
//! A parameter of the run requests a new one. The newest request is computed in pieces. Meanwhile the old run
//! stays on screen, and so does the current tick.
//!
//! # Computed
//!
//! One lap by the estimator (`ch16_slam2d::slam`), with what each of its parts did at every tick, and the occupancy
//! grid (`pr_grid`) of the keyframes' sweeps at their present poses.
//!
//! # Numbers
//!
//! As for w16.2; the grid: `pr_grid::GridConfig`.
//!
//! # Simplified
//!
//! As for w16.2. All parts run one after the other within a tick; on a robot the back end usually has its own thread.

mod grid;
mod history;
mod log;
mod picture;
mod settings;
mod tables;
mod texts;

use ch16_lab::lap::{LapRecord, NewestLap, NewestStep, RegistrationView, TickReport};
use pr_sim::World;
use widget_kit::chart::{dragged_to, grab_now};
use widget_kit::model::{Activity, Handle, Model, Motion, Table, Timeline, press_preset};
use widget_kit::param::ParamError;
use widget_kit::playback::Playback;
use widget_kit::playback::SPEED;
use widget_kit::values::{Changed, Values};

use crate::from_modules::from_modules;
use crate::w16_4_control_room::spec::{PART, SPEC, TICK};
use grid::GridView;
use history::History;
use log::Event;
use picture::parts;
use settings::config;

/// Ticks a second at speed 1: twice as fast as the robot.
const TICKS_PER_S: f64 = 8.0;

/// Duration of the pulses and of the repainting after a loop, s at speed 1: no more than a glance.
const CLOSING_S: f64 = 1.5;

/// The model of the widget.
pub struct ControlRoom {
    values: Values,
    world: World,
    /// The run on screen.
    record: LapRecord,
    /// The run under way.
    laps: NewestLap,
    /// How often the reader asked for the next event of the run under way.
    next_events: usize,
    history: History,
    events: Vec<Event>,
    /// The registration of the current tick.
    registration: Option<RegistrationView>,
    grid: GridView,
    playback: Playback,
    /// The shown share of what follows the loop that the playback has reached.
    closing: Option<f64>,
}

impl Default for ControlRoom {
    /// The chapter's run on its outward path.
    ///
    /// # Panics
    /// Never: a requested lap ends.
    fn default() -> Self {
        let values = Values::defaults(SPEC.params);
        let mut laps = NewestLap::new();
        laps.ask(config(&values));
        let record = *laps.finish().expect("a lap was asked for");
        let mut room = Self {
            history: History::new(&record),
            events: log::events(&record),
            registration: None,
            grid: GridView::new(&record, 0),
            world: World::apartment(),
            playback: Playback::default(),
            closing: None,
            values,
            laps,
            next_events: 0,
            record,
        };
        room.show();
        room
    }
}

impl ControlRoom {
    fn tick(&self) -> usize {
        self.values.get(&TICK) as usize
    }

    /// The selected part.
    fn part(&self) -> usize {
        self.values.get(&PART)
    }

    fn choose_part(&mut self, part: usize) {
        self.values
            .set(SPEC.id, "lane", part as f64)
            .expect("a part of the list");
    }

    fn last(&self) -> f64 {
        self.record.ticks() as f64
    }

    fn now(&self) -> Option<&TickReport> {
        self.record.lap.report(self.tick())
    }

    fn go_to(&mut self, tick: f64) {
        let tick = tick.clamp(0.0, self.last());
        self.values
            .set(SPEC.id, "t", tick)
            .expect("a tick of the lap is within the timeline");
        self.show();
    }

    /// Recomputes the details of the current tick that the record does not store.
    fn show(&mut self) {
        if self.closing.take().is_some() {
            self.grid.forget();
        }
        let tick = self.tick();
        self.registration = self.record.registration(tick);
        self.grid.show(&self.record, tick);
    }

    fn run_again(&mut self) {
        self.laps.ask(config(&self.values));
    }

    /// Shows a finished run and executes what waited for it.
    fn take(&mut self, record: LapRecord) {
        self.record = record;
        self.history = History::new(&self.record);
        self.events = log::events(&self.record);
        self.grid.forget();
        self.go_to(self.values.get(&TICK));
        if !self.laps.is_running() {
            for _ in 0..core::mem::take(&mut self.next_events) {
                self.next_event();
            }
        }
    }

    fn back_to_defaults(&mut self) {
        self.playback.pause();
        self.values.reset();
        self.next_events = 0;
        self.run_again();
        self.show();
    }

    fn next_event(&mut self) {
        if self.laps.is_running() {
            self.next_events += 1;
            return;
        }
        self.playback.pause();
        let now = self.tick();
        let next = self.events.iter().find(|event| event.tick > now);
        if let Some(event) = next.or(self.events.first()) {
            let (tick, part) = (event.tick, event.part_at_work);
            self.choose_part(part);
            self.go_to(tick as f64);
        }
    }

    /// The loop test of the current tick, from the log.
    fn loop_event(&self) -> Option<&Event> {
        let now = self.tick();
        let mut marked = self.events.iter().filter(|event| event.marked);
        marked.find(|event| event.tick == now)
    }
}

impl Model for ControlRoom {
    from_modules!();

    fn set(&mut self, id: &str, value: f64) -> Result<(), ParamError> {
        if self.values.set(SPEC.id, id, value)? == Changed::No {
            return Ok(());
        }
        match id {
            "t" => self.go_to(value),
            "speed" | "more" | "lane" => {}
            _ => self.run_again(),
        }
        Ok(())
    }

    fn press(&mut self, id: &str) -> Result<(), ParamError> {
        let now = self.values.get(&TICK);
        if let Some(position) = self.playback.press(id, now, self.last()) {
            self.go_to(position);
            return Ok(());
        }
        match id {
            "next-event" => self.next_event(),
            "defaults" => self.back_to_defaults(),
            _ => return press_preset(self, id),
        }
        Ok(())
    }

    fn advance(&mut self, elapsed_s: f64) -> Activity {
        let speed = self.values.get(&SPEED);
        if let Some(share) = self.closing {
            let share = (share + elapsed_s * speed / CLOSING_S).min(1.0);
            self.grid.draw(&self.record, self.tick(), share);
            self.closing = (share < 1.0).then_some(share);
            return Activity::Busy;
        }
        if !self.playback.is_playing() {
            return Activity::Idle;
        }
        let now = self.tick();
        let rate = TICKS_PER_S * speed;
        let reached = self
            .playback
            .advance(now as f64, self.last(), elapsed_s, rate) as usize;
        let mut passed = self.record.lap.reports[now..reached].iter();
        let closed = passed.find(|report| parts::closes_loop(report));
        let closed = closed.map(|report| report.tick);
        if reached != now {
            self.go_to(closed.unwrap_or(reached) as f64);
        }
        if closed.is_some() {
            self.closing = Some(0.0);
            self.grid.clear(&self.record, self.tick());
        }
        Activity::Busy
    }

    /// Processes one tick of the run under way.
    fn work(&mut self) -> Activity {
        match self.laps.step() {
            NewestStep::Idle => Activity::Idle,
            NewestStep::Tick => Activity::BusyUnchanged,
            NewestStep::Finished(record) => {
                self.take(*record);
                Activity::Busy
            }
        }
    }

    fn settle(&mut self) -> Activity {
        self.laps.drop_outdated();
        self.work()
    }

    fn timeline(&self) -> Option<Timeline> {
        Some(Timeline {
            param: "t",
            last: self.last(),
            playing: self.playback.is_playing(),
            marks: log::marks(&self.events),
        })
    }

    fn shown_tables(&self) -> Vec<Table> {
        tables::shown(self)
    }

    /// The line at the current tick, in every plot over time, and each part.
    fn grab(&self, panel: &str, at: [f64; 2], reach: [f64; 2]) -> Option<Handle> {
        if panel == parts::ID {
            return parts::at(at).map(|part| Handle {
                panel: parts::ID,
                id: parts::name(part),
                ..Handle::default()
            });
        }
        let panel = *picture::OVER_TIME.iter().find(|id| **id == panel)?;
        grab_now(panel, self.values.get(&TICK), at, reach)
    }

    fn drag(&mut self, handle: Handle, at: [f64; 2]) {
        if let Some(part) = parts::from_name(handle.id) {
            self.choose_part(part);
            return;
        }
        let tick = dragged_to(handle, at);
        if tick != self.values.get(&TICK) {
            self.go_to(tick);
        }
    }

    fn set_motion(&mut self, motion: Motion) {
        if let Some(end) = self.playback.set_motion(motion, self.last()) {
            self.go_to(end);
        }
    }
}
