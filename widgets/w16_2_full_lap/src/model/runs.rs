//! The laps that the settings lead to: the front end alone, and with its loops.

use std::sync::Arc;

use ch16_lab::lap::{Drive, LapConfig, LapRecord, LapSummary, LoopAttempt};
use ch16_slam2d::loops::LoopConfig;
use pr_geom::SE2;

use super::gates::Gates;
use super::track::Track;

/// A drive with both estimators that ran over it, and the errors over time.
pub struct Runs {
    config: LapConfig,
    drive: Arc<Drive>,
    /// Of each attempt of `graph`, in order.
    gates: Vec<Gates>,
    /// The front end alone: no loop is ever closed.
    pub front_end: Track,
    /// The pose graph, with loops where they are on.
    pub graph: Track,
    /// Position error of dead reckoning after each tick, m; the start first.
    pub odometry_errors_m: Vec<f64>,
}

/// The results table of a lap.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Results {
    /// The front end alone.
    pub front_end: LapSummary,
    /// The pose graph with its loops.
    pub graph: LapSummary,
}

impl Runs {
    /// What a lap's record holds, with the series of the plots.
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
            .map(|attempt| Gates::of(&lap, attempt, &config.slam.loops))
            .collect();
        Self {
            odometry_errors_m: core::iter::once(0.0).chain(errors).collect(),
            front_end: Track::new(front_end, start),
            graph: Track::new(lap, start),
            gates,
            config,
            drive,
        }
    }

    /// Ticks of the lap.
    pub fn ticks(&self) -> usize {
        self.drive.ticks().len()
    }

    /// The settings of loop detection.
    pub fn loop_config(&self) -> &LoopConfig {
        &self.config.slam.loops
    }

    /// Largest squared innovation that is believed.
    pub fn gate_chi2(&self) -> f64 {
        self.config.slam.loops.gate_chi2
    }

    /// Both gates over an attempt of the pose graph.
    ///
    /// # Panics
    /// Where the attempt is none of this lap's.
    pub fn gates(&self, attempt: &LoopAttempt) -> &Gates {
        let attempts = self.graph.attempts();
        let index = attempts.partition_point(|other| other.tick < attempt.tick);
        &self.gates[index]
    }

    /// True pose after so many ticks, world frame.
    pub fn truth(&self, tick: usize) -> SE2 {
        self.drive.truth(tick)
    }

    /// Odometry composed from the start, after so many ticks, world frame.
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

    /// Whether the robot is on its way back after so many ticks.
    pub fn is_way_back(&self, tick: usize) -> bool {
        let turn = self
            .drive
            .ticks()
            .iter()
            .position(|tick| tick.reached == Some(0));
        turn.is_some_and(|turn| tick > turn)
    }

    /// The results table.
    pub fn results(&self) -> Results {
        Results {
            front_end: *self.front_end.summary(),
            graph: *self.graph.summary(),
        }
    }
}
