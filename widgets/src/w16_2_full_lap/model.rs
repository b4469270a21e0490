//! The state of the widget: parameters, the laps that follow from them, playback and animation.
//!
//! A parameter that changes the lap requests a new one. The newest request is computed in pieces. Meanwhile
//! the old lap stays on screen, and so does the current tick.
//!
//! # Computed
//!
//! The estimator (`ch16_slam2d::slam`) on the frames of a simulated drive, once as chosen and once by its front end alone,
//! tick by tick. Errors compare it with the simulator's truth, which it does not see. The thousand laps of the page are
//! runs of the same code with other seeds.
//!
//! # Numbers
//!
//! World, laser and odometry: `crates/core/pr_sim`; the estimator: `SlamConfig::chapter`.
//!
//! # Simplified
//!
//! Walls are straight, opaque and at rest. A beam has one normal error, and never a second return. Odometry has
//! independent normal errors in each step, and no slip. The driver follows waypoints and never reacts to the map.

mod drawing;
pub(super) mod floor_plan;
mod found;
mod gates;
mod graph_tools;
mod grid;
mod interaction;
mod moment;
mod own;
mod panel;
mod pick;
mod picture;
mod plan_element;
mod runs;
mod settings;
mod tables;
mod texts;
mod track;
mod transition;
mod your_code;

use ch16_lab::lap::{LapRecord, NewestLap, NewestStep, OwnLoopError, RecordedLoopAttempt};
use pr_sim::{Course, Sketch};
use widget_kit::chart::{dragged_to, grab_now};
use widget_kit::disclosure::Disclosure;
use widget_kit::host_messages::Delivery;
use widget_kit::model::{
    Activity, Handle, Model, Motion, Outcome, Table, Timeline, TimelineMark, press_preset,
};
use widget_kit::param::ParamError;
use widget_kit::playback::Playback;
use widget_kit::playback::SPEED;
use widget_kit::scene::Scene;
use widget_kit::spec::PLAY;
use widget_kit::spec::WidgetSpec;
use widget_kit::values::{Changed, Values};

use crate::reader_orders::Orders;
use crate::w16_2_full_lap::spec::{
    EDIT, EDIT_FLAT, EDITING, FLAT_CONTROLS, FLAT_KEYS, FUTURE, SHOW, SPEC, TICK, WIPE, WORLD,
};
use floor_plan::FloorPlan;
use moment::LapState;
use own::Own;
use pick::{GraphPart, PickDirection};
use runs::{ResultsTable, Runs};
use transition::Transition;

pub use settings::lap_of_link;

/// Ticks a second at speed 1: twice as fast as the robot.
const TICKS_PER_S: f64 = 8.0;

/// The model of the widget.
pub struct FullLap {
    values: Values,
    /// The laps on screen.
    runs: Runs,
    /// The laps under way.
    laps: NewestLap,
    /// Buttons that wait for the lap they were pressed for.
    pressed: Vec<&'static str>,
    /// The results of the chapter's run after each tick.
    canonical: Vec<ResultsTable>,
    playback: Playback,
    transition: Option<Transition>,
    own: Own,
    floor_plan: FloorPlan,
    hovered: Option<GraphPart>,
    /// Orders to the reader's function, if it drives.
    yours: Option<Orders>,
}

impl Default for FullLap {
    /// The chapter's run, at its first loop.
    ///
    /// # Panics
    /// Never: a requested lap ends.
    fn default() -> Self {
        let values = Values::defaults(SPEC.params);
        let mut laps = NewestLap::new();
        let config = settings::read(&values).config(None);
        laps.ask(config.expect("the Apartment can be driven"));
        let runs = Runs::new(*laps.finish().expect("a lap was asked for"));
        Self {
            canonical: runs.results_over_time(),
            values,
            runs,
            laps,
            pressed: Vec::new(),
            playback: Playback::default(),
            transition: None,
            own: Own::default(),
            floor_plan: FloorPlan::new(Sketch::from_course(&Course::apartment())),
            hovered: None,
            yours: None,
        }
    }
}

