//! Laps for a control that moves faster than they are computed.

use super::record::LapRecord;
use super::run::LapRun;
use super::{LapConfig, LapRunner};
use ch16_slam2d::chapter::ChapterParts;

/// Runs at most one lap, and keeps at most one request that waits for it: the newest.
///
/// Requests in between are dropped. A lap under way runs to its end; otherwise a control that moves at every
/// frame would show no result until it rests. A lap without a tick yet is replaced at once.
#[derive(Default)]
pub struct NewestLap {
    runner: LapRunner,
    under_way: Option<LapRun>,
    waiting: Option<Request>,
    steps: usize,
}

/// A requested lap.
struct Request {
    config: LapConfig,
    parts: Option<ChapterParts>,
}

impl Request {
    fn start(self, runner: &LapRunner) -> LapRun {
        match self.parts {
            Some(parts) => runner.start_with_parts(self.config, parts),
            None => runner.start(self.config),
        }
    }
}

/// What [`NewestLap::step`] did.
#[derive(Debug)]
pub enum NewestStep {
    /// No lap is under way.
    Idle,
    /// One tick of a lap.
    Tick,
    /// The last tick of a lap.
    Finished(Box<LapRecord>),
}

impl NewestLap {
    /// Creates it without a request.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Requests a lap; an earlier request that has not started is dropped.
    pub fn ask(&mut self, config: LapConfig) {
        let is_same = |run: &LapRun| run.steps() > 0 && *run.config() == config;
        if self.under_way.as_ref().is_some_and(is_same) {
            self.waiting = None;
        } else {
            self.request(Request {
                config,
                parts: None,
            });
        }
    }

    /// Requests a lap with custom parts. All requests of one `NewestLap` have them, or none has.
    pub fn ask_with_parts(&mut self, config: LapConfig, parts: ChapterParts) {
        self.request(Request {
            config,
            parts: Some(parts),
        });
    }

    fn request(&mut self, request: Request) {
        if self.under_way.as_ref().is_some_and(|run| run.steps() > 0) {
            self.waiting = Some(request);
        } else {
            self.waiting = None;
            self.under_way = Some(request.start(&self.runner));
        }
    }

    /// Whether a lap is under way.
    #[must_use]
    pub fn is_running(&self) -> bool {
        self.under_way.is_some()
    }

    /// The number of steps so far, of all laps.
    #[must_use]
    pub fn steps(&self) -> usize {
        self.steps
    }

    /// Processes one tick of the lap under way.
    pub fn step(&mut self) -> NewestStep {
        let Some(run) = &mut self.under_way else {
            return NewestStep::Idle;
        };
        self.steps += 1;
        let Some(record) = run.step() else {
            return NewestStep::Tick;
        };
        self.runner.keep(&record);
        let next = self.waiting.take();
        self.under_way = next.map(|request| request.start(&self.runner));
        NewestStep::Finished(Box::new(record))
    }

    /// Drops the lap under way if a newer one was requested, and starts that one.
    pub fn drop_outdated(&mut self) {
        if let Some(request) = self.waiting.take() {
            self.under_way = Some(request.start(&self.runner));
        }
    }

    /// Runs the newest requested lap to its end; `None` if no lap is under way.
    pub fn finish(&mut self) -> Option<Box<LapRecord>> {
        self.drop_outdated();
        loop {
            match self.step() {
                NewestStep::Idle => return None,
                NewestStep::Tick => {}
                NewestStep::Finished(record) => return Some(record),
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Steps to the end of one lap. Returns it with the number of steps.
    fn next(newest: &mut NewestLap) -> (Box<LapRecord>, usize) {
        for steps in 1.. {
            match newest.step() {
                NewestStep::Idle => panic!("no lap is under way"),
                NewestStep::Tick => {}
                NewestStep::Finished(record) => return (record, steps),
            }
        }
        unreachable!("a lap ends")
    }

    #[test]
    fn of_two_hundred_values_at_once_only_the_newest_is_run() {
        let mut newest = NewestLap::new();
        newest.ask(LapConfig::default());
        newest.finish().unwrap();
        let before = newest.steps();
        for value in 1..=200 {
            newest.ask(LapConfig::with_seed_and_noise(
                12_648_430,
                f64::from(value) * 0.02,
            ));
        }
        let (record, steps) = next(&mut newest);
        let wanted = LapConfig::with_seed_and_noise(12_648_430, 4.0);
        assert_eq!(*record, LapRunner::new().run(&wanted));
        assert!(matches!(newest.step(), NewestStep::Idle));
        // The lap and the rest of its front end: at most two laps of ticks, and the two ends.
        assert!(steps <= 2 * record.ticks() + 2, "{steps} steps");
        assert_eq!(newest.steps(), before + steps);
    }

    #[test]
    fn a_lap_under_way_is_finished_before_the_newest_waiting_one() {
        let mut newest = NewestLap::new();
        newest.ask(LapConfig::with_seed_and_noise(1, 1.0));
        newest.step();
        for noise in [2.0, 3.0, 4.0] {
            newest.ask(LapConfig::with_seed_and_noise(1, noise));
        }
        let (first, _) = next(&mut newest);
        assert_eq!(first.config, LapConfig::with_seed_and_noise(1, 1.0));
        assert!(newest.is_running());
        let (second, _) = next(&mut newest);
        assert_eq!(second.config, LapConfig::with_seed_and_noise(1, 4.0));
        assert!(!newest.is_running());
    }

    #[test]
    fn requesting_the_lap_under_way_again_starts_no_other() {
        let mut newest = NewestLap::new();
        newest.ask(LapConfig::with_seed_and_noise(1, 1.0));
        newest.step();
        newest.ask(LapConfig::with_seed_and_noise(1, 2.0));
        newest.ask(LapConfig::with_seed_and_noise(1, 1.0));
        next(&mut newest);
        assert!(!newest.is_running());
    }

    #[test]
    fn finishing_skips_what_is_out_of_date_and_has_the_bits_of_a_run_at_once() {
        let mut newest = NewestLap::new();
        newest.ask(LapConfig::with_seed_and_noise(1, 1.0));
        newest.step();
        newest.ask(LapConfig::with_seed_and_noise(6, 2.0));
        let record = newest.finish().unwrap();
        let wanted = LapConfig::with_seed_and_noise(6, 2.0);
        assert_eq!(*record, LapRunner::new().run(&wanted));
        assert!(newest.finish().is_none());
    }
}
