//! Runs laps on demand, fast enough for a dragged slider.

use std::sync::Arc;

use super::record::LapRecord;
use super::run::{LapRun, Stage};
use super::{Drive, DriveSimulation, LapConfig};
use ch16_slam2d::chapter::ChapterParts;

/// Runs laps and keeps the simulated drive between them.
///
/// A new gate or window reuses the drive. New odometry noise changes only the odometry. A new seed or sensor
/// simulates the drive again. Results do not depend on earlier runs.
#[derive(Clone, Debug, Default)]
pub struct LapRunner {
    drive: Option<Arc<Drive>>,
}

impl LapRunner {
    /// A runner without a drive.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Runs the lap of `config` and its front end alone.
    pub fn run(&mut self, config: &LapConfig) -> LapRecord {
        let mut run = self.start(config.clone());
        loop {
            if let Some(record) = run.step() {
                self.keep(&record);
                return record;
            }
        }
    }

    /// The lap of `config` with custom matchers and a custom loop detector, and its front end alone.
    #[must_use]
    pub fn run_with_parts(config: &LapConfig, parts: ChapterParts) -> LapRecord {
        let mut run = Self::new().start_with_parts(config.clone(), parts);
        loop {
            if let Some(record) = run.step() {
                return record;
            }
        }
    }

    /// Starts the same run in pieces; it reuses what is still valid of the last drive.
    #[must_use]
    pub fn start(&self, config: LapConfig) -> LapRun {
        self.begin(config, None)
    }

    /// Starts a run with custom parts in pieces.
    #[must_use]
    pub fn start_with_parts(&self, config: LapConfig, parts: ChapterParts) -> LapRun {
        self.begin(config, Some(parts))
    }

    fn begin(&self, config: LapConfig, parts: Option<ChapterParts>) -> LapRun {
        let same = |drive: &&Arc<Drive>| drive.config().differs_only_in_noise_from(&config.drive);
        let Some(drive) = self.drive.as_ref().filter(same) else {
            let simulation = DriveSimulation::new(config.drive.clone());
            return LapRun::new(config, Stage::Driving(Box::new(simulation)), parts);
        };
        let mut drive = Arc::clone(drive);
        if drive.config().noise_factor != config.drive.noise_factor {
            Arc::make_mut(&mut drive).set_noise_factor(config.drive.noise_factor);
        }
        let stage = Stage::on(&config, drive, parts);
        LapRun::new(config, stage, None)
    }

    /// Keeps the drive of a finished run for the next one.
    pub fn keep(&mut self, record: &LapRecord) {
        self.drive = Some(Arc::clone(&record.drive));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lap::Lap;

    #[test]
    fn a_lap_does_not_depend_on_what_ran_before() {
        let mut runner = LapRunner::new();
        let configs = [
            LapConfig::default(),
            LapConfig::with_seed_and_noise(6, 2.0),
            LapConfig::with_seed_and_noise(6, 1.0),
            LapConfig::default().without_loops(),
        ];
        for config in &configs {
            let fresh = LapRunner::new().run(config);
            assert_eq!(runner.run(config), fresh);
            let parts = ChapterParts::from_config(&config.slam.chapter);
            assert_eq!(LapRunner::run_with_parts(config, parts), fresh);
        }
    }

    #[test]
    fn the_front_end_alone_is_the_lap_with_loop_closure_off() {
        let both = LapRunner::new().run(&LapConfig::default());
        let alone = LapRunner::new().run(&LapConfig::default().without_loops());
        assert_eq!(both.front_end, alone.lap);
        assert_ne!(both.front_end, both.lap);
    }

    #[test]
    fn the_record_has_the_graph_of_every_tick() {
        let config = LapConfig::default();
        let record = LapRunner::new().run(&config);
        let mut lap = Lap::new(config.clone());
        assert_eq!(record.lap.poses(0), lap.graph().poses());
        while let Some(report) = lap.step() {
            assert_eq!(record.lap.report(report.tick), Some(&report));
            assert_eq!(record.lap.poses(report.tick), lap.graph().poses());
            assert_eq!(
                record.lap.edges(report.tick).len(),
                lap.graph().edge_count()
            );
            let recorded = record.lap.window(report.tick + 1, &config);
            let next_window = lap.slam().front_end().window();
            assert_eq!(recorded.len(), next_window.len());
            for (recorded, sweep) in recorded.iter().zip(next_window) {
                assert_eq!((recorded.tick, recorded.pose), (sweep.frame, sweep.pose));
            }
        }
    }

    #[test]
    fn the_last_tick_has_the_summary_of_the_lap_and_earlier_ones_only_their_past() {
        let record = LapRunner::new().run(&LapConfig::default());
        let last = record.ticks();
        assert_eq!(record.lap.summary_at(last), record.lap.summary);
        assert_eq!(record.lap.graph_summary_at(last), record.lap.graph_summary);
        let so_far = record.lap.summary_at(91);
        assert_eq!(so_far.ticks, 91);
        assert_eq!(record.lap.graph_summary_at(91).loops, 0);
        assert_eq!(so_far, record.front_end.summary_at(91));
    }

    #[test]
    fn the_motion_of_a_loop_starts_where_the_graph_was_and_ends_where_it_is() {
        let lap = LapRunner::new().run(&LapConfig::default()).lap;
        for attempt in lap.loop_attempts() {
            let (before, after) = lap.loop_motion(attempt.tick).unwrap();
            let shift = before
                .iter()
                .zip(after)
                .map(|(a, b)| ch16_slam2d::metrics::position_error_m(a, b))
                .fold(0.0, f64::max);
            assert_eq!(Some(shift), attempt.effect.map(|effect| effect.max_shift_m));
            assert_eq!(after, lap.poses(attempt.tick));
        }
        assert_eq!(lap.loop_motion(5), None);
    }
}