impl FullLap {
    /// The current tick of the lap on screen, which may be older than the requested one.
    fn tick(&self) -> usize {
        (self.values.get(&TICK) as usize).min(self.runs.ticks())
    }

    fn last(&self) -> f64 {
        self.runs.ticks() as f64
    }

    /// Goes to a tick; if a loop was closed in it, the nodes move from old to new.
    fn go_to(&mut self, tick: usize) {
        let tick = (tick as f64).min(self.last());
        self.values.put(&TICK, tick);
        self.hovered = None;
        self.own.refresh(&self.values, &self.runs, tick as usize);
        // A custom loop is already closed while time advances.
        if self.own.tried().is_none() {
            self.animate();
        } else {
            self.transition = None;
        }
    }

    /// Starts the animation of the nodes if a loop was closed.
    fn animate(&mut self) {
        let attempt = self.runs.graph.attempt_at(self.tick());
        let own = self.own.tried().map(|own| &own.attempt);
        let closed = own.or(attempt).is_some_and(RecordedLoopAttempt::accepted);
        self.transition =
            (closed && self.playback.motion() == Motion::Full).then(Transition::default);
    }

    fn back_to_defaults(&mut self) {
        let before = self.values.get(&WORLD);
        self.values.reset();
        if before != self.values.get(&WORLD) {
            self.world_chosen(before);
        }
        self.end_stroke();
        self.floor_plan.follows = false;
        self.playback.pause();
        self.transition = None;
        self.pressed.clear();
        self.own.forget();
        self.hovered = None;
        self.recompute();
    }

    /// Requests the lap of the settings, unless it is on screen; a custom flat that cannot be driven requests
    /// none.
    fn recompute(&mut self) {
        let Some(config) = settings::read(&self.values).config(self.own_course()) else {
            return;
        };
        let task = self.task();
        match &mut self.yours {
            Some(orders) => orders.want(task),
            None => self.laps.ask(config),
        }
    }

    /// Shows a finished lap and executes what waited for it.
    fn show(&mut self, record: LapRecord) {
        self.runs = Runs::new(record);
        self.runs.driver = self.yours.as_ref().map(|orders| orders.function.name());
        self.hovered = None;
        if self.values.get(&TICK) > self.last() && !self.laps.is_running() {
            self.go_to(self.runs.ticks());
        }
        if self.floor_plan.follows && !self.laps.is_running() {
            self.floor_plan.follows = false;
            self.go_to(self.runs.ticks());
        }
        self.own.refresh(&self.values, &self.runs, self.tick());
        self.transition = None;
        if !self.laps.is_running() {
            for button in core::mem::take(&mut self.pressed) {
                self.press_loop(button);
            }
        }
    }

    /// Advances the playback; stops for the animation of every loop on the way.
    fn play(&mut self, elapsed_s: f64) {
        let now = self.tick() as f64;
        let rate = TICKS_PER_S * self.values.get(&SPEED);
        let reached = self.playback.advance(now, self.last(), elapsed_s, rate) as usize;
        let ahead =
            |attempt: &&RecordedLoopAttempt| attempt.tick > now as usize && attempt.tick < reached;
        let stop = self.runs.graph.attempts().iter().find(ahead);
        let target = stop.map_or(reached, |attempt| attempt.tick);
        if target < reached && !self.playback.is_playing() {
            // The end was within this frame, but the loop comes first: continue playing from there.
            self.playback.toggle(target as f64, self.last());
        }
        if target as f64 != now {
            self.go_to(target);
        }
    }

    /// The last tick that plots and tables show.
    fn seen_until(&self) -> usize {
        if self.values.get(&FUTURE) {
            self.runs.ticks()
        } else {
            self.tick()
        }
    }

