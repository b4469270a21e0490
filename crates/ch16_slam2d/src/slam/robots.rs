//! The defaults for recorded logs of indoor robots.

use super::config::{PredictionUse, SlamConfig, ThresholdConfig};
use super::{MotionNoise, RefinementConfig};
use crate::graph::JacobianModel;
use crate::icp::{IcpConfig, IcpVariant};
use crate::loops::{Detection, LoopConfig, LoopGuard, WideSearch};
use crate::matching::{
    MapConfig, MatcherKind, SearchMatcherConfig, StagedMatcherConfig, TrustConfig,
};
use crate::scan::{LaserScan, ScanConfig};

/// Radius within which points give each other normals, m, for each degree from beam to beam.
const NORMAL_RADIUS_M: f64 = 0.5;
/// Most that a point is off: by the noise of the ranges, and by where the wall was sampled, m.
const SIGMA_M: f64 = 0.025;

impl SlamConfig {
    /// One set of values for planar lasers on wheels, in rooms and corridors: scans up to half a
    /// metre apart, odometry that slips and jumps, glass and people in view.
    ///
    /// Each scan is registered from coarse to fine and weighed against the wheels, each keyframe on
    /// the visits around it, and after the last frame all of them once more. `docs/robots.md` says
    /// what it does on recorded logs. Lengths are in metres; of the sensor it asks the step from beam
    /// to beam of `scan`, since a normal needs neighbours.
    #[must_use]
    pub fn for_robot(scan: &LaserScan) -> Self {
        let step_deg = scan.angle_step_rad.abs().to_degrees();
        let default = Self::default();
        let map = |max_per_cell| MapConfig {
            cell_m: 0.135,
            max_per_cell,
        };
        let near = StagedMatcherConfig {
            good_score: 0.0,
            turns: 0,
            ..StagedMatcherConfig::default()
        };
        let far = StagedMatcherConfig {
            good_score: 0.7,
            turns: 4,
            lead: 0.05,
            near_score: 2.0,
            ..StagedMatcherConfig::default()
        };
        Self {
            scan: ScanConfig {
                cell_m: 0.065,
                normal_radius_m: NORMAL_RADIUS_M * step_deg.clamp(1.0, 1.4),
            },
            matcher: MatcherKind::Staged(far),
            window_distance_m: 0.16,
            local_map: map(4),
            max_iterations: 10,
            extrapolation: 1.0,
            prediction_use: PredictionUse::Measurement,
            aperture: 0.05,
            threshold: ThresholdConfig {
                initial_m: 0.25,
                min_motion_m: 0.016,
                max_range_m: 20.0,
            },
            confidence: 10.0,
            keyframe_distance_m: 0.65,
            keyframe_turn_rad: 0.35,
            odometry_trust: TrustConfig {
                sigma_m: SIGMA_M,
                ..default.odometry_trust
            },
            odometry_noise: MotionNoise::default(),
            loops: LoopConfig {
                detection: Detection::Visits,
                radius_m: 4.0,
                min_gap_nodes: 10,
                submap: map(6),
                matcher: MatcherKind::Staged(near),
                min_tau_m: 0.3,
                max_rmse_m: 0.1,
                min_score: 0.7,
                max_iterations: 10,
                aperture: 0.05,
                drift_share: 0.1,
                max_radius_m: 10.0,
                search: Some(WideSearch {
                    matcher: SearchMatcherConfig {
                        half_turn_rad: 0.35,
                        min_score: 0.5,
                        refine: IcpConfig {
                            variant: IcpVariant::PointToPlane,
                            tau: 0.3,
                            huber_width_m: 0.05,
                            ..IcpConfig::default()
                        },
                        ..SearchMatcherConfig::default()
                    },
                    min_way_m: 20.0,
                    every_m: 4.0,
                    candidates: 1,
                    min_margin: 0.05,
                    min_score: 0.75,
                }),
                guard: Some(LoopGuard::default()),
                drift_sigma_m: 0.07,
                trust: TrustConfig {
                    sigma_m: SIGMA_M,
                    ..default.loops.trust
                },
                ..default.loops
            },
            refinement: RefinementConfig {
                passes: 2,
                radius_m: 4.0,
                ..default.refinement
            },
            jacobians: JacobianModel::Exact,
            least_correction: 0.05,
            ..default
        }
    }
}
