//! The parameters that both ways of estimating share, and those of either.

use pr_geom::SE2;

use super::RobotConfig;
use crate::chapter::ChapterConfig;
use crate::graph::JacobianModel;
use crate::scan::ScanConfig;

/// Whether the back end looks for loops.
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
/// [`SlamConfig::chapter`] has the chapter's, for its figures; the default mends what they get
/// wrong, for rooms of the chapter's size; [`SlamConfig::for_scan`] takes the lengths from a sensor.
#[derive(Clone, Debug, PartialEq)]
pub struct SlamConfig {
    /// The numbers of the estimator for robots: they register scans with a prior and look for loops on
    /// submaps. None drives as the chapter does.
    pub robot: Option<RobotConfig>,
    /// The chapter's rules; robots drive without them.
    pub chapter: ChapterConfig,
    /// Pose of the first frame: it lays down the map's frame.
    pub start: SE2,
    /// How a scan becomes a cloud.
    pub scan: ScanConfig,
    /// Whether loops are closed.
    pub loop_closure: LoopClosure,
    /// Number of last sweeps in the local map.
    pub window_sweeps: usize,
    /// A sweep joins a full window only so far from the newest one in it, m: a robot that stands
    /// still keeps the map of the way there.
    pub window_distance_m: f64,
    /// Or where it is turned so far from the newest one, rad.
    pub window_turn_rad: f64,
    /// Registrations with fewer pairs are not believed: the prediction stands.
    pub min_inliers: usize,
    /// Without odometry the last velocity is expected to stay for so many times the last interval at
    /// most: stamps that all but coincide make it huge.
    pub extrapolation: f64,
    /// Distance in metres after which a keyframe is taken.
    pub keyframe_distance_m: f64,
    /// Turn in radians after which a keyframe is taken.
    pub keyframe_turn_rad: f64,
    /// Jacobians of the optimizer: with the chapter's the last steps shrink by a constant factor, with
    /// exact ones by their square.
    pub jacobians: JacobianModel,
    /// A loop that would move no node farther than this (m + rad) is an edge of the graph, and the next one that
    /// does corrects the graph with it; 0: each does.
    pub least_correction: f64,
    /// Most Gauss–Newton iterations after a loop.
    pub optimizer_iterations: usize,
    /// The optimizer stops where no node moves farther than this (m + rad).
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
