//! The state of the control room: one recorded run, the tick shown, its grid and registration.
//!
//! A parameter of the run computes all of it again at once; the moment shown stays.

mod grid;
mod history;
mod log;
mod picture;
mod words;

use ch16_lab::lap::{LapConfig, LapRecord, LapRunner, RegistrationView, TickReport};
use ch16_slam2d::matching::MatchSummary;
use kit::chart::{dragged_to, grab_now};
use kit::model::{
    Activity, Fact, Handle, Model, Motion, Outcome, Standing, Table, Timeline, press_preset,
};
use kit::param::{Changed, ParamError, Values};
use kit::playback::{Playback, speed_factor};
use kit::scene::Scene;
use kit::spec::WidgetSpec;
use pr_sim::World;

pub use words::SPEC;

use grid::GridView;
use history::History;
use log::Event;

/// Ticks a second at speed 1: twice as fast as the robot.
const TICKS_PER_S: f64 = 8.0;

/// The control room.
pub struct ControlRoom {
    values: Values,
    world: World,
    runner: LapRunner,
    record: LapRecord,
    history: History,
    events: Vec<Event>,
    /// The registration of the tick shown.
    registration: Option<RegistrationView>,
    grid: GridView,
    playback: Playback,
}

impl Default for ControlRoom {
    fn default() -> Self {
        Self::new()
    }
}

impl ControlRoom {
    /// The chapter's run on its way out.
    #[must_use]
    pub fn new() -> Self {
        let values = Values::defaults(SPEC.params);
        let mut runner = LapRunner::new();
        let record = runner.run(&config(&values));
        let mut room = Self {
            history: History::new(&record),
            events: log::events(&record),
            registration: None,
            grid: GridView::new(&record, 0),
            world: World::apartment(),
            playback: Playback::default(),
            values,
            runner,
            record,
        };
        room.show();
        room
    }

    fn tick(&self) -> usize {
        self.values.get("t") as usize
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

    /// Works out what the record does not keep of the tick shown.
    fn show(&mut self) {
        let tick = self.tick();
        self.registration = self.record.registration(tick);
        self.grid.show(&self.record, tick);
    }

    fn run_again(&mut self) {
        self.record = self.runner.run(&config(&self.values));
        self.history = History::new(&self.record);
        self.events = log::events(&self.record);
        self.grid.forget();
        self.go_to(self.values.get("t"));
    }

    fn back_to_defaults(&mut self) {
        self.playback.pause();
        self.values = Values::defaults(SPEC.params);
        self.run_again();
    }

    fn next_event(&mut self) {
        self.playback.pause();
        let now = self.tick();
        let next = self.events.iter().find(|event| event.tick > now);
        if let Some(event) = next.or(self.events.first()) {
            self.go_to(event.tick as f64);
        }
    }

    /// The loop test of the tick shown, as the log has it.
    fn loop_event(&self) -> Option<&Event> {
        let now = self.tick();
        let mut marked = self.events.iter().filter(|event| event.marked);
        marked.find(|event| event.tick == now)
    }
}

fn config(values: &Values) -> LapConfig {
    let config = LapConfig::with_seed_and_noise(values.get("seed") as u32, values.get("noise"));
    if values.get("loops") == 0.0 {
        config.without_loops()
    } else {
        config
    }
}

impl Model for ControlRoom {
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
            "t" => self.go_to(value),
            "speed" => {}
            _ => self.run_again(),
        }
        Ok(())
    }

    fn press(&mut self, id: &str) -> Result<(), ParamError> {
        let now = self.values.get("t");
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
        if !self.playback.is_playing() {
            return Activity::Idle;
        }
        let now = self.values.get("t");
        let rate = TICKS_PER_S * speed_factor(self.values.get("speed"));
        let reached = self.playback.advance(now, self.last(), elapsed_s, rate);
        if reached != now {
            self.go_to(reached);
        }
        Activity::Busy
    }

    fn scene(&self) -> Scene {
        let now = self.tick();
        Scene {
            panels: vec![
                picture::map(&self.record, now, self.grid.raster(), &self.world),
                picture::registration(&self.record, now, self.registration.as_ref()),
                self.history.threshold_plot(now),
                self.history.error_plot(now),
            ],
        }
    }

    fn outcome(&self) -> Outcome {
        let event = self.loop_event();
        let attempt = self.now().and_then(|report| report.loop_attempt.as_ref());
        let verdict = match attempt {
            Some(attempt) => self.record.lap.judge(attempt).to_string(),
            None if self.tick() == self.record.ticks() => "run finished".to_owned(),
            None => "on the way".to_owned(),
        };
        let sentence = event.map_or_else(|| self.tick_sentence(), |event| event.text.clone());
        Outcome {
            standing: event.map_or(Standing::Neutral, |event| event.standing),
            verdict,
            sentence,
            facts: self.facts(),
        }
    }

    fn summary(&self) -> String {
        format!(
            "{} {} The newest sweep is paired with the local map by {} pairs.",
            self.grid.words(),
            self.tick_sentence(),
            self.now().map_or(0, |r| r.registration.matched.inliers),
        )
    }

    fn timeline(&self) -> Option<Timeline> {
        Some(Timeline {
            param: "t",
            last: self.last(),
            playing: self.playback.is_playing(),
            marks: log::marks(&self.events),
        })
    }

    fn tables(&self) -> Vec<Table> {
        let mut tables = self.shown_tables();
        tables.push(history::full_log(&self.events));
        tables.push(self.history.table(&self.record.lap.reports));
        tables
    }

    fn shown_tables(&self) -> Vec<Table> {
        vec![history::event_table(&self.events, self.tick())]
    }

    /// The line at the moment shown, in both plots over time.
    fn grab(&self, panel: &str, at: [f64; 2], reach: [f64; 2]) -> Option<Handle> {
        let panel = *history::OVER_TIME.iter().find(|id| **id == panel)?;
        grab_now(panel, self.values.get("t"), at, reach)
    }

    fn drag(&mut self, handle: Handle, at: [f64; 2]) {
        let tick = dragged_to(handle, at);
        if tick != self.values.get("t") {
            self.go_to(tick);
        }
    }

    fn set_motion(&mut self, motion: Motion) {
        if let Some(end) = self.playback.set_motion(motion, self.last()) {
            self.go_to(end);
        }
    }
}

