//! The constants of the chapter's rules.

use pr_geom::SE2;

use super::{LoopClosure, MotionNoise, SlamConfig};
use crate::graph::JacobianModel;
use crate::icp::INFORMATION_CAP;
use crate::loops::LoopConfig;
use crate::matching::{InformationFrame, MapConfig, MatcherKind, TrustConfig};
use crate::places::PlaceDetectorConfig;
use crate::scan::ScanConfig;

/// Radius of the neighbours for a point's normal, in cells.
///
/// A cell is at least 2.4 σ wide, so the normal of a wall through n cells has an error of at most
/// `σ √12 / (n cell √n)` = `1.44 / n^1.5` rad: 7.4° with the chapter's ratio, n = 5, and 3.4° here.
/// Wrong normals hold a sweep back along the wall, as point pairs do.
const NORMAL_RADIUS_CELLS: f64 = 4.2;

/// The adaptive correspondence threshold (Vizzo et al., "KISS-ICP", 2023, §III-B).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ThresholdConfig {
    /// Threshold in metres until there are three corrections.
    pub initial_m: f64,
    /// Smaller corrections (m) are ignored.
    pub min_motion_m: f64,
    /// Range at which a rotation is converted to a displacement, in metres.
    pub max_range_m: f64,
}

/// The source of loop candidates.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub enum DetectorKind {
    /// The chapter's: keyframes that are near in the graph.
    #[default]
    Nearby,
    /// Keyframes of similar appearance, wherever they are in the graph.
    Place(PlaceDetectorConfig),
}

/// Registration, edge information and loop closure of the chapter; the default is its own lap.
#[derive(Clone, Debug, PartialEq)]
pub struct ChapterConfig {
    /// Registers a scan on the local map.
    pub matcher: MatcherKind,
    /// The local map.
    pub local_map: MapConfig,
    /// Largest number of iterations of a registration against the local map.
    pub max_iterations: usize,
    /// The adaptive correspondence threshold.
    pub threshold: ThresholdConfig,
    /// In which frame the information of edges is expressed.
    pub information_frame: InformationFrame,
    /// Covariance scale and noise for the edge between two keyframes.
    pub odometry_trust: TrustConfig,
    /// Noise of measured odometry, if the registration was rejected.
    pub odometry_noise: MotionNoise,
    /// Noise of the constant-velocity prediction, if there is no odometry either.
    pub prediction_noise: MotionNoise,
    /// The source of loop candidates.
    pub detector: DetectorKind,
    /// Detection among near keyframes, and verification of loops.
    pub loops: LoopConfig,
}

impl Default for ChapterConfig {
    fn default() -> Self {
        Self {
            matcher: MatcherKind::PointToPoint,
            local_map: MapConfig {
                cell_m: 0.25,
                max_per_cell: 4,
            },
            max_iterations: 15,
            threshold: ThresholdConfig {
                initial_m: 0.5,
                min_motion_m: 0.03,
                max_range_m: 6.0,
            },
            information_frame: InformationFrame::Chapter,
            odometry_trust: TrustConfig {
                sigma_m: 0.05,
                covariance_scale: 12.0,
                information_cap: INFORMATION_CAP,
            },
            odometry_noise: MotionNoise::default(),
            prediction_noise: MotionNoise::without_odometry(),
            detector: DetectorKind::Nearby,
            loops: LoopConfig::default(),
        }
    }
}

impl ChapterConfig {
    /// Noise of a motion that was measured by odometry, or predicted.
    pub(crate) fn motion_noise(&self, is_measured: bool) -> &MotionNoise {
        if is_measured {
            &self.odometry_noise
        } else {
            &self.prediction_noise
        }
    }
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
            chapter: ChapterConfig {
                information_frame: InformationFrame::Exact,
                loops: LoopConfig {
                    candidates_tried: 3,
                    ..chapter.chapter.loops
                },
                ..chapter.chapter
            },
            ..chapter
        }
    }
}

impl SlamConfig {
    /// The chapter's system: every sweep joins the window, one candidate is tested, and the information is
    /// rotated as in its figures.
    #[must_use]
    pub fn chapter() -> Self {
        Self {
            local_map: None,
            chapter: ChapterConfig::default(),
            start: SE2::identity(),
            scan: ScanConfig::default(),
            loop_closure: LoopClosure::On,
            window_scans: 6,
            window_distance_m: 0.0,
            window_turn_rad: 0.0,
            min_inliers: 8,
            extrapolation: f64::INFINITY,
            keyframe_distance_m: 0.4,
            keyframe_turn_rad: 0.35,
            jacobians: JacobianModel::Chapter,
            least_correction: 0.0,
            optimizer_iterations: 15,
            optimizer_tolerance: 1e-7,
            huber: 12.0,
        }
    }

    /// The chapter's system with `matcher` for the front end and for loops.
    #[must_use]
    pub fn with_matcher(mut self, matcher: MatcherKind) -> Self {
        self.chapter.matcher = matcher;
        self.chapter.loops.matcher = matcher;
        self
    }
}
