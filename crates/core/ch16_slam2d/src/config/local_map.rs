//! The estimator for recorded logs of robots: its parameters, and the resulting configuration.

use serde::{Deserialize, Serialize};

use super::{MotionNoise, SlamConfig, tuning};
use crate::graph::JacobianModel;
use crate::scan::{LaserScan, ScanConfig};

/// The parameters of the estimator for robots.
///
/// One set of values for planar lasers on wheeled robots, in rooms, corridors and outdoors. Lengths are in
/// metres. These are the numbers that an owner of a robot may know; `config/tuning.rs` has the others, with what
/// chose them. `docs/robots.md` has results on recorded logs. A session file may contain former parameters, which are
/// constants now and are ignored.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct LocalMapConfig {
    /// A scan is thinned to a point in each cell of this side, m.
    pub scan_cell_m: f64,
    /// Radius of the neighbours for normals within one scan, m: [`LocalMapConfig::for_scan`] derives it.
    pub scan_normal_radius_m: f64,
    /// Standard deviation of a point across its wall, m.
    pub point_sigma_m: f64,
    /// Noise of the odometry.
    pub odometry: OdometryNoise,
    /// Distance after which a keyframe is taken, m.
    pub keyframe_distance_m: f64,
    /// Turn after which a keyframe is taken, rad.
    pub keyframe_turn_rad: f64,
    /// Parameters of loop closure.
    pub loops: SubmapLoopConfig,
}

/// Standard deviations of a motion measured by odometry, as shares of the motion.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct OdometryNoise {
    /// Of the position, per metre.
    pub per_metre: f64,
    /// Of the heading, per radian.
    pub per_rad: f64,
}

/// Parameters of loop closure: registration of the newest keyframes on a submap of older ones.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct SubmapLoopConfig {
    /// Smallest path length back to the keyframes of a submap, m.
    pub min_path_m: f64,
    /// Largest half width of the search window, m.
    pub max_window_m: f64,
}

/// Settings for registering and scoring scans.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MapRegistrationConfig {
    /// Radius of the neighbours for normals of the map, m.
    pub normal_radius_m: f64,
    /// Largest distance of a pair in the first stage, m.
    pub max_correspondence_m: f64,
    /// Largest distance of a pair in the last stage, and of an inlier, m.
    pub inlier_distance_m: f64,
    /// Standard deviation of a point across its wall, m.
    pub point_sigma_m: f64,
    /// Largest number of independent points of a scan, because the errors of neighbours are correlated.
    pub independent_points: f64,
    /// Cost of a point in unseen space, as a share of a miss.
    pub unseen_cost: f64,
    /// If the score is lower, the window around the prediction is searched, 0 to 1.
    pub good_score: f64,
    /// Half the width of that window, m.
    pub search_m: f64,
    /// Half its range of headings, rad.
    pub search_rad: f64,
}

impl Default for LocalMapConfig {
    fn default() -> Self {
        Self {
            scan_cell_m: 0.065,
            scan_normal_radius_m: tuning::SCAN_NORMAL_RADIUS_M,
            point_sigma_m: 0.025,
            odometry: OdometryNoise {
                per_metre: tuning::ODOMETRY.per_metre,
                per_rad: tuning::ODOMETRY.per_rad,
            },
            keyframe_distance_m: 0.65,
            keyframe_turn_rad: 0.35,
            loops: SubmapLoopConfig {
                min_path_m: 12.0,
                max_window_m: 20.0,
            },
        }
    }
}

impl LocalMapConfig {
    /// The values for a scanner; they depend only on its angle between beams, because normals need
    /// neighbours.
    #[must_use]
    pub fn for_scan(scan: &LaserScan) -> Self {
        let step_deg = scan.angle_step_rad.abs().to_degrees();
        Self {
            scan_normal_radius_m: tuning::SCAN_NORMAL_RADIUS_M * step_deg.clamp(1.0, 1.4),
            ..Self::default()
        }
    }

    /// Noise of a motion that was measured by odometry, or predicted.
    #[must_use]
    pub fn motion_noise(&self, is_measured: bool) -> MotionNoise {
        if !is_measured {
            return tuning::CONSTANT_VELOCITY;
        }
        MotionNoise {
            per_metre: self.odometry.per_metre,
            per_rad: self.odometry.per_rad,
            ..tuning::ODOMETRY
        }
    }

    /// Settings for registering and scoring scans.
    #[must_use]
    pub fn registration(&self) -> MapRegistrationConfig {
        MapRegistrationConfig {
            normal_radius_m: tuning::NORMAL_RADIUS_M,
            max_correspondence_m: tuning::MAX_CORRESPONDENCE_M,
            inlier_distance_m: tuning::INLIER_DISTANCE_M,
            point_sigma_m: self.point_sigma_m,
            independent_points: tuning::INDEPENDENT_POINTS,
            unseen_cost: tuning::UNSEEN_COST,
            good_score: tuning::GOOD_SCORE,
            search_m: tuning::SEARCH_M,
            search_rad: tuning::SEARCH_RAD,
        }
    }
}

impl SlamConfig {
    /// The estimator for robots with the values for the scanner of `scan`.
    #[must_use]
    pub fn for_robot(scan: &LaserScan) -> Self {
        Self::from_local_map(LocalMapConfig::for_scan(scan))
    }

    /// The estimator for robots with these values.
    #[must_use]
    pub fn from_local_map(local_map: LocalMapConfig) -> Self {
        let default = Self::default();
        Self {
            local_map: Some(local_map),
            scan: ScanConfig {
                cell_m: local_map.scan_cell_m,
                normal_radius_m: local_map.scan_normal_radius_m,
            },
            window_scans: tuning::WINDOW_SCANS,
            window_distance_m: tuning::WINDOW_DISTANCE_M,
            window_turn_rad: tuning::WINDOW_TURN_RAD,
            extrapolation: 1.0,
            keyframe_distance_m: local_map.keyframe_distance_m,
            keyframe_turn_rad: local_map.keyframe_turn_rad,
            jacobians: JacobianModel::Exact,
            least_correction: tuning::LEAST_CORRECTION,
            ..default
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_estimator_for_robots_has_the_given_parameters() {
        let robot = LocalMapConfig {
            keyframe_distance_m: 1.25,
            ..LocalMapConfig::default()
        };
        let config = SlamConfig::from_local_map(robot);
        assert_eq!(config.local_map, Some(robot));
        assert_eq!(config.keyframe_distance_m, 1.25);
    }
}
