//! The constants of incremental mapping.

use pr_geom::SE2;

use super::LikelihoodMapConfig;
use crate::field::ClimbConfig;
use ch16_slam2d::scan::ScanConfig;
use ch16_slam2d::slam::{MotionNoise, SlamConfig};

/// Criteria for closing a cycle, and the drift of the particles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CycleConfig {
    /// Seed of the particles' noise.
    pub seed: u32,
    /// Number of particles.
    pub particles: usize,
    /// Drift of x and of y per keyframe, a standard deviation, m.
    pub drift_sigma_m: f64,
    /// Drift of the heading per keyframe, a standard deviation, rad.
    pub drift_sigma_rad: f64,
    /// The old map holds keyframes that are at least this many nodes older.
    pub min_gap_nodes: usize,
    /// The likelihood field of the old map for the particles: wider than that of the climb, so that some particle
    /// hits.
    pub field: LikelihoodMapConfig,
    /// Exponent of a point's likelihood, because points of one scan are correlated.
    pub weight: f64,
    /// Smallest share of the scan on observed cells of the old map for a known location.
    pub min_known: f64,
    /// Largest standard deviation of the particles' positions for a decision, m.
    pub max_spread_m: f64,
    /// Largest standard deviation of their headings, rad.
    pub max_spread_rad: f64,
    /// Smallest share of the scan's points on observed cells that lie at a wall of the old map.
    pub min_fit: f64,
    /// Smallest position error that is corrected, m.
    pub min_shift_m: f64,
    /// Smallest heading error that is corrected, rad.
    pub min_turn_rad: f64,
}

/// The parameters of an [`IncrementalMapper`](super::IncrementalMapper).
#[derive(Clone, Debug, PartialEq)]
pub struct IncrementalConfig {
    /// Pose of the first frame, which defines the map's frame.
    pub start: SE2,
    /// How a scan becomes a cloud.
    pub scan: ScanConfig,
    /// The map.
    pub map: LikelihoodMapConfig,
    /// The hill climbing.
    pub climb: ClimbConfig,
    /// Noise of the motion prior by odometry.
    pub odometry_noise: MotionNoise,
    /// Noise of the motion prior by constant velocity.
    pub prediction_noise: MotionNoise,
    /// Constant velocity is assumed for at most this many times the last interval.
    pub extrapolation: f64,
    /// Distance in metres after which a scan is added to the map.
    pub keyframe_distance_m: f64,
    /// Turn in radians after which a scan is added to the map.
    pub keyframe_turn_rad: f64,
    /// Settings for closing cycles; `None` for the incremental mapper alone.
    pub cycles: Option<CycleConfig>,
}

impl Default for IncrementalConfig {
    fn default() -> Self {
        Self::from_slam_config(&SlamConfig::default())
    }
}

impl IncrementalConfig {
    /// The incremental mapper with the cells, keyframes and odometry noise of a pose-graph system.
    #[must_use]
    pub fn from_slam_config(slam: &SlamConfig) -> Self {
        Self {
            start: slam.start,
            scan: slam.scan,
            map: LikelihoodMapConfig::from_cell_size(slam.scan.cell_m),
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

    /// The same with cycle closing; drift and gap are those of the pose-graph system's loops.
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