impl ControlRoom {
    fn tick_sentence(&self) -> String {
        let Some(report) = self.now() else {
            return "The run stands at its start, with one sweep sensed.".to_owned();
        };
        format!(
            "Tick {} of {}: keyframe {}, the estimate is {:.2} m off, odometry {:.2} m.",
            report.tick,
            self.record.ticks(),
            self.record.lap.node_count(report.tick) - 1,
            report.metrics.estimate_error_m,
            report.metrics.odometry_error_m,
        )
    }

    fn facts(&self) -> Vec<Fact> {
        let report = self.now();
        let of = |value: &dyn Fn(&TickReport) -> f64| report.map_or(f64::NAN, value);
        // The start is known: nothing is off there.
        let error = |value: &dyn Fn(&TickReport) -> f64| report.map_or(0.0, value);
        let matched = |value: fn(&MatchSummary) -> f64| of(&|r| value(&r.registration.matched));
        let disagreement = |r: &TickReport| r.metrics.map_disagreement_m.unwrap_or(f64::NAN);
        let mut facts = vec![
            Fact::metres("tau_m", "threshold τ", of(&|r| r.registration.tau_m)),
            Fact::count("pairs", "pairs", matched(|found| found.inliers as f64)),
            Fact::metres("rmse_m", "rmse", matched(|found| found.rmse_m)),
            Fact::count(
                "iterations",
                "iterations",
                matched(|found| found.iterations as f64),
            ),
        ];
        facts.extend(self.grid.facts());
        facts.extend([
            Fact::metres(
                "estimate_error_m",
                "estimate off by",
                error(&|r| r.metrics.estimate_error_m),
            ),
            Fact::metres(
                "odometry_error_m",
                "odometry off by",
                error(&|r| r.metrics.odometry_error_m),
            ),
            Fact::metres("map_disagreement_m", "map disagreement", of(&disagreement)),
        ]);
        facts
    }
}