    fn moment(&self) -> LapState<'_> {
        let share = self.transition.as_ref().map_or(1.0, Transition::share);
        let seen_until = self.seen_until();
        let own = self.own.tried();
        LapState {
            picked: GraphPart::chosen(&self.values),
            hovered: self.hovered,
            tied: self.own.tied,
            wipe: self.values.get(&WIPE),
            layers: self.values.get(&SHOW),
            drawn: drawing::drawn(self),
            ..LapState::new(&self.runs, self.tick(), share, seen_until, own)
        }
    }

    fn own_rejected(&self) -> Option<&OwnLoopError> {
        self.own.made.as_ref()?.as_ref().err()
    }
}

impl Model for FullLap {
    fn spec(&self) -> &'static WidgetSpec {
        &SPEC
    }

    fn values(&self) -> &Values {
        &self.values
    }

    fn disclosure(&self) -> Disclosure {
        match (
            Disclosure::visible(SPEC.opening, &self.values),
            self.values.get(&EDIT),
        ) {
            (Disclosure::First(_), Some(_)) => Disclosure::First(EDITING),
            (Disclosure::All, None) => Disclosure::AllBut(&FLAT_CONTROLS),
            (layer, _) => layer,
        }
    }

    fn set(&mut self, id: &str, value: f64) -> Result<(), ParamError> {
        if id == "flat" && value == 0.0 {
            return self.set_flat("");
        }
        let before = self.values.clone();
        if self.values.set(SPEC.id, id, value)? == Changed::No {
            return Ok(());
        }
        match id {
            // A lap under way may be longer than the one on screen.
            "t" if self.laps.is_running() && value > self.last() => self.refresh_own(),
            "t" => self.go_to(self.tick()),
            "speed" | "more" | "future" | "pick" | "number" | "wipe" | "show" => {}
            "world" => self.world_chosen(before.get(&WORLD)),
            "edit" | "piece" | "piece-number" => {
                self.end_stroke();
                self.floor_plan.note = None;
            }
            _ if own::PARAMS.contains(&id) => {
                self.own.keep(&before);
                self.refresh_own();
            }
            _ => self.recompute(),
        }
        Ok(())
    }

    fn set_text(&mut self, id: &str, text: &str) -> Result<(), ParamError> {
        if id == "flat" {
            return self.set_flat(text);
        }
        let (param, _) = self.values.find_for(SPEC.id, id)?;
        let value = param.parse(text)?;
        self.set(id, value)
    }

    fn press(&mut self, id: &str) -> Result<(), ParamError> {
        if id == PLAY.id && self.own.is_dragged() {
            // The lap goes on without the loop that was dragged, and the words are about the lap again.
            self.undo();
            self.own.let_go();
        }
        let now = self.tick() as f64;
        if let Some(position) = self.playback.press(id, now, self.last()) {
            if position != now {
                self.go_to(position as usize);
            }
            return Ok(());
        }
        if self.press_loop(id) || self.press_flat(id) {
            return Ok(());
        }
        match id {
            "one-back" => self.look_on(PickDirection::Back),
            "one-on" => self.look_on(PickDirection::On),
            "tie" => self.press_tie(),
            "undo" => self.undo(),
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

    /// Processes one tick of the lap under way.
    fn work(&mut self) -> Activity {
        match self.laps.step() {
            NewestStep::Idle => Activity::Idle,
            NewestStep::Tick => Activity::BusyUnchanged,
            NewestStep::Finished(record) => {
                self.show(*record);
                Activity::Busy
            }
        }
    }

    fn settle(&mut self) -> Activity {
        self.laps.drop_outdated();
        self.work()
    }

    fn scene(&self) -> Scene {
        picture::scene(&self.moment())
    }

    fn outcome(&self) -> Outcome {
        texts::outcome(&self.moment(), self.own_rejected())
    }

    fn summary(&self) -> String {
        texts::summary(&self.moment())
    }

    fn timeline(&self) -> Option<Timeline> {
        let lap = self.runs.graph.lap();
        let mark = |attempt: &RecordedLoopAttempt| TimelineMark {
            at: attempt.tick as f64,
            label: lap.loop_headline(attempt),
            standing: texts::standing(lap.judge(attempt)),
        };
        Some(Timeline {
            param: "t",
            last: self.last(),
            playing: self.playback.is_playing(),
            marks: self
                .runs
                .attempts_until(self.seen_until())
                .iter()
                .map(mark)
                .collect(),
        })
    }

    fn is_pressed(&self, button: &str) -> bool {
        let is_editing = self.values.get(&EDIT).is_some();
        (button == EDIT_FLAT.id && is_editing) || (button == PLAY.id && self.playback.is_playing())
    }

    fn tables(&self) -> Vec<Table> {
        let mut tables = tables::all(&self.runs, self.seen_until(), &self.canonical);
        tables.push(tables::edges(&self.moment()));
        tables
    }

    fn shown_tables(&self) -> Vec<Table> {
        tables::shown(&self.runs, self.seen_until(), &self.canonical)
    }

    /// The line at the current tick, in every plot over time; on the map, the selected keyframe.
    fn grab(&self, panel: &str, at: [f64; 2], reach: [f64; 2]) -> Option<Handle> {
        if let Some(tool) = self.tool_on(panel) {
            return self.grab_flat(tool, at, reach);
        }
        if let Some(handle) = interaction::grab(&self.moment(), panel, at, reach) {
            return Some(handle);
        }
        let panel = *picture::OVER_TIME.iter().find(|id| **id == panel)?;
        grab_now(panel, self.values.get(&TICK), at, reach)
    }

    fn drag(&mut self, handle: Handle, at: [f64; 2]) {
        if self.stroke(handle, at) {
            return;
        }
        if let Some(share) = interaction::dragged_wipe(&self.moment(), handle, at) {
            self.values.put(&WIPE, share);
            return;
        }
        if handle.panel == panel::MAP {
            let ends = interaction::dragged_ends(&self.moment(), handle, at);
            if let Some(ends) = ends.filter(|ends| !self.own.is_between(&self.values, *ends)) {
                if self.own.drag_from(ends[0]) {
                    self.own.keep(&self.values);
                }
                self.tie(ends);
                // The words are about the loop, not about a keyframe.
                self.look_at(None);
                // During a drag the graph follows at once.
                self.transition = None;
            }
            return;
        }
        let tick = dragged_to(handle, at) as usize;
        if tick != self.tick() {
            self.go_to(tick);
        }
    }

    fn release(&mut self) {
        self.end_stroke();
    }

    /// Selects the tapped part, or nothing if there is none. A second keyframe ends a custom loop.
    fn tap(&mut self, panel: &str, at: [f64; 2], reach: [f64; 2]) {
        if let Some(tool) = self.tool_on(panel) {
            self.tap_flat(tool, at, reach);
            return;
        }
        self.own.let_go();
        if ![panel::MAP, panel::STRAIN, panel::GATE].contains(&panel) {
            return;
        }
        let part = interaction::part_at(&self.moment(), panel, at, reach);
        self.look_at(part);
        if self.own.tied.is_some() && matches!(part, Some(GraphPart::Keyframe(_))) {
            self.press_tie();
        }
    }

    fn hover(&mut self, panel: &str, at: Option<[f64; 2]>) {
        self.own.let_go();
        if self.tool_on(panel).is_some() {
            self.hovered = None;
            return;
        }
        self.hovered = at.and_then(|at| interaction::hovered(&self.moment(), panel, at));
    }

    fn receive(&mut self, delivery: &Delivery<'_>) {
        if delivery.kind == "text-file" {
            self.open_flat(delivery.text, delivery.bytes);
        } else {
            self.take_from_worker(delivery);
        }
    }

    fn keys(&self) -> &'static [(&'static str, &'static str)] {
        FLAT_KEYS
    }

    fn take_requests(&mut self) -> Vec<String> {
        let mut orders = core::mem::take(&mut self.floor_plan.orders);
        orders.extend(self.yours.iter_mut().flat_map(Orders::take));
        orders
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
