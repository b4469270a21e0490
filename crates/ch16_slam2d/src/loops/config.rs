//! The constants of loop closure; the defaults are the chapter's.

use pr_geom::math;

use super::LoopGuard;
use crate::chi_squared::CHAPTER_GATE;
use crate::matching::{MapConfig, MatcherKind, SearchMatcherConfig, TrustConfig};
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

/// A search of a whole window, for a robot that has not seen a known place for long.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WideSearch {
    /// Grid, score and refinement; the window's width follows from the drift.
    pub matcher: SearchMatcherConfig,
    /// It is made once the way since the last loop is longer than this, m.
    pub min_way_m: f64,
    /// And again so much of the way after the last one, m; 0: at every attempt.
    pub every_m: f64,
    /// At most so many candidates are searched at a node.
    pub candidates: usize,
    /// A best place whose score is ahead of the best other place by less is no loop.
    pub min_margin: f64,
    /// A search whose score is lower is no loop.
    pub min_score: f64,
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
    /// Share of what a loop knows across a wall that it claims along it by noise alone; see
    /// [`without_aperture`](crate::matching::without_aperture).
    pub aperture: f64,
    /// Drift for each metre since the last loop that goes one way, as that of a wheel of the wrong size: candidates
    /// are looked for so much farther, and the gate is half of it wider, a standard deviation.
    pub drift_share: f64,
    /// The radius grows with the drift up to this, m.
    pub max_radius_m: f64,
    /// What is done where every candidate was turned away.
    pub search: Option<WideSearch>,
    /// Who is believed at once, and who waits; without it every loop that passes is closed at once.
    pub guard: Option<LoopGuard>,
    /// What the gate takes for the drift; the two fields below belong to the path approximation.
    pub gate_model: GateModel,
    /// Drift of x and of y over one node, a standard deviation in metres; grows with √gap.
    pub drift_sigma_m: f64,
    /// Drift of the heading over one node, a standard deviation in radians; grows with √gap.
    pub drift_sigma_rad: f64,
    /// The largest squared innovation that is believed; see [`CHAPTER_GATE`].
    pub gate_chi2: f64,
}

impl LoopConfig {
    /// Other places are looked for so far behind the best one: twice as far as they have to be.
    ///
    /// The farther, the more of a window has to be searched, for a number that decides nothing.
    #[must_use]
    pub fn max_margin(&self) -> f64 {
        let search = self.search.map_or(0.0, |search| search.min_margin);
        let guard = self.guard.map_or(0.0, |guard| guard.min_margin);
        2.0 * math::max(search, guard)
    }
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
                inflate: 25.0,
            },
            aperture: 0.0,
            drift_share: 0.0,
            max_radius_m: f64::INFINITY,
            search: None,
            guard: None,
            gate_model: GateModel::PathApproximation,
            drift_sigma_m: 0.045,
            drift_sigma_rad: 0.012,
            gate_chi2: CHAPTER_GATE,
        }
    }
}
