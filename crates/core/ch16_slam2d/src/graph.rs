//! The pose graph: keyframe poses as nodes, measured relative poses as edges.
//!
//! Graph SLAM finds the poses that minimize
//!
//! ```text
//! χ² = Σ eᵀ Ω e,   e = log(Z⁻¹ Tᵢ⁻¹ Tⱼ)
//! ```
//!
//! over all edges `(i, j)` with measurement `Z` and information `Ω` (3×3, tangent order x, y, θ). The sum has no
//! factor ½ and no robust kernel. Fixed nodes fix the gauge. The solver is [`pr_optim`]. Poses and measurements
//! are stored once, in its [`Problem`]; this module adds handles and the origin of each measurement.
//!
//! Source: Grisetti, Kümmerle, Stachniss, Burgard, "A tutorial on graph-based SLAM", 2010.

mod covariances;
mod ids;
mod keyframe;
mod marginalize;

use nalgebra::Matrix3;
use pr_geom::SE2;
use pr_optim::robust::{InlierSelection, LOOP_CHI2, select_added};
use pr_optim::{Between, FactorUse, Method, OptimizeError, Optimizer, Problem, Report, Settings};
use serde::{Deserialize, Serialize};

pub use ids::{EdgeId, LoopId, NodeId};
pub use keyframe::Keyframe;
pub use marginalize::{MarginalizeError, Marginalized};
pub use pr_optim::{JacobianModel, RobustKernel, StopReason};

/// Origin of a measurement.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum EdgeKind {
    /// From one keyframe to the next, by scan matching or odometry; also the edges that replace marginalized
    /// nodes.
    Odometry,
    /// Between keyframes far apart in time, by place recognition.
    Loop,
}

/// A pose in the graph.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PoseNode {
    /// Present estimate, `world_from_body`.
    pub pose: SE2,
    /// Whether the solver keeps it fixed.
    pub fixed: bool,
}

/// A measured relative pose of two nodes.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PoseEdge {
    /// The measured pose of the target in the frame of the source.
    pub measurement: SE2,
    /// Inverse covariance of the residual, tangent order x, y, θ.
    pub information: Matrix3<f64>,
    /// Origin of the measurement.
    pub kind: EdgeKind,
}

impl PoseEdge {
    fn new(factor: &Between, kind: EdgeKind) -> Self {
        Self {
            measurement: factor.measurement,
            information: factor.information,
            kind,
        }
    }
}

/// An edge with its ends, as the iterators return it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct EdgeView {
    /// Handle of the edge. Not serialized: edges are numbered by their order.
    #[serde(skip)]
    pub id: EdgeId,
    /// The node from which the other was measured.
    pub from: NodeId,
    /// The measured node.
    pub to: NodeId,
    /// The measurement.
    pub edge: PoseEdge,
}

impl EdgeView {
    /// The loop that it measures; `None` for odometry.
    #[must_use]
    pub fn loop_id(&self) -> Option<LoopId> {
        let (old, new) = (self.from.index(), self.to.index());
        (self.edge.kind == EdgeKind::Loop).then_some(LoopId { old, new })
    }
}

/// Result of [`PoseGraph::inlier_edges`].
pub type InlierEdges = Result<InlierSelection, OptimizeError>;

/// Poses and measurements, with the solver's workspace.
#[derive(Debug)]
pub struct PoseGraph {
    problem: Problem,
    /// Origin of each factor of the problem.
    kinds: Vec<EdgeKind>,
    /// χ² at the present poses, updated by every new edge; `None` after a pose was moved.
    chi2: Option<f64>,
    optimizer: Optimizer,
}

impl Default for PoseGraph {
    fn default() -> Self {
        Self::new()
    }
}

impl Clone for PoseGraph {
    /// The clone solves to the same bits; it repeats the symbolic analysis when it is first solved.
    fn clone(&self) -> Self {
        Self {
            problem: self.problem.clone(),
            kinds: self.kinds.clone(),
            chi2: self.chi2,
            optimizer: Optimizer::new(self.optimizer.settings),
        }
    }
}

impl PoseGraph {
    /// An empty graph, solved with the chapter's Jacobians.
    #[must_use]
    pub fn new() -> Self {
        Self::with_jacobians(JacobianModel::Chapter)
    }

