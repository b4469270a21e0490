//! The record of a finished lap for a timeline: any tick can be shown without running the lap again.
//!
//! No node moves between two accepted loops, so the poses of all nodes are stored once per such epoch; the
//! poses at a tick are the first few of its epoch.

use nalgebra::Matrix3;
use pr_geom::SE2;
use serde::{Deserialize, Serialize};

use super::report::{RecordedKeyframe, RecordedLoopAttempt, RecordedWindowScan, TickReport};
use super::{Drive, Lap, LapConfig, LoopClosure};
use ch16_slam2d::graph::EdgeKind;
use ch16_slam2d::metrics::{position_error_m, rms};

/// Number of last keyframes whose range of errors the results table shows.
pub const LAST_KEYFRAMES: usize = 9;

/// An edge of the graph and the tick that added it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RecordedEdge {
    /// The tick, counted from 1.
    pub tick: usize,
    /// The node in whose frame it was measured.
    pub from: usize,
    /// The node that was measured.
    pub to: usize,
    /// Pose of `to` in the frame of `from`.
    pub measurement: SE2,
    /// Its information, 3×3, translation first.
    pub information: Matrix3<f64>,
    /// Odometry or loop.
    pub kind: EdgeKind,
}

/// The poses of all nodes between two accepted loops.
#[derive(Clone, Debug, PartialEq)]
pub struct Epoch {
    /// The first tick at whose end these poses are valid; 0 is the start.
    pub first_tick: usize,
    /// The pose of every node that exists at the end of the epoch, `world_from_body`.
    pub poses: Vec<SE2>,
}

/// The history of one estimator.
#[derive(Clone, Debug, PartialEq)]
pub struct LapTrace {
    /// Reports of all ticks; tick t is at index t − 1.
    pub reports: Vec<TickReport>,
    /// Keyframes in order; node k is keyframe k.
    pub keyframes: Vec<RecordedKeyframe>,
    /// Edges in the order in which they were added.
    pub edges: Vec<RecordedEdge>,
    /// Epochs in order; one more than accepted loops.
    pub epochs: Vec<Epoch>,
    /// Newest node at the start of the return path.
    pub turn_node: Option<usize>,
    /// The rows of the results table.
    pub summary: LapSummary,
    /// Its loops and its graph.
    pub graph_summary: GraphSummary,
}

/// The rows of the chapter's results table, which every estimator has.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct LapSummary {
    /// Ticks of the lap.
    pub ticks: usize,
    /// Keyframes.
    pub keyframes: usize,
    /// Position error of dead reckoning at the end, m.
    pub odometry_end_error_m: f64,
    /// Root mean square position error of dead reckoning over the ticks, m.
    pub odometry_rms_m: f64,
    /// Position error of the last keyframe, m.
    pub keyframe_end_error_m: f64,
    /// Root mean square position error of the keyframes, m.
    pub keyframe_rms_m: f64,
    /// Largest position error of a keyframe, m.
    pub keyframe_max_m: f64,
    /// Smallest and largest position error of the last nine keyframes, m.
    pub last_keyframes_m: (f64, f64),
    /// Map self-disagreement, m.
    pub map_disagreement_m: Option<f64>,
}

/// What only an estimator with a pose graph has.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct GraphSummary {
    /// Attempts to close a loop that had a candidate.
    pub loop_attempts: usize,
    /// Loops that were closed.
    pub loops: usize,
    /// χ² of the graph.
    pub chi2: f64,
}

impl LapTrace {
    /// Number of nodes that exist at the end of `tick`; 0 is the start.
    #[must_use]
    pub fn node_count(&self, tick: usize) -> usize {
        self.keyframes
            .partition_point(|keyframe| keyframe.tick <= tick)
    }

    /// Poses of all nodes at the end of `tick`, `world_from_body`.
    #[must_use]
    pub fn poses(&self, tick: usize) -> &[SE2] {
        let epoch = self
            .epochs
            .partition_point(|epoch| epoch.first_tick <= tick)
            - 1;
        &self.epochs[epoch].poses[..self.node_count(tick)]
    }

    /// Edges that exist at the end of `tick`.
    #[must_use]
    pub fn edges(&self, tick: usize) -> &[RecordedEdge] {
        let count = self.edges.partition_point(|edge| edge.tick <= tick);
        &self.edges[..count]
    }

    /// The report of `tick`, counted from 1; `None` at the start.
    #[must_use]
    pub fn report(&self, tick: usize) -> Option<&TickReport> {
        self.reports.get(tick.checked_sub(1)?)
    }

