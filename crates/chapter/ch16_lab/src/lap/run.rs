//! A lap and its front end alone in pieces of one tick each, so that a page can redraw in between.

use std::sync::Arc;

use super::record::{LapRecord, LapTrace, Recorder};
use super::{Drive, DriveSimulation, Lap, LapConfig};
use ch16_slam2d::chapter::ChapterParts;

/// A lap under way, from [`LapRunner::start`](super::LapRunner::start).
pub struct LapRun {
    config: LapConfig,
    stage: Option<Stage>,
    /// Custom parts for the lap that follows the simulation.
    parts: Option<ChapterParts>,
    steps: usize,
}

/// The next piece of a run.
pub(super) enum Stage {
    /// Simulates the drive.
    Driving(Box<DriveSimulation>),
    /// Runs the lap; the front end alone may have branched off.
    Lap {
        drive: Arc<Drive>,
        recorder: Box<Recorder>,
        front_end: Option<Box<Recorder>>,
    },
    /// The lap is finished; the front end alone continues.
    FrontEnd {
        drive: Arc<Drive>,
        lap: Box<LapTrace>,
        recorder: Box<Recorder>,
    },
}

impl Stage {
    /// The lap of `config` on a simulated drive, with custom parts if there are any.
    pub(super) fn on(config: &LapConfig, drive: Arc<Drive>, parts: Option<ChapterParts>) -> Self {
        let lap = match parts {
            Some(parts) => Lap::with_parts(config.clone(), drive, parts),
            None => Lap::on_drive(config.clone(), drive),
        };
        let drive = Arc::clone(lap.drive());
        Self::Lap {
            drive,
            recorder: Box::new(Recorder::new(lap)),
            front_end: None,
        }
    }
}

impl LapRun {
    pub(super) fn new(config: LapConfig, stage: Stage, parts: Option<ChapterParts>) -> Self {
        Self {
            config,
            stage: Some(stage),
            parts,
            steps: 0,
        }
    }

    /// The configuration.
    #[must_use]
    pub fn config(&self) -> &LapConfig {
        &self.config
    }

    /// The number of steps so far.
    #[must_use]
    pub fn steps(&self) -> usize {
        self.steps
    }

    /// Processes one tick of the drive, of the lap or of the front end alone. Returns the record once all of
    /// them are finished. The bits equal those of [`LapRunner::run`](super::LapRunner::run).
    ///
    /// # Panics
    /// If called again after that.
    pub fn step(&mut self) -> Option<LapRecord> {
        self.steps += 1;
        let stage = self.stage.take().expect("a finished lap has no step left");
        let next = match stage {
            Stage::Driving(mut simulation) => match simulation.step() {
                None => Stage::Driving(simulation),
                Some(drive) => Stage::on(&self.config, Arc::new(drive), self.parts.take()),
            },
            Stage::Lap {
                drive,
                mut recorder,
                mut front_end,
            } => match recorder.step() {
                Some(recorded) => {
                    front_end = front_end.or(recorded.front_end_alone);
                    Stage::Lap {
                        drive,
                        recorder,
                        front_end,
                    }
                }
                None => {
                    let lap = recorder.into_trace();
                    match front_end {
                        None => return Some(self.record(drive, lap.clone(), lap)),
                        Some(recorder) => Stage::FrontEnd {
                            drive,
                            lap: Box::new(lap),
                            recorder,
                        },
                    }
                }
            },
            Stage::FrontEnd {
                drive,
                lap,
                mut recorder,
            } => {
                if recorder.step().is_none() {
                    let front_end = recorder.into_trace();
                    return Some(self.record(drive, *lap, front_end));
                }
                Stage::FrontEnd {
                    drive,
                    lap,
                    recorder,
                }
            }
        };
        self.stage = Some(next);
        None
    }

    fn record(&self, drive: Arc<Drive>, lap: LapTrace, front_end: LapTrace) -> LapRecord {
        LapRecord {
            config: self.config.clone(),
            drive,
            lap,
            front_end,
        }
    }
}
