//! Every constant of the ancestor.

use pr_geom::SE2;

use super::LikelihoodMapConfig;
use crate::field::ClimbConfig;
use ch16_slam2d::scan::ScanConfig;
use ch16_slam2d::slam::{MotionNoise, SlamConfig};

/// When particles are believed, and how far they spread.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CycleConfig {
    /// Seed of the particles' noise.
    pub seed: u32,
    /// Number of particles.
    pub particles: usize,
    /// Drift of x and of y over one keyframe, a standard deviation, m.
    pub drift_sigma_m: f64,
    /// Drift of the heading over one keyframe, a standard deviation, rad.
    pub drift_sigma_rad: f64,
    /// The old map holds keyframes that are at least so many nodes older.
    pub min_gap_nodes: usize,
    /// The old map as the particles see it: wider than that of the climb, or none of them hits.
    pub field: LikelihoodMapConfig,
    /// How much a point counts in a particle's weight: points of one scan are not independent.
    pub weight: f64,
    /// A place is known where at least this share of the scan falls onto seen cells of the old map.
    pub min_known: f64,
    /// Particles agree where their positions deviate by less, m.
    pub max_spread_m: f64,
    /// And their headings, rad.
    pub max_spread_rad: f64,
    /// A place fits where this share of what falls onto seen cells lies at a wall of the old map.
    pub min_fit: f64,
    /// A pose that is off by less needs no push, m.
    pub min_shift_m: f64,
    /// Nor one whose heading is, rad.
    pub min_turn_rad: f64,
}

/// The parameters of an [`IncrementalMapper`](super::IncrementalMapper).
#[derive(Clone, Debug, PartialEq)]
pub struct IncrementalConfig {
    /// Pose of the first frame: it lays down the map's frame.
    pub start: SE2,
    /// How a scan becomes a cloud.
    pub scan: ScanConfig,
    /// The map.
    pub map: LikelihoodMapConfig,
    /// The hill climbing.
    pub climb: ClimbConfig,
    /// The motion prior where the wheels were read.
    pub odometry_noise: MotionNoise,
    /// The motion prior where the velocity is expected to stay.
    pub prediction_noise: MotionNoise,
    /// The velocity is expected to stay for so many times the last interval at most.
    pub extrapolation: f64,
    /// Distance in metres after which a scan is added to the map.
    pub keyframe_distance_m: f64,
    /// Turn in radians after which a scan is added to the map.
    pub keyframe_turn_rad: f64,
    /// The variant for cycles; `None` for the incremental mapper alone.
    pub cycles: Option<CycleConfig>,
}

impl Default for IncrementalConfig {
    fn default() -> Self {
        Self::from_slam_config(&SlamConfig::default())
    }
}

impl IncrementalConfig {
    /// The incremental mapper with the lengths of a pose-graph system: its cells, its keyframes, its
    /// noise of the wheels.
    #[must_use]
    pub fn from_slam_config(slam: &SlamConfig) -> Self {
        Self {
            start: slam.start,
            scan: slam.scan,
            map: LikelihoodMapConfig::of_cells(slam.scan.cell_m),
            climb: ClimbConfig {
                weight: 1.0,
                max_steps: 30,
                tolerance: 1e-5,
            },
            odometry_noise: slam.chapter.odometry_noise,
            prediction_noise: slam.chapter.prediction_noise,
            extrapolation: slam.extrapolation,
            keyframe_distance_m: slam.keyframe_distance_m,
            keyframe_turn_rad: slam.keyframe_turn_rad,
            cycles: None,
        }
    }

    /// The same with the variant for cycles, whose drift and gap are those of the pose-graph system's
    /// loops.
    #[must_use]
    pub fn with_cycles(mut self, slam: &SlamConfig, seed: u32) -> Self {
        let cell_m = slam.scan.cell_m;
        self.cycles = Some(CycleConfig {
            seed,
            particles: 600,
            drift_sigma_m: slam.chapter.loops.drift_sigma_m,
            drift_sigma_rad: slam.chapter.loops.drift_sigma_rad,
            min_gap_nodes: slam.chapter.loops.min_gap_nodes,
            field: LikelihoodMapConfig {
                sigma_m: 2.0 * self.map.sigma_m,
                ..self.map
            },
            weight: 2.0 / slam.chapter.loops.trust.covariance_scale,
            min_known: 0.6,
            max_spread_m: 2.5 * cell_m,
            max_spread_rad: 0.1,
            min_fit: 0.75,
            min_shift_m: cell_m,
            min_turn_rad: 0.03,
        });
        self
    }
}