    /// An empty graph, solved with the given Jacobians.
    #[must_use]
    pub fn with_jacobians(jacobians: JacobianModel) -> Self {
        Self {
            problem: Problem::new(),
            kinds: Vec::new(),
            chi2: Some(0.0),
            optimizer: Optimizer::new(Settings {
                method: Method::GaussNewton,
                jacobians,
                factor_use: factor_use(jacobians),
                ..Settings::default()
            }),
        }
    }

    /// A graph of these nodes and edges, solved with the chapter's Jacobians; handles follow the order.
    ///
    /// # Panics
    /// If an edge's end does not exist, or both are the same.
    #[must_use]
    pub fn from_parts<'a>(
        nodes: impl IntoIterator<Item = &'a PoseNode>,
        edges: impl IntoIterator<Item = &'a EdgeView>,
    ) -> Self {
        let mut graph = Self::new();
        for node in nodes {
            if node.fixed {
                graph.add_fixed_node(node.pose);
            } else {
                graph.add_node(node.pose);
            }
        }
        for EdgeView { from, to, edge, .. } in edges {
            graph.add_edge(*from, *to, edge.measurement, edge.information, edge.kind);
        }
        graph
    }

    /// The same graph, solved with the given Jacobians from now on.
    #[must_use]
    pub fn solved_with(mut self, jacobians: JacobianModel) -> Self {
        self.optimizer.settings.jacobians = jacobians;
        self.optimizer.settings.factor_use = factor_use(jacobians);
        self
    }

    /// The Jacobians of the solver.
    #[must_use]
    pub fn jacobians(&self) -> JacobianModel {
        self.optimizer.settings.jacobians
    }

    /// Adds a free node.
    pub fn add_node(&mut self, pose: SE2) -> NodeId {
        NodeId::from(self.problem.add_pose(pose))
    }

    /// Adds a fixed node, which fixes the gauge.
    pub fn add_fixed_node(&mut self, pose: SE2) -> NodeId {
        NodeId::from(self.problem.add_fixed_pose(pose))
    }

    /// Adds the measured pose of `to` in the frame of `from`.
    ///
    /// # Panics
    /// If an end does not exist, or both ends are the same.
    pub fn add_edge(
        &mut self,
        from: impl Into<NodeId>,
        to: impl Into<NodeId>,
        measurement: SE2,
        information: Matrix3<f64>,
        kind: EdgeKind,
    ) -> EdgeId {
        self.problem.add_factor(Between {
            from: from.into().index(),
            to: to.into().index(),
            measurement,
            information,
        });
        self.kinds.push(kind);
        let edge = EdgeId::from(self.kinds.len() - 1);
        self.chi2 = self.chi2.map(|chi2| chi2 + self.edge_chi2(edge));
        edge
    }

    /// Removes the newest edge and returns it, or `None` if there is none.
    pub fn pop_edge(&mut self) -> Option<PoseEdge> {
        let factor = self.problem.pop_factor()?;
        self.chi2 = None;
        Some(PoseEdge::new(&factor, self.kinds.pop()?))
    }

    /// The present pose of a node.
    ///
    /// # Panics
    /// If the node does not exist.
    #[must_use]
    pub fn pose(&self, node: impl Into<NodeId>) -> SE2 {
        self.problem.poses()[node.into().index()]
    }

    /// Sets the pose of a node, for an initial guess.
    ///
    /// # Panics
    /// If the node does not exist.
    pub fn set_pose(&mut self, node: impl Into<NodeId>, pose: SE2) {
        self.problem.poses_mut()[node.into().index()] = pose;
        self.chi2 = None;
    }

    /// Number of nodes.
    #[must_use]
    pub fn node_count(&self) -> usize {
        self.problem.node_count()
    }

    /// Number of edges.
    #[must_use]
    pub fn edge_count(&self) -> usize {
        self.kinds.len()
    }

    /// Number of edges when a node was last moved: later ones wait for the next optimization.
    #[must_use]
    pub fn optimized_edges(&self) -> usize {
        self.problem.optimized_factors()
    }

    /// Sets [`optimized_edges`](Self::optimized_edges), after an optimization was reverted.
    pub fn mark_optimized(&mut self, edges: usize) {
        self.problem.mark_optimized(edges);
    }

    /// All nodes with their handles, in the order in which they were added.
    pub fn nodes(&self) -> impl ExactSizeIterator<Item = (NodeId, PoseNode)> + '_ {
        let nodes = self.problem.poses().iter().zip(self.problem.fixed());
        nodes
            .enumerate()
            .map(|(number, (&pose, &fixed))| (NodeId::from(number), PoseNode { pose, fixed }))
    }

    /// The poses of all nodes, by number.
    #[must_use]
    pub fn poses(&self) -> &[SE2] {
        self.problem.poses()
    }

    /// All edges with their ends, in the order in which they were added.
    pub fn edges(&self) -> impl ExactSizeIterator<Item = EdgeView> + '_ {
        let edges = self.problem.factors().iter().zip(&self.kinds);
        edges.enumerate().map(|(number, (factor, &kind))| EdgeView {
            id: EdgeId::from(number),
            from: NodeId::from(factor.from),
            to: NodeId::from(factor.to),
            edge: PoseEdge::new(factor, kind),
        })
    }

    /// `eᵀΩe` of one edge at the present poses.
    ///
    /// # Panics
    /// If the edge does not exist.
    #[must_use]
    pub fn edge_chi2(&self, edge: EdgeId) -> f64 {
        self.problem.factor_chi2(edge.index())
    }

    /// `χ² = Σ eᵀΩe` over all edges at the present poses, without kernel and factor ½.
    #[must_use]
    pub fn chi2(&self) -> f64 {
        self.chi2.unwrap_or_else(|| self.problem.chi2())
    }

    /// Gauss–Newton until the largest step of a node is below `tolerance` (m and rad added).
    ///
    /// The step rule is `‖(v_x, v_y)‖ + |ω| < tolerance`. The report holds the reason of the stop. If a
    /// step could not be computed, the poses are those before it.
    pub fn optimize(&mut self, max_iterations: usize, tolerance: f64) -> Report {
        self.optimize_robust(max_iterations, tolerance, f64::INFINITY)
    }

    /// [`PoseGraph::optimize`] with a Huber kernel of `huber` standard deviations.
    ///
    /// If the Mahalanobis norm `m` of a residual exceeds `huber`, Ω is scaled by `huber / m`.
    pub fn optimize_robust(&mut self, max_iterations: usize, tolerance: f64, huber: f64) -> Report {
        self.optimize_with(
            max_iterations,
            tolerance,
            RobustKernel::Huber { width: huber },
        )
    }

    /// [`PoseGraph::optimize`] with any robust kernel.
    pub fn optimize_with(
        &mut self,
        max_iterations: usize,
        tolerance: f64,
        kernel: RobustKernel,
    ) -> Report {
        self.optimizer.settings.kernel = kernel;
        self.optimizer.settings.max_iterations = max_iterations;
        self.optimizer.settings.step_tolerance = tolerance;
        let report = self.optimizer.run(&mut self.problem);
        self.chi2 = Some(report.chi2);
        report
    }

    /// One Gauss–Newton iteration; returns the largest step of a node (m and rad added).
    ///
    /// NaN if the step could not be computed, for example because of an indefinite information matrix.
    pub fn optimize_once(&mut self, huber: f64) -> f64 {
        self.optimizer.settings.kernel = RobustKernel::Huber { width: huber };
        self.chi2 = None;
        let step = self.optimizer.step(&mut self.problem);
        step.map_or(f64::NAN, |step| step.largest_step)
    }

    /// Selects the inlier edges if any loop may be false, from the present poses: see [`select_added`].
    ///
    /// # Errors
    /// If the normal equations cannot be solved.
    pub fn inlier_edges(&self) -> InlierEdges {
        let trusted: Vec<bool> = self
            .kinds
            .iter()
            .map(|kind| *kind != EdgeKind::Loop)
            .collect();
        let solver = Settings {
            jacobians: JacobianModel::Exact,
            factor_use: FactorUse::WhileStepsShrink,
            ..Settings::default()
        };
        select_added(&self.problem, &trusted, solver, LOOP_CHI2)
    }

    /// The same graph with only the edges for which `keep` is true.
    #[must_use]
    pub fn with_edges(&self, keep: impl FnMut(&EdgeView) -> bool) -> Self {
        let nodes: Vec<PoseNode> = self.nodes().map(|(_, node)| node).collect();
        let edges: Vec<EdgeView> = self.edges().filter(keep).collect();
        Self::from_parts(&nodes, &edges).solved_with(self.jacobians())
    }
}

/// The chapter's steps are plain Gauss–Newton, each with a new factor; with the exact Jacobians only the optimum
/// matters.
fn factor_use(jacobians: JacobianModel) -> FactorUse {
    match jacobians {
        JacobianModel::Chapter => FactorUse::EveryStep,
        JacobianModel::Exact => FactorUse::WhileStepsShrink,
    }
}

#[cfg(test)]
mod tests;
