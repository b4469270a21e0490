//! The numbers of the estimator for recorded logs that no owner of a robot has to know, each with what chose it.
//!
//! "No effect" means: at half and at twice the value the mean error of the relations on the Intel log, 73 mm, changes by
//! 1 mm at most. Its stamps are inferred, so differences below 10 mm are not significant. Numbers without a measurement
//! say so.

use super::MotionNoise;

/// Radius of the neighbours for normals within one scan, m, per degree between beams. No effect.
pub(crate) const SCAN_NORMAL_RADIUS_M: f64 = 0.5;
/// Number of last scans in the local map. No effect.
pub(crate) const WINDOW_SCANS: usize = 16;
/// A scan joins the local map at this distance from the newest one, m. No effect.
pub(crate) const WINDOW_DISTANCE_M: f64 = 0.16;
/// Or at this turn from it, rad. The error is the same for a tenth and for a half.
pub(crate) const WINDOW_TURN_RAD: f64 = 0.1;

/// Odometry of a common indoor robot; slip is covered by the tails of the prior. No effect of any of the six.
pub(crate) const ODOMETRY: MotionNoise = MotionNoise {
    floor_m: 0.01,
    per_metre: 0.05,
    metre_per_rad: 0.03,
    floor_rad: 0.005,
    per_rad: 0.05,
    rad_per_metre: 0.025,
};
/// Constant-velocity prediction: if scans are a metre or half a radian apart, it is hardly informative.
pub(crate) const CONSTANT_VELOCITY: MotionNoise = MotionNoise {
    floor_m: 0.1,
    per_metre: 0.3,
    metre_per_rad: 0.1,
    floor_rad: 0.1,
    per_rad: 1.0,
    rad_per_metre: 0.1,
};

/// Radius of the neighbours for normals of the local map, m. No effect.
pub(crate) const NORMAL_RADIUS_M: f64 = 0.3;
/// Largest distance of a pair in the first stage of a registration, m. No effect.
pub(crate) const MAX_CORRESPONDENCE_M: f64 = 0.3;
/// Largest distance of a pair in the last stage, and of an inlier, m. No effect.
pub(crate) const INLIER_DISTANCE_M: f64 = 0.15;
/// Number of independent points of a scan. No effect on Intel; on other logs no constant is right: 10 mends some with
/// repeated structure and ruins fr079.
pub(crate) const INDEPENDENT_POINTS: f64 = 28.0;
/// Cost of a point in unseen space, as a share of a miss. No effect.
pub(crate) const UNSEEN_COST: f64 = 0.4;
/// Score below which other starts and the window are searched. No effect.
pub(crate) const GOOD_SCORE: f64 = 0.8;
/// Half the width of that window, m, and its range of headings, rad. No effect.
pub(crate) const SEARCH_M: f64 = 1.1;
pub(crate) const SEARCH_RAD: f64 = 1.6;

/// A correction that moves no node farther (m + rad) waits for the next larger one. Not measured.
pub(crate) const LEAST_CORRECTION: f64 = 0.05;

/// Loops are searched at every this many keyframes: more often costs time and closes no more. At 12 the error of aces with
/// 90° of view is 0.18 m in place of 0.10, because three loops rarely lie close enough to confirm each other; 12 only after
/// a search that closed one moves edmonton by 0.08 m.
pub(crate) const EVERY_KEYFRAMES: usize = 3;
/// Number of newest keyframes registered together. No effect.
pub(crate) const BUNDLE: usize = 8;
/// Cell of their thinning, m. Not measured.
pub(crate) const BUNDLE_CELL_M: f64 = 0.15;
/// Number of submaps tested at a keyframe, the nearest first. Not measured.
pub(crate) const SUBMAPS: usize = 2;
/// Smallest number of keyframes on either side of the nearest one in a submap. Not measured.
pub(crate) const HALF_SUBMAP: usize = 8;
/// Submaps hold keyframes up to this far beyond the window, m: about the size of a room.
pub(crate) const SUBMAP_MARGIN_M: f64 = 4.0;
/// Half width of the window in standard deviations of the relative pose. No effect on Intel; campus misses its last
/// loop.
pub(crate) const WINDOW_SIGMAS: f64 = 3.4;
/// Added to that half width, m, and to its range of headings, rad. Not measured.
pub(crate) const WINDOW_FLOOR_M: f64 = 0.3;
pub(crate) const WINDOW_FLOOR_RAD: f64 = 0.06;
/// Largest half range of its headings, rad. No effect.
pub(crate) const MAX_TURN_RAD: f64 = 0.5;
/// Score below which the keyframes do not fit: at twice the value no loop closes, and Intel's error is .30 m.
pub(crate) const MIN_LOOP_SCORE: f64 = 0.6;
/// Smallest margin of the best pose to the best distinct one. No effect.
pub(crate) const MIN_MARGIN: f64 = 0.03;
/// A loop within a window of this half width needs no confirmation, m. No effect.
pub(crate) const UNCONFIRMED_M: f64 = 1.0;
/// Otherwise it waits for confirmation over this path length, m. No effect.
pub(crate) const PENDING_DISTANCE_M: f64 = 20.0;
/// Smallest path length between loops that confirm each other, m: their keyframes are not the same.
pub(crate) const MIN_SEPARATION_M: f64 = 5.0;
/// Number of agreeing loops needed within the gate, and for loops that contradict the graph. Not measured.
pub(crate) const AGREEING_EXPECTED: usize = 2;
pub(crate) const AGREEING_CONTRADICTING: usize = 3;
/// Smallest information of a loop in any direction, 1/m² and 1/rad²: a metre, a radian.
pub(crate) const LOOP_FLOOR: f64 = 1.0;

/// Rounds of linking and optimizing at the end of a run. Not measured, as the next seven.
pub(crate) const LINK_PASSES: usize = 2;
/// Keyframes within this distance are linked, m.
pub(crate) const LINK_RADIUS_M: f64 = 4.0;
/// Keyframes are linked if they are at least this many nodes apart.
pub(crate) const LINK_GAP_NODES: usize = 10;
/// Largest number of visits linked with a keyframe, the nearest first.
pub(crate) const LINK_VISITS: usize = 3;
/// A visit is the nearest keyframe with this many on either side.
pub(crate) const HALF_VISIT: usize = 3;
/// Expected shift of a keyframe by a link, standard deviations for the gate.
pub(crate) const LINK_SHIFT_M: f64 = 0.15;
pub(crate) const LINK_SHIFT_RAD: f64 = 0.05;
/// Score below which a keyframe does not fit.
pub(crate) const MIN_LINK_SCORE: f64 = 0.7;
/// Width of the robust cost of a round, in standard deviations of an edge.
pub(crate) const LINK_HUBER: f64 = 3.0;
/// Search window of a requested loop: its half width in standard deviations, and the limits of both halves.
pub(crate) const REQUEST_SIGMAS: f64 = 3.0;
pub(crate) const REQUEST_M: f64 = 6.0;
pub(crate) const REQUEST_RAD: f64 = 0.5;
