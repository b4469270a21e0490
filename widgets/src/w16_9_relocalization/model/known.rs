//! The saved map and the localization run on it, computed in pieces between frames.

use std::sync::Arc;

use ch16_lab::lap::{Drive, DriveConfig, DriveSimulation};
use ch16_lab::laps::{LapNumbers, LapUnderWay, Laps, LapsConfig};
use ch16_lab::relocalization::{LocalizationRun, switched_on};
use ch16_slam2d::localize::{KnownMap, LocalizeConfig, Localizer, StartPose};
use ch16_slam2d::slam::SlamConfig;
use widget_kit::values::Values;

use super::settings;

/// Ticks of a run: ten seconds.
const RUN_TICKS: usize = 40;

/// Offset of the seed: the noise of the run differs from that of the laps.
const ANOTHER_DAY: u32 = 1000;

/// A saved map and its properties.
pub struct Known {
    config: LapsConfig,
    laps: usize,
    /// The keyframes at their poses.
    pub map: Arc<KnownMap>,
    /// The drive of the next day, without its start.
    pub tomorrow: DriveConfig,
    /// The estimator's parameters.
    slam: SlamConfig,
    /// The last lap in numbers.
    pub numbers: LapNumbers,
}

impl Known {
    /// Whether it is the map of the values.
    pub fn is_of(&self, values: &Values) -> bool {
        self.laps == settings::laps(values) && self.config == settings::laps_config(values)
    }
}

/// The work under way.
pub enum Work {
    /// A lap is simulated.
    Driving(Box<Laps>, Box<DriveSimulation>),
    /// A lap is mapped.
    Mapping(Box<Laps>, LapUnderWay, Box<Drive>),
    /// The robot's drive is simulated.
    Simulating(Box<(Arc<KnownMap>, SlamConfig)>, Box<DriveSimulation>),
    /// The robot is localized, and tracked.
    Localizing(Box<LocalizationRun>),
}

/// The result of one piece of work.
pub enum Step {
    /// There is more to do.
    Continue(Work),
    /// The map is finished.
    Saved(Box<Known>),
    /// The run is over.
    Over(Box<LocalizationRun>),
}

impl Work {
    /// A map before its first step.
    pub fn map(values: &Values) -> Self {
        Self::next_lap(Box::new(Laps::new(settings::laps_config(values))))
    }

    /// A run on a map, from the start in the values.
    pub fn run(known: &Known, values: &Values) -> Self {
        let start = settings::start(values);
        let drive = switched_on(&known.tomorrow, start, RUN_TICKS);
        Self::Simulating(
            Box::new((Arc::clone(&known.map), known.slam.clone())),
            Box::new(DriveSimulation::new(drive)),
        )
    }

    fn next_lap(laps: Box<Laps>) -> Self {
        let drive = DriveSimulation::new(laps.drive_config());
        Self::Driving(laps, Box::new(drive))
    }

    /// Does one piece.
    pub fn step(self, values: &Values) -> Step {
        Step::Continue(match self {
            Self::Driving(laps, mut simulation) => match simulation.step() {
                None => Self::Driving(laps, simulation),
                Some(drive) => {
                    let under_way = laps.begin();
                    Self::Mapping(laps, under_way, Box::new(drive))
                }
            },
            Self::Mapping(mut laps, mut under_way, drive) => {
                match laps.step(&mut under_way, &drive) {
                    None => Self::Mapping(laps, under_way, drive),
                    Some(numbers) if numbers.lap < settings::laps(values) => Self::next_lap(laps),
                    Some(numbers) => return Step::Saved(Box::new(saved(&laps, numbers, values))),
                }
            }
            Self::Simulating(known, mut simulation) => match simulation.step() {
                None => Self::Simulating(known, simulation),
                Some(drive) => {
                    let (map, slam) = *known;
                    let config = LocalizeConfig::default();
                    let localizer = Localizer::new(map, slam, config, StartPose::Anywhere);
                    Self::Localizing(Box::new(LocalizationRun::new(localizer, Arc::new(drive))))
                }
            },
            Self::Localizing(mut run) => {
                if !run.step() {
                    return Step::Over(run);
                }
                Self::Localizing(run)
            }
        })
    }
}

fn saved(laps: &Laps, numbers: LapNumbers, values: &Values) -> Known {
    let slam = laps.slam();
    let keyframes = slam.keyframes().to_vec();
    let poses = slam.graph().poses().to_vec();
    let map = KnownMap::new(keyframes, poses, &LocalizeConfig::default());
    let config = settings::laps_config(values);
    let lap = laps.drive_config();
    Known {
        laps: numbers.lap,
        map: Arc::new(map.expect("a lap leaves a map")),
        tomorrow: DriveConfig {
            seed: lap.seed.wrapping_add(ANOTHER_DAY),
            start: config.drive.start,
            ..lap
        },
        slam: config.slam.clone(),
        numbers,
        config,
    }
}
