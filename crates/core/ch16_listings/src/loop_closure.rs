//! Loop closure: candidates by distance, a registration, and two tests.

use nalgebra::{Vector2, Vector3};
use petgraph::graph::NodeIndex;

use crate::{
    EdgeKind, IcpConfig, PointCloud, PoseEdge, PoseGraph, SE2, Translation, VoxelMap, associate,
    icp, icp_information, regularize,
};
use ch16_slam2d::chi_squared::CHAPTER_GATE;

/// The constants of loop closure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LoopConfig {
    /// Candidates are within this distance in the graph, m.
    pub radius: f64,
    /// Candidates are at least this many nodes older.
    pub min_gap: usize,
    /// The submap holds this many nodes on either side of the candidate.
    pub half_width: usize,
    /// Cells of the submap, m, and points in each.
    pub submap: (f64, usize),
    /// Radius for the estimation of normals, m.
    pub normal_radius: f64,
    /// First test: largest accepted error of the fit, m.
    pub max_rmse: f64,
    /// First test: smallest accepted number of pairs.
    pub min_inliers: usize,
    /// Second test: drift per node, standard deviations, m and rad; it grows with √gap.
    pub drift: (f64, f64),
    /// Second test: largest accepted squared innovation.
    pub gate: f64,
    /// Noise of a point, m, and the covariance scale for correlated beams.
    pub trust: (f64, f64),
}

impl Default for LoopConfig {
    fn default() -> Self {
        Self {
            radius: 2.0,
            min_gap: 22,
            half_width: 3,
            submap: (0.25, 6),
            normal_radius: 0.3,
            max_rmse: 0.16,
            min_inliers: 25,
            drift: (0.045, 0.012),
            gate: CHAPTER_GATE,
            trust: (0.05, 25.0),
        }
    }
}

/// Result of the registration and of the tests.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VerifiedLoop {
    /// The edge from the candidate to the new node.
    pub edge: PoseEdge,
    /// Root mean square distance of the pairs, m.
    pub rmse: f64,
    /// Number of the pairs.
    pub inliers: usize,
    /// The squared innovation in units of the drift.
    pub chi2: f64,
    /// Whether both tests passed.
    pub accepted: bool,
}

/// Old nodes near `node` in the graph, nearest first.
#[must_use]
pub fn detect_loop_candidates(
    graph: &PoseGraph,
    node: NodeIndex,
    cfg: &LoopConfig,
) -> Vec<NodeIndex> {
    let here = graph.pose(node).translation();
    let distance = |old: &NodeIndex| (graph.pose(*old).translation() - here).norm();
    let mut candidates: Vec<NodeIndex> = graph
        .graph
        .node_indices()
        .filter(|old| old.index() + cfg.min_gap <= node.index())
        .filter(|old| distance(old) <= cfg.radius)
        .collect();
    candidates.sort_by(|a, b| distance(a).total_cmp(&distance(b)));
    candidates
}

/// Registers the sweep of `node` on the submap around `candidate`, and tests the result.
///
/// `sweeps[k]` is the sweep of node k, body frame, thinned.
#[must_use]
pub fn verify_loop(
    graph: &PoseGraph,
    sweeps: &[PointCloud],
    node: NodeIndex,
    candidate: NodeIndex,
    cfg: &LoopConfig,
) -> VerifiedLoop {
    let candidate_from_world = graph.pose(candidate).inverse();
    let map = submap(graph, sweeps, candidate, cfg);
    let belief = candidate_from_world * graph.pose(node);
    let sweep = &sweeps[node.index()];
    let settings = IcpConfig {
        tau: (cfg.radius / 2.0).max(0.6),
        max_iters: 30,
        ..IcpConfig::default()
    };
    let found = icp(sweep, &map, belief, &settings);

    let innovation = (belief.inverse() * found.pose).log();
    let gap = (node.index() - candidate.index()) as f64;
    let (xy, theta) = cfg.drift;
    let variances = gap * Vector3::new(xy * xy, xy * xy, theta * theta);
    let chi2 = innovation
        .component_mul(&innovation)
        .component_div(&variances)
        .sum();

    let pairs = associate(sweep, &map, &found.pose, settings.tau);
    let (sigma, inflate) = cfg.trust;
    VerifiedLoop {
        edge: PoseEdge {
            z: found.pose,
            omega: regularize(icp_information(&pairs, sigma, inflate), 1.0, 2500.0),
            kind: EdgeKind::Loop,
        },
        rmse: found.rmse,
        inliers: found.inliers,
        chi2,
        accepted: found.rmse <= cfg.max_rmse
            && found.inliers >= cfg.min_inliers.max(settings.min_pairs)
            && chi2 <= cfg.gate,
    }
}

/// The sweeps around a node at their poses in the graph, in the frame of that node.
#[must_use]
pub fn submap(
    graph: &PoseGraph,
    sweeps: &[PointCloud],
    center: NodeIndex,
    cfg: &LoopConfig,
) -> VoxelMap {
    let first = center.index().saturating_sub(cfg.half_width);
    let last = (center.index() + cfg.half_width).min(sweeps.len() - 1);
    let center_from_world = graph.pose(center).inverse();
    let mut map = VoxelMap::new(cfg.submap.0, cfg.submap.1);
    for (k, sweep) in sweeps.iter().enumerate().take(last + 1).skip(first) {
        let pose = graph.pose(NodeIndex::new(k));
        let normals = sweep.normals(cfg.normal_radius);
        // Through the world frame: the last bit decides which cell a point on an edge belongs to.
        let in_center = sweep.transformed(&pose).transformed(&center_from_world);
        let turn = SE2::new(Vector2::zeros(), pose.theta() + center_from_world.theta());
        let turned: Vec<_> = normals.iter().map(|n| n.map(|n| turn.rotate(&n))).collect();
        map.insert(&in_center.points, &turned);
    }
    map
}
