//! The parameters of the estimator: those shared by both systems, and those of either.
//!
//! They lie below everything that computes with them; `slam`, `chapter` and `local_map` export their own.

mod chapter;
mod local_map;
mod motion_noise;
pub(crate) mod tuning;

use pr_geom::SE2;

use crate::graph::JacobianModel;
use crate::scan::ScanConfig;
pub use chapter::{ChapterConfig, DetectorKind, ThresholdConfig};
pub use local_map::{LocalMapConfig, MapRegistrationConfig, OdometryNoise, SubmapLoopConfig};
pub use motion_noise::MotionNoise;

/// Whether the back end closes loops.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum LoopClosure {
    /// Loops are detected, verified and closed.
    #[default]
    On,
    /// The front end alone: odometry edges only.
    Off,
}

/// The estimator's parameters.
///
/// [`SlamConfig::chapter`] has the chapter's, for its figures; the default corrects their faults, for rooms of the
/// chapter's size; [`SlamConfig::for_robot`] is the estimator for recorded logs.
#[derive(Clone, Debug, PartialEq)]
pub struct SlamConfig {
    /// The parameters of the estimator for robots, which registers scans with a prior and closes loops on
    /// submaps. `None` selects the chapter's system.
    pub local_map: Option<LocalMapConfig>,
    /// The parameters of the chapter's system; unused by the estimator for robots.
    pub chapter: ChapterConfig,
    /// Pose of the first frame, which defines the map's frame.
    pub start: SE2,
    /// How a scan becomes a cloud.
    pub scan: ScanConfig,
    /// Whether loops are closed.
    pub loop_closure: LoopClosure,
    /// Number of last sweeps in the local map.
    pub window_scans: usize,
    /// A sweep joins a full window only at this distance from the newest one in it, m: a standing robot
    /// keeps the map of its path.
    pub window_distance_m: f64,
    /// Or at this turn from the newest one, rad.
    pub window_turn_rad: f64,
    /// Registrations with fewer pairs are rejected, and the prediction is used.
    pub min_inliers: usize,
    /// Without odometry, constant velocity is assumed for at most this many times the last interval, because
    /// nearly equal stamps make it huge.
    pub extrapolation: f64,
    /// Distance in metres after which a keyframe is taken.
    pub keyframe_distance_m: f64,
    /// Turn in radians after which a keyframe is taken.
    pub keyframe_turn_rad: f64,
    /// Jacobians of the optimizer: with the chapter's it converges linearly, with the exact ones quadratically.
    pub jacobians: JacobianModel,
    /// A loop that would move no node farther than this (m + rad) only adds an edge; the next larger
    /// correction includes it. 0: optimize after every loop.
    pub least_correction: f64,
    /// Largest number of Gauss–Newton iterations after a loop.
    pub optimizer_iterations: usize,
    /// The optimizer stops if no node moves farther than this (m + rad).
    pub optimizer_tolerance: f64,
    /// Huber width on the Mahalanobis norm of an edge.
    pub huber: f64,
}

impl SlamConfig {
    /// The same system with loop closure off.
    #[must_use]
    pub fn without_loops(mut self) -> Self {
        self.loop_closure = LoopClosure::Off;
        self
    }
}
