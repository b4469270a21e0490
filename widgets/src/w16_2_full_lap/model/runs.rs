//! The laps of the settings: the front end alone, and with its loops.

use std::sync::Arc;

use ch16_lab::lap::{
    BuiltInWorld, Drive, LapConfig, LapRecord, LapSummary, LoopJudgement, NamedChoice as _,
    OwnLoop, OwnLoopError, OwnLoopRequest, RecordedLoopAttempt,
};
use ch16_slam2d::loops::LoopConfig;
use pr_geom::SE2;
use pr_sim::World;

use super::gates::Gates;
use super::track::Track;

/// A drive with both estimators' laps, and the errors over time.
pub struct Runs {
    config: LapConfig,
    place: Option<BuiltInWorld>,
    /// The name of the reader's function that drove; `None` is ours.
    pub driver: Option<&'static str>,
    drive: Arc<Drive>,
    /// Of each attempt in `graph`, in order.
    gates: Vec<Gates>,
    /// The front end alone, without loop closure.
    pub front_end: Track,
    /// The pose graph, with loops if they are on.
    pub graph: Track,
    /// Position error of dead reckoning after each tick, m; the start first.
    pub odometry_errors_m: Vec<f64>,
}

/// The results table of a lap.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ResultsTable {
    /// The front end alone.
    pub front_end: LapSummary,
    /// The pose graph with its loops.
    pub graph: LapSummary,
    /// Loops that were closed.
    pub loops: usize,
}

impl Runs {
    /// Derives the series of the plots from a lap's record.
    pub fn new(record: LapRecord) -> Self {
        let LapRecord {
            config,
            drive,
            lap,
            front_end,
        } = record;
        let errors = lap
            .reports
            .iter()
            .map(|report| report.metrics.odometry_error_m);
        let start = config.drive.start;
        let gates = lap
            .loop_attempts()
            .map(|attempt| Gates::new(&lap, attempt, &config.slam.chapter.loops))
            .collect();
        Self {
            odometry_errors_m: core::iter::once(0.0).chain(errors).collect(),
            front_end: Track::new(front_end, start),
            graph: Track::new(lap, start),
            gates,
            place: place(&config),
            driver: None,
            config,
            drive,
        }
    }

    /// The walls.
    pub fn world(&self) -> &World {
        &self.config.drive.world
    }

    /// The built-in world; `None` for the reader's own.
    pub fn place(&self) -> Option<BuiltInWorld> {
        self.place
    }

    /// `the Apartment`.
    pub fn place_label(&self) -> &'static str {
        self.place.map_or("your own flat", |world| world.label())
    }

    /// Ticks of the lap.
    pub fn ticks(&self) -> usize {
        self.drive.ticks().len()
    }

    /// The settings of loop detection.
    pub fn loop_config(&self) -> &LoopConfig {
        &self.config.slam.chapter.loops
    }

    /// Threshold of the squared innovation.
    pub fn gate_chi2(&self) -> f64 {
        self.config.slam.chapter.loops.gate_chi2
    }

    /// Both gates for an attempt of the pose graph.
    ///
    /// # Panics
    /// If the attempt belongs to another lap.
    pub fn gates(&self, attempt: &RecordedLoopAttempt) -> &Gates {
        let attempts = self.graph.attempts();
        let index = attempts.partition_point(|other| other.tick < attempt.tick);
        &self.gates[index]
    }

    /// The attempts to close a loop in the first ticks, in order.
    pub fn attempts_until(&self, tick: usize) -> &[RecordedLoopAttempt] {
        let all = self.graph.attempts();
        &all[..all.partition_point(|attempt| attempt.tick <= tick)]
    }

    /// Number of closed loops after that many ticks that are wrong by the truth.
    pub fn false_loops_until(&self, tick: usize) -> usize {
        let lap = self.graph.lap();
        let attempts = self.attempts_until(tick).iter();
        let judgements = attempts.map(|attempt| lap.judge(attempt));
        judgements
            .filter(|judgement| *judgement == LoopJudgement::FalseAcceptance)
            .count()
    }

    /// Adds a custom loop to the graph.
    pub fn own_loop(&self, request: &OwnLoopRequest) -> Result<OwnLoop, OwnLoopError> {
        self.graph
            .lap()
            .own_loop(request, &self.drive, &self.config)
    }

    /// Both gates for a custom loop.
    pub fn gates_of_own(&self, own: &OwnLoop) -> Gates {
        let mut graph = self.graph.lap().graph(own.request.tick);
        Gates::on(&mut graph, &own.attempt, self.loop_config())
    }

    /// True pose after that many ticks, world frame.
    pub fn truth(&self, tick: usize) -> SE2 {
        self.drive.truth(tick)
    }

    /// Odometry composed from the start, after that many ticks, world frame.
    pub fn dead_reckoning(&self, tick: usize) -> SE2 {
        match tick.checked_sub(1) {
            Some(index) => self.drive.ticks()[index].dead_reckoning,
            None => self.config.drive.start,
        }
    }

    /// The thinned sweep of a keyframe of the graph, seen from `frame_from_body`.
    pub fn sweep_at(&self, node: usize, frame_from_body: SE2) -> impl Iterator<Item = [f64; 2]> {
        let cloud = &self.drive.sweep(self.graph.keyframe_tick(node)).cloud;
        let rotation = frame_from_body.rotation();
        cloud.iter().map(move |point| {
            let (x, y) = rotation.rotate(point.x, point.y);
            [x + frame_from_body.x(), y + frame_from_body.y()]
        })
    }

    /// Whether the robot revisits known locations after that many ticks.
    pub fn is_way_back(&self, tick: usize) -> bool {
        let reached = self.config.drive.turn;
        let mut ticks = self.drive.ticks().iter();
        let turn = ticks.position(|tick| reached.is_some() && tick.reached == reached);
        turn.is_some_and(|turn| tick > turn)
    }

    /// The results table as of a tick.
    pub fn results_at(&self, tick: usize) -> ResultsTable {
        ResultsTable {
            front_end: self.front_end.lap().summary_at(tick),
            graph: self.graph.lap().summary_at(tick),
            loops: self.graph.lap().graph_summary_at(tick).loops,
        }
    }

    /// The results table of every tick, the start first.
    pub fn results_over_time(&self) -> Vec<ResultsTable> {
        (0..=self.ticks())
            .map(|tick| self.results_at(tick))
            .collect()
    }
}

/// The built-in world with these walls.
fn place(config: &LapConfig) -> Option<BuiltInWorld> {
    let mut all = BuiltInWorld::all();
    all.find(|place| place.course().world() == &*config.drive.world)
}
