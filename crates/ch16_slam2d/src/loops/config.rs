//! The constants of loop closure; the defaults are the chapter's.

use crate::chi_squared::CHAPTER_GATE;
use crate::matching::{MapConfig, MatcherKind, TrustConfig};
use crate::places::PlaceDetectorConfig;

/// What the gate takes for the drift between two nodes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum GateModel {
    /// The chapter's: a diagonal covariance that grows with the number of nodes on the path.
    #[default]
    PathApproximation,
    /// The exact covariance of the relative pose in the graph, earlier loops included.
    ///
    /// It is only as honest as the information of the edges: scan matching that is too sure of
    /// itself makes this gate turn away good loops.
    ExactMarginal,
}

/// Which of the near keyframes are proposed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Detection {
    /// The chapter's: all of them, the nearest first.
    #[default]
    Nearest,
    /// The nearest of every visit: of each run of keyframes that passed by.
    Visits,
}

/// Who proposes loops.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub enum DetectorKind {
    /// The chapter's: what is near in the graph.
    #[default]
    Nearby,
    /// What looks alike, wherever it is in the graph.
    Place(PlaceDetectorConfig),
}

/// Detection, verification and gating of loops; the defaults are the chapter's.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LoopConfig {
    /// Who proposes loops; the next two fields belong to what is near.
    pub detector: DetectorKind,
    /// Which of the near keyframes are proposed.
    pub detection: Detection,
    /// Candidates lie within this distance of the new node in the graph, m.
    pub radius_m: f64,
    /// Candidates are at least so many nodes older.
    pub min_gap_nodes: usize,
    /// At most one attempt in so many nodes.
    pub attempt_every_nodes: usize,
    /// At most so many candidates are verified at a node, best first; the first that passes is closed.
    pub candidates_tried: usize,
    /// The submap holds the candidate and so many nodes on either side of it.
    pub submap_half_width: usize,
    /// The submap.
    pub submap: MapConfig,
    /// What registers the new sweep on the submap.
    pub matcher: MatcherKind,
    /// Most iterations of the registration against the submap.
    pub max_iterations: usize,
    /// Correspondence distance in metres, unless half the radius is more.
    pub min_tau_m: f64,
    /// A registration that fits worse than this is turned away, m.
    pub max_rmse_m: f64,
    /// A registration with fewer pairs is turned away.
    pub min_inliers: usize,
    /// A registration whose score is lower is turned away, in the unit of the matcher's score.
    pub min_score: f64,
    /// Trust in the pairs of an accepted loop.
    pub trust: TrustConfig,
    /// What the gate takes for the drift; the two fields below belong to the path approximation.
    pub gate_model: GateModel,
    /// Drift of x and of y over one node, a standard deviation in metres; grows with √gap.
    pub drift_sigma_m: f64,
    /// Drift of the heading over one node, a standard deviation in radians; grows with √gap.
    pub drift_sigma_rad: f64,
    /// The largest squared innovation that is believed; see [`CHAPTER_GATE`].
    pub gate_chi2: f64,
}

impl Default for LoopConfig {
    fn default() -> Self {
        Self {
            detector: DetectorKind::Nearby,
            detection: Detection::Nearest,
            radius_m: 2.0,
            min_gap_nodes: 22,
            attempt_every_nodes: 4,
            candidates_tried: 1,
            submap_half_width: 3,
            submap: MapConfig {
                cell_m: 0.25,
                max_per_cell: 6,
            },
            matcher: MatcherKind::PointToPoint,
            max_iterations: 30,
            min_tau_m: 0.6,
            max_rmse_m: 0.16,
            min_inliers: 25,
            min_score: 0.0,
            trust: TrustConfig {
                sigma_m: 0.05,
                covariance_scale: 25.0,
            },
            gate_model: GateModel::PathApproximation,
            drift_sigma_m: 0.045,
            drift_sigma_rad: 0.012,
            gate_chi2: CHAPTER_GATE,
        }
    }
}
