//! Every constant of the lap; the defaults are the chapter's.

use std::sync::Arc;

use pr_geom::SE2;
use pr_sim::{Course, DriverConfig, LidarConfig, OdometryNoise, World};

use ch16_slam2d::loops::{LoopConfig, MapConfig, TrustConfig};

/// The seed of the canonical run.
pub const CANONICAL_SEED: u32 = 0x00C0_FFEE;

/// Ticks of the chapter's lap: the driver steers by the true pose, so that neither noise nor seed
/// changes them. Another start, driver or duration of a tick does.
pub const LAP_TICKS: usize = 129;

/// Whether the back end looks for loops.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum LoopClosure {
    /// Loops are detected, verified and closed.
    #[default]
    On,
    /// The front end alone: odometry edges only.
    Off,
}

/// What is driven and sensed: all that the estimator cannot change.
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
    /// Duration of a tick in seconds.
    pub dt_s: f64,
    /// Way points and controller.
    pub driver: DriverConfig,
    /// The way point from which on places are seen again, counted from 0.
    pub turn: Option<usize>,
    /// Wheel odometry at noise factor 1.
    pub odometry_noise: OdometryNoise,
    /// The sensor.
    pub lidar: LidarConfig,
    /// A sweep is thinned to one point in each cell of this side, in metres.
    pub sweep_cell_m: f64,
    /// Radius in metres within which a sweep's points give each other normals.
    pub normal_radius_m: f64,
    /// A lap that has not ended after this many ticks is cut off.
    pub max_ticks: usize,
}

impl Default for DriveConfig {
    fn default() -> Self {
        let course = Course::apartment();
        Self {
            seed: CANONICAL_SEED,
            noise_factor: 1.0,
            world: Arc::new(course.world().clone()),
            start: course.start(),
            dt_s: 0.25,
            driver: DriverConfig::default(),
            turn: course.turn(),
            odometry_noise: OdometryNoise::default(),
            lidar: LidarConfig::default(),
            sweep_cell_m: 0.12,
            normal_radius_m: 0.3,
            max_ticks: 2000,
        }
    }
}

impl DriveConfig {
    /// The same drive on another course.
    #[must_use]
    pub fn on(mut self, course: &Course) -> Self {
        self.world = Arc::new(course.world().clone());
        self.start = course.start();
        self.driver.waypoints = course.way_points().to_vec();
        self.turn = course.turn();
        self
    }

    /// Whether both describe the same drive, up to the noise factor of the wheels.
    #[must_use]
    pub fn differs_only_in_noise_from(&self, other: &Self) -> bool {
        let same_noise = Self {
            noise_factor: self.noise_factor,
            ..other.clone()
        };
        *self == same_noise
    }
}

/// The adaptive correspondence threshold (Vizzo et al., "KISS-ICP", 2023, §III-B).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ThresholdConfig {
    /// Threshold in metres until three corrections were seen.
    pub initial_m: f64,
    /// Corrections smaller than this (m) do not count.
    pub min_motion_m: f64,
    /// Range at which a rotation is turned into a displacement, in metres.
    pub max_range_m: f64,
}

/// The lap's parameters.
#[derive(Clone, Debug, PartialEq)]
pub struct SlamConfig {
    /// The simulated drive.
    pub drive: DriveConfig,
    /// Whether loops are closed.
    pub loop_closure: LoopClosure,
    /// Number of last sweeps in the local map.
    pub window_sweeps: usize,
    /// The local map.
    pub local_map: MapConfig,
    /// Most iterations of a registration against the local map.
    pub max_iterations: usize,
    /// Registrations with fewer pairs are not believed: the prediction stands.
    pub min_inliers: usize,
    /// The adaptive correspondence threshold.
    pub threshold: ThresholdConfig,
    /// Distance in metres after which a keyframe is taken.
    pub keyframe_distance_m: f64,
    /// Turn in radians after which a keyframe is taken.
    pub keyframe_turn_rad: f64,
    /// Trust in the edge between two keyframes.
    pub odometry_trust: TrustConfig,
    /// Detection and verification of loops.
    pub loops: LoopConfig,
    /// Most Gauss–Newton iterations after a loop.
    pub optimizer_iterations: usize,
    /// The optimizer stops where no node moves farther than this (m + rad).
    pub optimizer_tolerance: f64,
    /// Huber width on the Mahalanobis norm of an edge.
    pub huber: f64,
}

impl Default for SlamConfig {
    fn default() -> Self {
        Self {
            drive: DriveConfig::default(),
            loop_closure: LoopClosure::On,
            window_sweeps: 6,
            local_map: MapConfig {
                cell_m: 0.25,
                max_per_cell: 4,
            },
            max_iterations: 15,
            min_inliers: 8,
            threshold: ThresholdConfig {
                initial_m: 0.5,
                min_motion_m: 0.03,
                max_range_m: 6.0,
            },
            keyframe_distance_m: 0.4,
            keyframe_turn_rad: 0.35,
            odometry_trust: TrustConfig {
                sigma_m: 0.05,
                inflate: 12.0,
            },
            loops: LoopConfig::default(),
            optimizer_iterations: 15,
            optimizer_tolerance: 1e-7,
            huber: 12.0,
        }
    }
}

impl SlamConfig {
    /// The chapter's lap at another seed and noise factor.
    #[must_use]
    pub fn with_seed_and_noise(seed: u32, noise_factor: f64) -> Self {
        let mut config = Self::default();
        config.drive.seed = seed;
        config.drive.noise_factor = noise_factor;
        config
    }

    /// The same lap on another course.
    #[must_use]
    pub fn on(mut self, course: &Course) -> Self {
        self.drive = self.drive.on(course);
        self
    }

    /// The same lap with loop closure off.
    #[must_use]
    pub fn without_loops(mut self) -> Self {
        self.loop_closure = LoopClosure::Off;
        self
    }
}
