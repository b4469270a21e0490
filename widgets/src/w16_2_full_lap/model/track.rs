//! One estimator's lap, with its series for the plots.

use ch16_lab::lap::{LapSummary, LapTrace, RecordedLoopAttempt, TickMetrics};
use pr_geom::SE2;

/// A finished lap of one estimator.
pub struct Track {
    start: SE2,
    trace: LapTrace,
    attempts: Vec<RecordedLoopAttempt>,
    /// Position error of the estimate after each tick, m; the start first.
    pub errors_m: Vec<f64>,
    /// Root mean square position error of the keyframes after each tick, m.
    pub keyframe_rms_m: Vec<f64>,
    /// Map self-disagreement after each tick, m; NaN before the return path.
    pub disagreement_m: Vec<f64>,
}

impl Track {
    /// Derives the series of the lap that `trace` recorded, driven from `start`.
    pub fn new(trace: LapTrace, start: SE2) -> Self {
        let series = |at_start, of: fn(&TickMetrics) -> f64| {
            let values = trace.reports.iter().map(|report| of(&report.metrics));
            core::iter::once(at_start).chain(values).collect()
        };
        Self {
            errors_m: series(0.0, |metrics| metrics.estimate_error_m),
            keyframe_rms_m: series(0.0, |metrics| metrics.keyframe_rms_m),
            disagreement_m: series(f64::NAN, |metrics| {
                metrics.map_disagreement_m.unwrap_or(f64::NAN)
            }),
            attempts: trace.loop_attempts().copied().collect(),
            start,
            trace,
        }
    }

    /// The lap as recorded.
    pub fn lap(&self) -> &LapTrace {
        &self.trace
    }

    /// The rows of the results table.
    pub fn summary(&self) -> &LapSummary {
        &self.trace.summary
    }

    /// The newest keyframe's node at the start of the return path.
    pub fn turn_node(&self) -> Option<usize> {
        self.trace.turn_node
    }

    /// Estimate after that many ticks, `world_from_body`.
    pub fn estimate(&self, tick: usize) -> SE2 {
        self.trace
            .report(tick)
            .map_or(self.start, |report| report.estimate)
    }

    /// The tick after which a keyframe was taken.
    pub fn keyframe_tick(&self, node: usize) -> usize {
        self.trace.keyframes[node].tick
    }

    /// Number of keyframes after that many ticks.
    pub fn keyframes_until(&self, tick: usize) -> usize {
        self.trace.node_count(tick)
    }

    /// Poses of the graph's nodes after that many ticks, `world_from_body`.
    pub fn poses_at(&self, tick: usize) -> &[SE2] {
        self.trace.poses(tick)
    }

    /// Poses of the graph's nodes in that tick, before its loop closure.
    pub fn poses_before_loop(&self, tick: usize) -> &[SE2] {
        match self.trace.loop_motion(tick) {
            Some((before, _)) => before,
            None => self.poses_at(tick),
        }
    }

    /// The attempts to close a loop, in order.
    pub fn attempts(&self) -> &[RecordedLoopAttempt] {
        &self.attempts
    }

    /// The attempt made in that tick.
    pub fn attempt_at(&self, tick: usize) -> Option<&RecordedLoopAttempt> {
        self.trace.report(tick)?.loop_attempt.as_ref()
    }

    /// The newest attempt made in the first `tick` ticks.
    pub fn newest_attempt(&self, tick: usize) -> Option<&RecordedLoopAttempt> {
        self.attempts.iter().rfind(|attempt| attempt.tick <= tick)
    }

    /// The attempt to which a tick belongs: the newest one up to the next tick, else the first one.
    pub fn attempt_near(&self, tick: usize) -> Option<&RecordedLoopAttempt> {
        self.newest_attempt(tick + 1).or(self.attempts.first())
    }

    /// Number of closed loops after that many ticks.
    pub fn accepted_until(&self, tick: usize) -> usize {
        let accepted = |attempt: &&RecordedLoopAttempt| attempt.accepted() && attempt.tick <= tick;
        self.attempts.iter().filter(accepted).count()
    }
}
