//! The estimator for recorded logs of robots: its parameters, and the resulting configuration.

use serde::{Deserialize, Serialize};

use super::config::SlamConfig;
use super::motion_noise::MotionNoise;
use crate::graph::JacobianModel;
use crate::local_map::{MapRegistrationConfig, tuning};
use crate::scan::{LaserScan, ScanConfig};

/// The parameters of the estimator for robots.
///
/// One set of values for planar lasers on wheeled robots, in rooms, corridors and outdoors. Lengths are in
/// metres. An owner of a robot may know the cells of its scans, the noise of its sensor and wheels, the distance of
/// keyframes and how far its loops reach; the defaults of the rest are in `local_map/tuning.rs`, with what chose
/// them. `docs/robots.md` has results on recorded logs, `docs/robots-parameters.md` the effect of each parameter.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct RobotConfig {
    /// A scan is thinned to a point in each cell of this side, m.
    pub scan_cell_m: f64,
    /// Radius of the neighbours for normals within one scan, m.
    pub scan_normal_radius_m: f64,
    /// Number of last scans in the local map.
    pub window_sweeps: usize,
    /// A scan joins the local map only at this distance from the newest one in it, m.
    pub window_distance_m: f64,
    /// Radius of the neighbours for normals of the local map, m.
    pub normal_radius_m: f64,
    /// Largest distance of a pair in the first stage of a registration, m.
    pub max_correspondence_m: f64,
    /// Largest distance of a pair in the last stage, and of an inlier, m.
    pub inlier_distance_m: f64,
    /// Standard deviation of a point across its wall, m.
    pub point_sigma_m: f64,
    /// Number of independent points of a scan.
    pub independent_points: f64,
    /// Cost of a point in unseen space, as a share of a miss.
    pub unseen_cost: f64,
    /// If the score is lower, the window around the prediction is searched, 0 to 1.
    pub good_score: f64,
    /// Half the width of that window, m.
    pub search_m: f64,
    /// Half its range of headings, rad.
    pub search_rad: f64,
    /// Noise of the odometry.
    pub odometry: MotionNoise,
    /// Distance after which a keyframe is taken, m.
    pub keyframe_distance_m: f64,
    /// Turn after which a keyframe is taken, rad.
    pub keyframe_turn_rad: f64,
    /// Parameters of loop closure.
    pub loops: SubmapLoopConfig,
}

/// Parameters of loop closure: registration of the newest keyframes on a submap of older ones.
///
/// Further numbers in a session file are former parameters that are constants now.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct SubmapLoopConfig {
    /// Number of newest keyframes registered together.
    pub bundle: usize,
    /// Smallest path length back to the keyframes of a submap, m.
    pub min_path_m: f64,
    /// Half width of the window in standard deviations of the relative pose.
    pub window_sigmas: f64,
    /// Largest half width of the window, m.
    pub max_window_m: f64,
    /// Largest half range of its headings, rad.
    pub max_turn_rad: f64,
    /// Score below which the keyframes do not fit, 0 to 1.
    pub min_score: f64,
    /// Smallest margin of the best pose to the best distinct one, 0 to 1.
    pub min_margin: f64,
    /// A loop within a window of this half width needs no confirmation, m.
    pub unconfirmed_gate_radius_m: f64,
    /// Otherwise it waits for confirmation over this path length, m.
    pub pending_distance_m: f64,
}

impl Default for SubmapLoopConfig {
    fn default() -> Self {
        Self {
            bundle: tuning::BUNDLE,
            min_path_m: 12.0,
            window_sigmas: tuning::WINDOW_SIGMAS,
            max_window_m: 20.0,
            max_turn_rad: tuning::MAX_TURN_RAD,
            min_score: tuning::MIN_LOOP_SCORE,
            min_margin: tuning::MIN_MARGIN,
            unconfirmed_gate_radius_m: tuning::UNCONFIRMED_M,
            pending_distance_m: tuning::PENDING_DISTANCE_M,
        }
    }
}

impl Default for RobotConfig {
    fn default() -> Self {
        Self {
            scan_cell_m: 0.065,
            scan_normal_radius_m: tuning::SCAN_NORMAL_RADIUS_M,
            window_sweeps: tuning::WINDOW_SCANS,
            window_distance_m: tuning::WINDOW_DISTANCE_M,
            normal_radius_m: tuning::NORMAL_RADIUS_M,
            max_correspondence_m: tuning::MAX_CORRESPONDENCE_M,
            inlier_distance_m: tuning::INLIER_DISTANCE_M,
            point_sigma_m: 0.025,
            independent_points: tuning::INDEPENDENT_POINTS,
            unseen_cost: tuning::UNSEEN_COST,
            good_score: tuning::GOOD_SCORE,
            search_m: tuning::SEARCH_M,
            search_rad: tuning::SEARCH_RAD,
            odometry: tuning::ODOMETRY,
            keyframe_distance_m: 0.65,
            keyframe_turn_rad: 0.35,
            loops: SubmapLoopConfig::default(),
        }
    }
}

impl RobotConfig {
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
    pub(crate) fn motion_noise(&self, is_measured: bool) -> &MotionNoise {
        if is_measured {
            &self.odometry
        } else {
            &tuning::CONSTANT_VELOCITY
        }
    }

    /// Settings for registering and scoring scans.
    #[must_use]
    pub fn registration(&self) -> MapRegistrationConfig {
        MapRegistrationConfig {
            normal_radius_m: self.normal_radius_m,
            max_correspondence_m: self.max_correspondence_m,
            inlier_distance_m: self.inlier_distance_m,
            point_sigma_m: self.point_sigma_m,
            independent_points: self.independent_points,
            unseen_cost: self.unseen_cost,
            good_score: self.good_score,
            search_m: self.search_m,
            search_rad: self.search_rad,
        }
    }
}

impl SlamConfig {
    /// The estimator for robots with the values for the scanner of `scan`.
    #[must_use]
    pub fn for_robot(scan: &LaserScan) -> Self {
        Self::from_robot(RobotConfig::for_scan(scan))
    }

    /// The estimator for robots with these values.
    #[must_use]
    pub fn from_robot(robot: RobotConfig) -> Self {
        let default = Self::default();
        Self {
            robot: Some(robot),
            scan: ScanConfig {
                cell_m: robot.scan_cell_m,
                normal_radius_m: robot.scan_normal_radius_m,
            },
            window_sweeps: robot.window_sweeps,
            window_distance_m: robot.window_distance_m,
            window_turn_rad: tuning::WINDOW_TURN_RAD,
            extrapolation: 1.0,
            keyframe_distance_m: robot.keyframe_distance_m,
            keyframe_turn_rad: robot.keyframe_turn_rad,
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
        let robot = RobotConfig {
            keyframe_distance_m: 1.25,
            window_sweeps: 9,
            ..RobotConfig::default()
        };
        let config = SlamConfig::from_robot(robot);
        assert_eq!(config.robot, Some(robot));
        assert_eq!(config.keyframe_distance_m, 1.25);
        assert_eq!(config.window_sweeps, 9);
    }
}
