//! The estimator for recorded logs of robots: its numbers, and the system that they make.

use serde::{Deserialize, Serialize};

use super::config::SlamConfig;
use super::motion_noise::MotionNoise;
use crate::graph::JacobianModel;
use crate::local_map::MapRegistrationConfig;
use crate::scan::{LaserScan, ScanConfig};

/// Radius within which points of one scan give each other normals, m, for each degree from beam to beam.
const SCAN_NORMAL_RADIUS_M: f64 = 0.5;

/// A scan joins the local map where it is turned so far from the newest one, rad: a tenth or a half, the
/// errors are the same.
const WINDOW_TURN_RAD: f64 = 0.1;
/// Wheels of a common indoor robot; what slips is left to the tails of the prior.
const WHEELS: MotionNoise = MotionNoise {
    floor_m: 0.01,
    per_metre: 0.05,
    metre_per_rad: 0.03,
    floor_rad: 0.005,
    per_rad: 0.05,
    rad_per_metre: 0.025,
};

/// A robot that goes on as before: where scans are a metre or half a radian apart, it may as well not.
const CONSTANT_VELOCITY: MotionNoise = MotionNoise {
    floor_m: 0.1,
    per_metre: 0.3,
    metre_per_rad: 0.1,
    floor_rad: 0.1,
    per_rad: 1.0,
    rad_per_metre: 0.1,
};

/// Every number of the estimator for robots.
///
/// One set of values for planar lasers on wheels, in rooms, corridors and out of doors. Lengths are in
/// metres. `docs/robots.md` says what it does on recorded logs, `docs/robots-parameters.md` what each
/// number does.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct RobotConfig {
    /// A scan is thinned to a point in each cell of this side, m.
    pub scan_cell_m: f64,
    /// Radius within which points of one scan give each other normals, m.
    pub scan_normal_radius_m: f64,
    /// Last scans in the local map.
    pub window_sweeps: usize,
    /// A scan joins the local map only so far from the newest one in it, m.
    pub window_distance_m: f64,
    /// Radius within which points of the local map give each other normals, m.
    pub normal_radius_m: f64,
    /// Largest distance of a pair in the first stage of a registration, m.
    pub max_correspondence_m: f64,
    /// Largest distance of a pair in the last stage, and of a point that fits, m.
    pub inlier_distance_m: f64,
    /// Standard deviation of a point across its wall, m.
    pub point_sigma_m: f64,
    /// A scan counts as so many independent points.
    pub independent_points: f64,
    /// What a point in space that was never seen costs, as a share of a miss.
    pub unseen_cost: f64,
    /// With a lower score the window around the prediction is searched, 0 to 1.
    pub good_score: f64,
    /// Half the width of that window, m.
    pub search_m: f64,
    /// Half its range of headings, rad.
    pub search_rad: f64,
    /// How far the wheels are trusted.
    pub odometry: MotionNoise,
    /// Distance after which a keyframe is taken, m.
    pub keyframe_distance_m: f64,
    /// Turn after which a keyframe is taken, rad.
    pub keyframe_turn_rad: f64,
    /// How loops are found.
    pub loops: SubmapLoopConfig,
}

/// How loops are found: the newest keyframes on a submap of older ones.
///
/// What a session's file has beyond these numbers was one once and is a constant now.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct SubmapLoopConfig {
    /// The newest so many keyframes are looked for together.
    pub bundle: usize,
    /// On submaps of older keyframes, at least so much of the path ago, m.
    pub min_path_m: f64,
    /// The window is so many standard deviations of the relative pose wide.
    pub window_sigmas: f64,
    /// Half the window's width at most, m.
    pub max_window_m: f64,
    /// Half its range of headings at most, rad.
    pub max_turn_rad: f64,
    /// Score below which the keyframes do not fit, 0 to 1.
    pub min_score: f64,
    /// The best place has to be ahead of the best other one by so much, 0 to 1.
    pub min_margin: f64,
    /// A loop within a window of this half width needs no other one that agrees, m.
    pub unconfirmed_gate_radius_m: f64,
    /// Else it waits for one on so much of the path, m.
    pub pending_distance_m: f64,
}

impl Default for SubmapLoopConfig {
    fn default() -> Self {
        Self {
            bundle: 8,
            min_path_m: 12.0,
            window_sigmas: 3.4,
            max_window_m: 20.0,
            max_turn_rad: 0.5,
            min_score: 0.6,
            min_margin: 0.03,
            unconfirmed_gate_radius_m: 1.0,
            pending_distance_m: 20.0,
        }
    }
}

impl Default for RobotConfig {
    fn default() -> Self {
        Self {
            scan_cell_m: 0.065,
            scan_normal_radius_m: SCAN_NORMAL_RADIUS_M,
            window_sweeps: 16,
            window_distance_m: 0.16,
            normal_radius_m: 0.3,
            max_correspondence_m: 0.3,
            inlier_distance_m: 0.15,
            point_sigma_m: 0.025,
            independent_points: 28.0,
            unseen_cost: 0.4,
            good_score: 0.8,
            search_m: 1.1,
            search_rad: 1.6,
            odometry: WHEELS,
            keyframe_distance_m: 0.65,
            keyframe_turn_rad: 0.35,
            loops: SubmapLoopConfig::default(),
        }
    }
}

impl RobotConfig {
    /// The values for a scanner, of which only the angle from beam to beam is asked: normals need
    /// neighbours.
    #[must_use]
    pub fn for_scan(scan: &LaserScan) -> Self {
        let step_deg = scan.angle_step_rad.abs().to_degrees();
        Self {
            scan_normal_radius_m: SCAN_NORMAL_RADIUS_M * step_deg.clamp(1.0, 1.4),
            ..Self::default()
        }
    }

    /// How far a motion is trusted that the odometry measured, or that none did.
    pub(crate) fn motion_noise(&self, is_measured: bool) -> &MotionNoise {
        if is_measured {
            &self.odometry
        } else {
            &CONSTANT_VELOCITY
        }
    }

    /// How scans are registered and scored.
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
            window_turn_rad: WINDOW_TURN_RAD,
            extrapolation: 1.0,
            keyframe_distance_m: robot.keyframe_distance_m,
            keyframe_turn_rad: robot.keyframe_turn_rad,
            jacobians: JacobianModel::Exact,
            least_correction: 0.05,
            ..default
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_estimator_for_robots_has_the_numbers_that_it_was_given() {
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
