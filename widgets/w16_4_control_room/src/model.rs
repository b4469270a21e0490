//! The state of the control room: one recorded run, the tick shown, its grid and registration.
//!
//! A parameter of the run computes all of it again at once; the moment shown stays.

mod history;
mod log;
mod picture;
mod words;

use ch16_slam2d::graph::EdgeKind;
use ch16_slam2d::slam::{LapRecord, LapRunner, RegistrationView, SlamConfig, SlamReport};
use kit::model::{
    Activity, Fact, Model, Outcome, Standing, Table, Timeline, apply_preset, unknown_button,
};
use kit::param::{Changed, ParamError, Values};
use kit::playback::{Playback, speed_factor};
use kit::scene::{Raster, Scene};
use kit::spec::{DEFAULTS, PLAY, RESET, STEP, WidgetSpec};
use pr_grid::OccupancyGrid;
use pr_sim::World;

pub use words::{NEXT_EVENT, SPEC};

use history::History;
use log::Event;

/// Ticks a second at speed 1: twice as fast as the robot.
const TICKS_PER_S: f64 = 8.0;

/// There is a keyframe at any tick, so no grid is drawn from none.
const NOTHING_DRAWN: (usize, usize) = (0, 0);

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
    grid: OccupancyGrid,
    /// What the grid was drawn from: keyframes, and loops closed before.
    drawn: (usize, usize),
    raster: Raster,
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
        let grid = record.occupancy_grid(0);
        let mut room = Self {
            history: History::new(&record),
            events: log::events(&record),
            registration: None,
            raster: picture::raster(&grid, 0),
            grid,
            drawn: NOTHING_DRAWN,
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

    fn now(&self) -> Option<&SlamReport> {
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
        let source = (self.record.lap.node_count(tick), self.loops_closed());
        if source != self.drawn {
            self.drawn = source;
            self.grid = self.record.occupancy_grid(tick);
            self.raster = picture::raster(&self.grid, self.raster.revision + 1);
        }
    }

    fn run_again(&mut self) {
        self.record = self.runner.run(&config(&self.values));
        self.history = History::new(&self.record);
        self.events = log::events(&self.record);
        self.drawn = NOTHING_DRAWN;
        self.go_to(self.values.get("t"));
    }

    /// Loops closed up to the tick shown.
    fn loops_closed(&self) -> usize {
        let edges = self.record.lap.edges(self.tick()).iter();
        edges.filter(|edge| edge.kind == EdgeKind::Loop).count()
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

fn config(values: &Values) -> SlamConfig {
    let config = SlamConfig::with_seed_and_noise(values.get("seed") as u32, values.get("noise"));
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
        if id == PLAY.id {
            let position = self.playback.toggle(self.values.get("t"), self.last());
            self.go_to(position);
        } else if id == STEP.id {
            self.playback.pause();
            self.go_to(self.values.get("t") + 1.0);
        } else if id == RESET.id {
            self.playback.pause();
            self.go_to(0.0);
        } else if id == NEXT_EVENT.id {
            self.next_event();
        } else if id == DEFAULTS.id {
            self.playback.pause();
            self.values = Values::defaults(SPEC.params);
            self.run_again();
        } else if let Some(preset) = SPEC.presets.iter().find(|preset| preset.id == id) {
            apply_preset(self, preset)?;
        } else {
            return Err(unknown_button(&SPEC, id));
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
                picture::map(&self.record, now, &self.raster, &self.world),
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
        let grid = &self.grid;
        format!(
            "Occupancy grid of {} cells, {} occupied and {} free, with a pose graph of {} nodes and \
             {} loops over it. {} The newest sweep is paired with the local map by {} pairs.",
            grid.columns() * grid.rows(),
            grid.occupied_cells(),
            grid.free_cells(),
            self.record.lap.node_count(self.tick()),
            self.loops_closed(),
            self.tick_sentence(),
            self.now().map_or(0, |r| r.registration.icp.inliers),
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
        let of = |value: &dyn Fn(&SlamReport) -> f64| report.map_or(f64::NAN, value);
        let keyframes = self.record.lap.node_count(self.tick()) as f64;
        let loops = self.loops_closed() as f64;
        let disagreement = |r: &SlamReport| r.metrics.map_disagreement_m.unwrap_or(f64::NAN);
        vec![
            Fact::metres("tau_m", "threshold τ", of(&|r| r.registration.tau_m)),
            Fact::count("pairs", "pairs", of(&|r| r.registration.icp.inliers as f64)),
            Fact::metres("rmse_m", "rmse", of(&|r| r.registration.icp.rmse)),
            Fact::count(
                "iterations",
                "iterations",
                of(&|r| r.registration.icp.iterations as f64),
            ),
            Fact::count("keyframes", "keyframes", keyframes),
            // The grid is drawn again once for each loop.
            Fact::count("loops", "loops closed, grids redrawn", loops),
            Fact::count(
                "occupied_cells",
                "occupied cells",
                self.grid.occupied_cells() as f64,
            ),
            Fact::count("free_cells", "free cells", self.grid.free_cells() as f64),
            Fact::metres(
                "estimate_error_m",
                "estimate off by",
                of(&|r| r.metrics.estimate_error_m),
            ),
            Fact::metres(
                "odometry_error_m",
                "odometry off by",
                of(&|r| r.metrics.odometry_error_m),
            ),
            Fact::metres("map_disagreement_m", "map disagreement", of(&disagreement)),
        ]
    }
}
