//! Every constant of the estimator.

use pr_geom::SE2;

use super::{MotionNoise, RobotConfig};
use crate::graph::JacobianModel;
use crate::loops::LoopConfig;
use crate::matching::{InformationFrame, MapConfig, MatcherKind, TrustConfig};
use crate::scan::ScanConfig;

/// A point's normal comes from its neighbours within so many cells.
///
/// A cell is 2.4 σ wide at least, so a wall through n cells has a normal that is off by
/// `σ √12 / (n cell √n)` = `1.44 / n^1.5` rad at most: 7.4° with the chapter's ratio, n = 5, and 3.4° here.
/// Normals that are off hold a sweep back along the wall, as pairs of points do.
pub(super) const NORMAL_RADIUS_CELLS: f64 = 4.2;

/// Whether the back end looks for loops.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum LoopClosure {
    /// Loops are detected, verified and closed.
    #[default]
    On,
    /// The front end alone: odometry edges only.
    Off,
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

/// The estimator's parameters.
///
/// [`SlamConfig::chapter`] has the chapter's, for its figures; the default mends what they get
/// wrong, for rooms of the chapter's size; [`SlamConfig::for_scan`] takes the lengths from a sensor.
#[derive(Clone, Debug, PartialEq)]
pub struct SlamConfig {
    /// The numbers of the estimator for robots: they register scans with a prior and look for loops on
    /// submaps. None drives as the chapter does.
    pub robot: Option<RobotConfig>,
    /// Pose of the first frame: it lays down the map's frame.
    pub start: SE2,
    /// How a scan becomes a cloud.
    pub scan: ScanConfig,
    /// Whether loops are closed.
    pub loop_closure: LoopClosure,
    /// What registers a scan on the local map.
    pub matcher: MatcherKind,
    /// Number of last sweeps in the local map.
    pub window_sweeps: usize,
    /// A sweep joins a full window only so far from the newest one in it, m: a robot that stands
    /// still keeps the map of the way there.
    pub window_distance_m: f64,
    /// Or where it is turned so far from the newest one, rad.
    pub window_turn_rad: f64,
    /// The local map.
    pub local_map: MapConfig,
    /// Most iterations of a registration against the local map.
    pub max_iterations: usize,
    /// Registrations with fewer pairs are not believed: the prediction stands.
    pub min_inliers: usize,
    /// Without odometry the last velocity is expected to stay for so many times the last interval at
    /// most: stamps that all but coincide make it huge.
    pub extrapolation: f64,
    /// The adaptive correspondence threshold.
    pub threshold: ThresholdConfig,
    /// Distance in metres after which a keyframe is taken.
    pub keyframe_distance_m: f64,
    /// Turn in radians after which a keyframe is taken.
    pub keyframe_turn_rad: f64,
    /// In which frame the information of edges is expressed.
    pub information_frame: InformationFrame,
    /// Trust in the edge between two keyframes.
    pub odometry_trust: TrustConfig,
    /// Trust in measured odometry, where the registration was refused.
    pub odometry_noise: MotionNoise,
    /// Trust in the guess of constant velocity, where there is no odometry either.
    pub prediction_noise: MotionNoise,
    /// Detection and verification of loops.
    pub loops: LoopConfig,
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

impl Default for SlamConfig {
    fn default() -> Self {
        let chapter = Self::chapter();
        Self {
            scan: ScanConfig {
                normal_radius_m: NORMAL_RADIUS_CELLS * chapter.scan.cell_m,
                ..chapter.scan
            },
            window_distance_m: 0.1,
            window_turn_rad: 0.1,
            information_frame: InformationFrame::Exact,
            loops: LoopConfig {
                candidates_tried: 3,
                ..chapter.loops
            },
            ..chapter
        }
    }
}

impl SlamConfig {
    /// The chapter's system: every sweep joins the window, one candidate is tried, and information is
    /// turned as in its figures.
    #[must_use]
    pub fn chapter() -> Self {
        Self {
            robot: None,
            start: SE2::identity(),
            scan: ScanConfig::default(),
            loop_closure: LoopClosure::On,
            matcher: MatcherKind::PointToPoint,
            window_sweeps: 6,
            window_distance_m: 0.0,
            window_turn_rad: 0.0,
            local_map: MapConfig {
                cell_m: 0.25,
                max_per_cell: 4,
            },
            max_iterations: 15,
            min_inliers: 8,
            extrapolation: f64::INFINITY,
            threshold: ThresholdConfig {
                initial_m: 0.5,
                min_motion_m: 0.03,
                max_range_m: 6.0,
            },
            keyframe_distance_m: 0.4,
            keyframe_turn_rad: 0.35,
            information_frame: InformationFrame::Chapter,
            odometry_trust: TrustConfig {
                sigma_m: 0.05,
                inflate: 12.0,
            },
            odometry_noise: MotionNoise::default(),
            prediction_noise: MotionNoise::without_odometry(),
            loops: LoopConfig::default(),
            jacobians: JacobianModel::Chapter,
            least_correction: 0.0,
            optimizer_iterations: 15,
            optimizer_tolerance: 1e-7,
            huber: 12.0,
        }
    }

    /// How far a motion is trusted that the wheels measured, or that nobody did.
    pub(crate) fn motion_noise(&self, is_measured: bool) -> &MotionNoise {
        if is_measured {
            &self.odometry_noise
        } else {
            &self.prediction_noise
        }
    }

    /// The same system with loop closure off.
    #[must_use]
    pub fn without_loops(mut self) -> Self {
        self.loop_closure = LoopClosure::Off;
        self
    }

    /// The same system with `matcher` for the front end and for loops.
    #[must_use]
    pub fn with_matcher(mut self, matcher: MatcherKind) -> Self {
        self.matcher = matcher;
        self.loops.matcher = matcher;
        self
    }
}