    /// All attempts to close a loop, in order.
    pub fn loop_attempts(&self) -> impl Iterator<Item = &RecordedLoopAttempt> {
        self.reports
            .iter()
            .filter_map(|report| report.loop_attempt.as_ref())
    }

    /// Poses before and after the loop that was closed in `tick`; `None` if there was none.
    ///
    /// Both have the same nodes, for an animation between them.
    /// Both have the same nodes: an animation goes from one to the other.
    #[must_use]
    pub fn loop_motion(&self, tick: usize) -> Option<(&[SE2], &[SE2])> {
        let after = self
            .epochs
            .iter()
            .position(|epoch| epoch.first_tick == tick)?;
        let nodes = self.node_count(tick);
        let before = &self.epochs[after.checked_sub(1)?];
        Some((&before.poses[..nodes], &self.epochs[after].poses[..nodes]))
    }

    /// Position errors of all keyframes at the poses of the end of `tick`, m.
    pub fn keyframe_errors_m(&self, tick: usize) -> impl Iterator<Item = f64> + '_ {
        self.poses(tick)
            .iter()
            .zip(&self.keyframes)
            .map(|(pose, keyframe)| position_error_m(pose, &keyframe.truth))
    }

    /// The summary at the end of `tick`; that of the last tick is the lap's.
    #[must_use]
    pub fn summary_at(&self, tick: usize) -> LapSummary {
        let errors: Vec<f64> = self.keyframe_errors_m(tick).collect();
        LapSummary::so_far(&errors, self.reports_until(tick))
    }

    /// Loops and graph at the end of `tick`.
    #[must_use]
    pub fn graph_summary_at(&self, tick: usize) -> GraphSummary {
        GraphSummary::so_far(self.reports_until(tick))
    }

    fn reports_until(&self, tick: usize) -> &[TickReport] {
        &self.reports[..tick.min(self.reports.len())]
    }

    /// The sweeps of the local map on which the sweep of `tick` was registered, oldest first.
    #[must_use]
    pub fn window(&self, tick: usize, config: &LapConfig) -> Vec<RecordedWindowScan> {
        let joined = |taken: &usize| {
            self.report(*taken)
                .is_none_or(|report| report.registration.joined_window)
        };
        let mut taken: Vec<usize> = (0..tick)
            .rev()
            .filter(joined)
            .take(config.slam.window_scans)
            .collect();
        taken.reverse();
        taken
            .into_iter()
            .map(|taken| RecordedWindowScan {
                tick: taken,
                pose: self.window_pose(taken, tick, config),
            })
            .collect()
    }

    /// Pose of sweep `taken` in the window of `tick`, corrected by the loops in between.
    fn window_pose(&self, taken: usize, tick: usize, config: &LapConfig) -> SE2 {
        let start = self
            .report(taken)
            .map_or(config.drive.start, |report| report.estimate);
        self.reports[taken..tick - 1]
            .iter()
            .filter_map(|report| report.loop_attempt?.effect)
            .fold(start, |pose, effect| effect.correction * pose)
    }
}

/// A lap under way that records what [`LapTrace`] needs.
#[derive(Clone)]
pub(super) struct Recorder {
    lap: Lap,
    reports: Vec<TickReport>,
    epochs: Vec<Epoch>,
    has_branched: bool,
}

/// A recorded tick.
pub(super) struct Recorded {
    /// The copy without loops, if it branched off in this tick.
    pub front_end_alone: Option<Box<Recorder>>,
}

impl Recorder {
    pub(super) fn new(lap: Lap) -> Self {
        Self {
            reports: Vec::with_capacity(lap.drive().ticks().len()),
            lap,
            epochs: vec![Epoch {
                first_tick: 0,
                poses: Vec::new(),
            }],
            has_branched: false,
        }
    }

    /// Processes one tick; `None` once the lap is finished.
    ///
    /// Just before the first loop closure a copy branches off. It continues without loops, so the front end
    /// alone does not have to start over.
    pub(super) fn step(&mut self) -> Option<Recorded> {
        let mut pending = self.lap.begin()?;
        self.lap.slam.verify_loops(&mut pending);
        let mut front_end_alone = None;
        if pending.has_loop() && !self.has_branched {
            self.has_branched = true;
            let mut alone = self.clone();
            alone.lap.slam.set_loop_closure(LoopClosure::Off);
            let report = alone.lap.finish(pending.clone().without_loops());
            alone.reports.push(report);
            front_end_alone = Some(Box::new(alone));
        }
        self.lap.slam.close_loop(&mut pending);
        if let Some(poses_before) = pending.poses_before_loop() {
            self.end_epoch(poses_before.to_vec());
        }
        let report = self.lap.finish(pending);
        self.reports.push(report);
        Some(Recorded { front_end_alone })
    }

