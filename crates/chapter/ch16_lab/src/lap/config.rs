//! Every constant of the lap; the defaults are the chapter's.

use std::sync::Arc;

use ch16_slam2d::scan::ScanConfig;
use ch16_slam2d::slam::SlamConfig;
use pr_geom::SE2;
use pr_sim::{Course, DriverConfig, LidarConfig, VelocityNoise, World};

/// The area of a lap's grid.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum GridExtent {
    /// The plan of the world, as in the chapter's figures; beams are cut at its border.
    Plan,
    /// Everything in sensor range of the poses, because a robot has no plan of an unknown world, and an
    /// estimate that drifts leaves the plan.
    #[default]
    Poses,
}

/// The seed of the canonical run.
pub const CANONICAL_SEED: u32 = 0x00C0_FFEE;

/// Ticks of the chapter's lap. The driver steers by the true pose, so neither noise nor seed changes them;
/// another start, driver or tick duration does.
pub const LAP_TICKS: usize = 129;

/// What is driven and sensed: everything outside the estimator. The range of each number is in
/// [`RANGES`](super::RANGES).
#[derive(Clone, Debug, PartialEq)]
pub struct DriveConfig {
    /// Seed of the generator that all noise of the lap comes from.
    pub seed: u32,
    /// Multiplies all six α of the wheel odometry.
    pub noise_factor: f64,
    /// The walls.
    pub world: Arc<World>,
    /// True pose at the start, world frame.
    pub start: SE2,
    /// Index of the waypoint after which the robot revisits known locations.
    pub turn: Option<usize>,
    /// Duration of a tick in seconds.
    pub dt_s: f64,
    /// Waypoints and controller.
    pub driver: DriverConfig,
    /// Wheel odometry at noise factor 1.
    pub odometry_noise: VelocityNoise,
    /// The sensor.
    pub lidar: LidarConfig,
    /// How each sweep becomes a cloud: the drive stores the clouds.
    pub scan: ScanConfig,
    /// A lap is cut off after this many ticks.
    pub max_ticks: usize,
}

impl Default for DriveConfig {
    fn default() -> Self {
        Self {
            seed: CANONICAL_SEED,
            noise_factor: 1.0,
            world: Arc::new(World::apartment()),
            start: SE2::new(1.35, 4.42, 0.0),
            turn: Some(0),
            dt_s: 0.25,
            driver: DriverConfig::default(),
            odometry_noise: VelocityNoise::default(),
            lidar: LidarConfig::default(),
            scan: ScanConfig::default(),
            max_ticks: 2000,
        }
    }
}

impl DriveConfig {
    /// The same robot on another course.
    #[must_use]
    pub fn on_course(mut self, course: &Course) -> Self {
        self.world = Arc::new(course.world().clone());
        self.start = course.start();
        self.driver.waypoints = course.way_points().to_vec();
        self.turn = course.turn();
        self
    }

    /// Whether both describe the same drive, except for the noise factor of the odometry.
    #[must_use]
    pub fn differs_only_in_noise_from(&self, other: &Self) -> bool {
        let same_noise = Self {
            noise_factor: self.noise_factor,
            ..other.clone()
        };
        *self == same_noise
    }
}

/// A lap: the drive and the estimator that runs on it; ranges in [`RANGES`](super::RANGES).
#[derive(Clone, Debug, PartialEq)]
pub struct LapConfig {
    /// The simulated drive.
    pub drive: DriveConfig,
    /// The estimator; the drive determines its start and how its scans become clouds.
    pub slam: SlamConfig,
    /// The area of the occupancy grid.
    pub grid: GridExtent,
}

impl Default for LapConfig {
    fn default() -> Self {
        let drive = DriveConfig::default();
        let mut slam = SlamConfig::chapter();
        slam.chapter.threshold.max_range_m = drive.lidar.max_range_m;
        Self {
            slam,
            drive,
            grid: GridExtent::Plan,
        }
    }
}

impl LapConfig {
    /// The chapter's lap at another seed and noise factor.
    #[must_use]
    pub fn with_seed_and_noise(seed: u32, noise_factor: f64) -> Self {
        let mut config = Self::default();
        config.drive.seed = seed;
        config.drive.noise_factor = noise_factor;
        config
    }

    /// The same robot on another course, with the default estimator: the chapter's results do not apply
    /// there, so neither do its deviations from the default.
    #[must_use]
    pub fn elsewhere(self, course: &Course) -> Self {
        let mut slam = SlamConfig::default();
        slam.chapter.threshold = self.slam.chapter.threshold;
        Self {
            drive: self.drive.on_course(course),
            slam: slam.clone(),
            grid: GridExtent::Poses,
        }
        .with_scan(slam.scan)
    }

    /// Replaces how sweeps become clouds.
    #[must_use]
    pub fn with_scan(mut self, scan: ScanConfig) -> Self {
        self.drive.scan = scan;
        self.slam.scan = scan;
        self
    }

    /// Turns off loop closure.
    #[must_use]
    pub fn without_loops(mut self) -> Self {
        self.slam = self.slam.without_loops();
        self
    }
}

#[cfg(test)]
mod tests {
    use pr_grid::{GridConfig, InverseSensorModel};

    use super::*;

    #[test]
    fn what_packages_that_do_not_know_each_other_say_of_the_apartment_is_one() {
        let (world, range_m) = (World::apartment(), LidarConfig::default().max_range_m);
        assert_eq!(SlamConfig::chapter().chapter.threshold.max_range_m, range_m);
        assert_eq!(InverseSensorModel::default().max_range_m, range_m);
        let grid = GridConfig::default();
        let bounds = world.bounds();
        assert_eq!((grid.min_m, grid.max_m), (bounds.min, bounds.max));
        let drive = DriveConfig::default();
        assert_eq!(drive.clone().on_course(&Course::apartment()), drive);
    }
}
