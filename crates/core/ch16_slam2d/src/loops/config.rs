//! The constants of loop closure; the defaults are the chapter's.

use crate::chi_squared::CHAPTER_GATE;
use crate::icp::INFORMATION_CAP;
use crate::matching::{MapConfig, MatcherKind, TrustConfig};

/// The drift between two nodes that the gate assumes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum GateModel {
    /// The chapter's: a diagonal covariance that grows with the number of nodes on the path.
    #[default]
    PathApproximation,
    /// The exact covariance of the relative pose in the graph, earlier loops included.
    ///
    /// It is only as accurate as the information of the edges: overconfident scan matching makes this gate
    /// reject true loops.
    ExactMarginal,
}

/// Detection, verification and gating of loops; the defaults are the chapter's.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LoopConfig {
    /// Candidates are within this distance of the new node in the graph, m.
    pub radius_m: f64,
    /// Candidates are at least this many nodes older.
    pub min_gap_nodes: usize,
    /// At most one attempt in this many nodes.
    pub attempt_every_nodes: usize,
    /// Largest number of candidates verified at a node, best first; the first that passes is closed.
    pub candidates_tried: usize,
    /// The submap holds the candidate and this many nodes on either side of it.
    pub submap_half_width: usize,
    /// The submap.
    pub submap: MapConfig,
    /// Registers the new sweep on the submap.
    pub matcher: MatcherKind,
    /// Largest number of iterations of the registration on the submap.
    pub max_iterations: usize,
    /// Smallest correspondence distance in metres; half the radius is used if it is larger.
    pub min_tau_m: f64,
    /// Largest error of an accepted registration, m.
    pub max_rmse_m: f64,
    /// Smallest number of pairs of an accepted registration.
    pub min_inliers: usize,
    /// Smallest score of an accepted registration, in the unit of the matcher's score.
    pub min_score: f64,
    /// Covariance scale and noise for the pairs of an accepted loop.
    pub trust: TrustConfig,
    /// The assumed drift; the two fields below belong to the path approximation.
    pub gate_model: GateModel,
    /// Drift of x and of y over one node, a standard deviation in metres; grows with √gap.
    pub drift_sigma_m: f64,
    /// Drift of the heading over one node, a standard deviation in radians; grows with √gap.
    pub drift_sigma_rad: f64,
    /// The largest accepted squared innovation; see [`CHAPTER_GATE`].
    pub gate_chi2: f64,
}

impl Default for LoopConfig {
    fn default() -> Self {
        Self {
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
                information_cap: INFORMATION_CAP,
            },
            gate_model: GateModel::PathApproximation,
            drift_sigma_m: 0.045,
            drift_sigma_rad: 0.012,
            gate_chi2: CHAPTER_GATE,
        }
    }
}