    /// Stores the poses before an optimization changed them.
    fn end_epoch(&mut self, poses: Vec<SE2>) {
        self.store_poses(poses);
        self.epochs.push(Epoch {
            first_tick: self.lap.tick(),
            poses: Vec::new(),
        });
    }

    fn store_poses(&mut self, poses: Vec<SE2>) {
        if let Some(epoch) = self.epochs.last_mut() {
            epoch.poses = poses;
        }
    }

    /// The trace so far.
    pub(super) fn into_trace(mut self) -> LapTrace {
        self.store_poses(self.lap.graph().poses().to_vec());
        let lap = &self.lap;
        let keyframes: Vec<RecordedKeyframe> = lap.keyframes().collect();
        let edges = lap.graph().edges().map(|view| {
            let (from, to) = (view.from.index(), view.to.index());
            RecordedEdge {
                tick: keyframes[from.max(to)].tick,
                from,
                to,
                measurement: view.edge.measurement,
                information: view.edge.information,
                kind: view.edge.kind,
            }
        });
        LapTrace {
            edges: edges.collect(),
            turn_node: lap.turn_node(),
            summary: LapSummary::from_lap(lap, &self.reports),
            graph_summary: GraphSummary::so_far(&self.reports),
            keyframes,
            reports: self.reports,
            epochs: self.epochs,
        }
    }
}

impl LapSummary {
    /// The summary of a lap: its present state and the reports of its ticks.
    #[must_use]
    pub fn from_lap(lap: &Lap, reports: &[TickReport]) -> Self {
        Self::so_far(&lap.keyframe_errors_m().collect::<Vec<_>>(), reports)
    }

    /// Computes it from the position errors of the keyframes so far, m, and the reports so far.
    fn so_far(errors: &[f64], reports: &[TickReport]) -> Self {
        let metrics = reports.last().map(|report| report.metrics);
        let odometry_m = metrics.map_or([0.0; 2], |m| [m.odometry_error_m, m.odometry_rms_m]);
        let disagreement_m = metrics.and_then(|m| m.map_disagreement_m);
        Self::from_errors(reports.len(), odometry_m, errors, disagreement_m)
    }

    /// The summary of so many ticks: error of dead reckoning at the end and its root mean square, position errors of the
    /// keyframes, and self-disagreement of the map, m.
    pub(crate) fn from_errors(
        ticks: usize,
        [odometry_end_error_m, odometry_rms_m]: [f64; 2],
        errors: &[f64],
        map_disagreement_m: Option<f64>,
    ) -> Self {
        let last = &errors[errors.len().saturating_sub(LAST_KEYFRAMES)..];
        let largest = |errors: &[f64]| errors.iter().copied().fold(0.0, f64::max);
        Self {
            ticks,
            keyframes: errors.len(),
            odometry_end_error_m,
            odometry_rms_m,
            keyframe_end_error_m: errors.last().copied().unwrap_or(0.0),
            keyframe_rms_m: rms(errors.iter().copied()),
            keyframe_max_m: largest(errors),
            last_keyframes_m: (
                last.iter().copied().fold(f64::INFINITY, f64::min),
                largest(last),
            ),
            map_disagreement_m,
        }
    }
}

impl GraphSummary {
    /// Computes it from the reports so far.
    fn so_far(reports: &[TickReport]) -> Self {
        let attempts = || reports.iter().filter_map(|report| report.loop_attempt);
        Self {
            loop_attempts: attempts().count(),
            loops: attempts().filter(RecordedLoopAttempt::accepted).count(),
            chi2: reports.last().map_or(0.0, |report| report.metrics.chi2),
        }
    }
}

/// A finished lap: everything that was driven and estimated.
#[derive(Clone, Debug, PartialEq)]
pub struct LapRecord {
    /// The parameters.
    pub config: LapConfig,
    /// Truth, odometry and sweeps.
    pub drive: std::sync::Arc<Drive>,
    /// The lap as configured.
    pub lap: LapTrace,
    /// The front end alone on the same drive; equals `lap` if no loop was closed.
    pub front_end: LapTrace,
}

impl LapRecord {
    /// Number of ticks.
    #[must_use]
    pub fn ticks(&self) -> usize {
        self.drive.ticks().len()
    }
}
