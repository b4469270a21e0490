//! The map: keyframes and the pose graph.

use std::sync::Arc;

use nalgebra::{Matrix2, Matrix3};
use pr_geom::SE2;
use pr_optim::{OptimizeError, StopReason};

use super::report::{Change, LoopEffect};
use super::snapshot::SlamSnapshot;
use crate::cloud::PointCloud;
use crate::config::SlamConfig;
use crate::graph::{
    EdgeKind, EdgeView, InlierEdges, Keyframe, MarginalizeError, Marginalized, PoseGraph,
};
use crate::loops::{LoopQuery, LoopRejection, LoopVerification};
use crate::metrics::position_error_m;
use crate::scan::PreparedFrame;

/// Selects the inlier edges of a graph in which any loop may be false, such as [`PoseGraph::inlier_edges`].
pub type LoopOutlierTest = fn(&PoseGraph) -> InlierEdges;

/// How the graph is optimized.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Optimization {
    /// A loop that would move no node farther than this only adds an edge, m + rad.
    least_correction: f64,
    /// Largest number of iterations.
    iterations: usize,
    /// The optimizer stops if no node moves farther than this, m + rad.
    tolerance: f64,
    /// Huber width on the Mahalanobis norm of an edge.
    huber: f64,
}

/// Consistency of new loops with the graph.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Consistency {
    /// They are consistent with it.
    #[default]
    Expected,
    /// They contradict it: the outlier test runs over all loops.
    Contradicting,
}

/// What became of loops that were passed to the map.
#[derive(Clone, Debug)]
pub(super) struct Closed {
    /// The effect on the graph, if it was changed.
    pub effect: Option<LoopEffect>,
    /// For each loop in order why it is not in the graph; `None` if it is.
    pub rejections: Vec<Option<LoopRejection>>,
}

/// How the graph was solved with new loops.
enum Solution {
    /// The correction is so small that it waits for the next loop.
    Postponed,
    Optimized {
        iterations: usize,
    },
    /// The outlier test found the poses, and which of the new loops belong to them.
    Selected {
        is_inlier: Vec<bool>,
    },
}

/// Keyframes and pose graph; node k is keyframe k.
#[derive(Clone)]
pub struct Mapper {
    graph: PoseGraph,
    keyframes: Vec<Keyframe>,
    /// The newest node at which a loop was closed; the first before any was.
    last_loop_node: usize,
    chi2: f64,
    outlier_test: Option<LoopOutlierTest>,
    config: Optimization,
}

impl Mapper {
    pub(super) fn new(config: &SlamConfig, outlier_test: Option<LoopOutlierTest>) -> Self {
        Self {
            graph: PoseGraph::with_jacobians(config.jacobians),
            keyframes: Vec::new(),
            last_loop_node: 0,
            chi2: 0.0,
            outlier_test,
            config: Optimization {
                least_correction: config.least_correction,
                iterations: config.optimizer_iterations,
                tolerance: config.optimizer_tolerance,
                huber: config.huber,
            },
        }
    }

    /// Continues with the map of a snapshot.
    pub(super) fn restore(&mut self, snapshot: &SlamSnapshot) {
        self.graph = PoseGraph::from_parts(&snapshot.nodes, &snapshot.edges)
            .solved_with(snapshot.config.jacobians);
        self.graph.mark_optimized(snapshot.optimized_edges);
        self.keyframes.clone_from(&snapshot.keyframes);
        self.last_loop_node = snapshot.last_loop_node;
        self.chi2 = self.graph.chi2();
    }

    /// The pose graph. It is empty before the first frame.
    #[must_use]
    pub fn graph(&self) -> &PoseGraph {
        &self.graph
    }

    /// The pose graph, mutable for covariance queries, which need the solver's memory.
    pub fn graph_mut(&mut self) -> &mut PoseGraph {
        &mut self.graph
    }

    /// The keyframes in order.
    #[must_use]
    pub fn keyframes(&self) -> &[Keyframe] {
        &self.keyframes
    }

    /// Poses of the keyframes, `world_from_body`.
    #[must_use]
    pub fn poses(&self) -> &[SE2] {
        self.graph.poses()
    }

    /// The newest keyframe; `None` before the first.
    #[must_use]
    pub fn newest(&self) -> Option<usize> {
        self.keyframes.len().checked_sub(1)
    }

    /// The thinned scan of a keyframe with its normals, body frame.
    ///
    /// # Panics
    /// If the keyframe does not exist.
    #[must_use]
    pub fn scan(&self, node: usize) -> &Arc<PointCloud> {
        &self.keyframes[node].scan
    }

    /// The graph and its keyframes, for a detector.
    pub fn loop_query(&mut self) -> LoopQuery<'_> {
        LoopQuery::new(&mut self.graph, &self.keyframes)
    }

    /// χ² of the graph.
    #[must_use]
    pub fn chi2(&self) -> f64 {
        self.chi2
    }

    /// The newest node at which a loop was closed; the first before any was.
    #[must_use]
    pub fn last_loop_node(&self) -> usize {
        self.last_loop_node
    }

    /// Path length over the keyframes from the first to each, m.
    #[must_use]
    pub fn path_lengths_m(&self) -> Vec<f64> {
        let mut length_m = 0.0;
        let poses = self.graph.poses();
        let mut lengths_m = vec![0.0; poses.len()];
        for (node, pair) in poses.windows(2).enumerate() {
            length_m += position_error_m(&pair[0], &pair[1]);
            lengths_m[node + 1] = length_m;
        }
        lengths_m
    }

    /// Adds the first keyframe, whose node is fixed.
    pub(super) fn start(&mut self, pose: SE2, frame: &PreparedFrame) {
        let node = self.graph.add_fixed_node(pose).index();
        self.push_keyframe(node, 0, frame);
    }

    /// Adds a keyframe with the edge from the one before it; returns its node.
    pub(super) fn add_keyframe(
        &mut self,
        estimate: SE2,
        information: Matrix3<f64>,
        number: usize,
        frame: &PreparedFrame,
    ) -> usize {
        let node = self.graph.add_node(estimate).index();
        let relative = self.graph.pose(node - 1).between(&estimate);
        self.graph
            .add_edge(node - 1, node, relative, information, EdgeKind::Odometry);
        self.push_keyframe(node, number, frame);
        self.chi2 = self.graph.chi2();
        node
    }

    fn push_keyframe(&mut self, node: usize, number: usize, frame: &PreparedFrame) {
        self.keyframes.push(Keyframe {
            node,
            frame: number,
            stamp_s: frame.stamp_s,
            scan: Arc::clone(&frame.cloud),
        });
    }

    /// Replaces the scan of a keyframe.
    pub(super) fn set_scan(&mut self, node: usize, scan: PointCloud) {
        self.keyframes[node].scan = Arc::new(scan);
    }

    /// Removes a keyframe and keeps the information of its edges; later ones are renumbered.
    ///
    /// # Errors
    /// If its node cannot be marginalized.
    pub(super) fn marginalize(&mut self, node: usize) -> Result<Marginalized, MarginalizeError> {
        let done = self.graph.marginalize(node)?;
        self.keyframes.remove(node);
        for keyframe in &mut self.keyframes[node..] {
            keyframe.node -= 1;
        }
        self.last_loop_node -= usize::from(self.last_loop_node > node);
        self.chi2 = self.graph.chi2();
        Ok(done)
    }

    /// Adds the edges of loops and optimizes. Loops that the outlier test drops are not closed; if the graph cannot be
    /// optimized, none is, and edges and nodes are reverted.
    pub(super) fn close(&mut self, loops: &[LoopVerification], consistency: Consistency) -> Closed {
        let poses_before = self.graph.poses().to_vec();
        for found in loops {
            self.graph.add_edge(
                found.candidate.node,
                found.from_node,
                found.registered,
                found.information,
                EdgeKind::Loop,
            );
        }
        let chi2_before = self.graph.chi2();
        let solution = match self.solve(loops.len(), consistency, &poses_before) {
            Ok(solution) => solution,
            Err(rejection) => {
                return Closed {
                    effect: None,
                    rejections: vec![Some(rejection); loops.len()],
                };
            }
        };
        self.chi2 = self.graph.chi2();
        let newest = poses_before.len() - 1;
        let correction = match solution {
            Solution::Postponed => SE2::identity(),
            _ => self.graph.pose(newest) * poses_before[newest].inverse(),
        };
        let (iterations, is_inlier) = match solution {
            Solution::Postponed => (0, vec![true; loops.len()]),
            Solution::Optimized { iterations } => (iterations, vec![true; loops.len()]),
            Solution::Selected { is_inlier } => (0, is_inlier),
        };
        for (found, _) in loops.iter().zip(&is_inlier).filter(|(_, is_in)| **is_in) {
            self.last_loop_node = self.last_loop_node.max(found.from_node);
        }
        let shifts = poses_before.iter().zip(self.graph.poses());
        let effect = LoopEffect {
            correction,
            max_shift_m: shifts
                .map(|(old, new)| position_error_m(new, old))
                .fold(0.0, f64::max),
            iterations,
            chi2: Change {
                before: chi2_before,
                after: self.chi2,
            },
            poses_before,
        };
        let rejections = is_inlier.into_iter();
        Closed {
            effect: Some(effect),
            rejections: rejections
                .map(|is_in| (!is_in).then_some(LoopRejection::Outlier))
                .collect(),
        }
    }

    /// Solves the graph with its `added` newest edges.
    fn solve(
        &mut self,
        added: usize,
        consistency: Consistency,
        poses_before: &[SE2],
    ) -> Result<Solution, LoopRejection> {
        let selected = match consistency {
            Consistency::Contradicting => self.reject_outliers(added),
            Consistency::Expected if self.is_correction_small() => {
                return Ok(Solution::Postponed);
            }
            Consistency::Expected => None,
        };
        if let Some(is_inlier) = selected {
            return Ok(Solution::Selected { is_inlier });
        }
        let iterations = self.optimize(added, poses_before)?;
        Ok(Solution::Optimized { iterations })
    }

    /// Replaces the loops by the accepted `links` and optimizes with this width of the robust cost, in standard
    /// deviations; returns whether that succeeded, otherwise nothing changes.
    pub(crate) fn replace_loops(&mut self, links: &[LoopVerification], huber: f64) -> bool {
        let is_odometry = |view: &EdgeView| view.edge.kind == EdgeKind::Odometry;
        let mut graph = self.graph.with_edges(is_odometry);
        for link in links.iter().filter(|link| link.accepted()) {
            let (old, new) = (link.candidate.node, link.from_node);
            graph.add_edge(old, new, link.registered, link.information, EdgeKind::Loop);
        }
        let report = graph.optimize_robust(self.config.iterations, self.config.tolerance, huber);
        if matches!(report.stop, StopReason::Failed { .. }) {
            return false;
        }
        self.graph = graph;
        self.chi2 = self.graph.chi2();
        true
    }

    /// Whether the pending correction is so small that it can wait for the next loop.
    fn is_correction_small(&mut self) -> bool {
        let least = self.config.least_correction;
        let mut largest_move = || self.graph.largest_move_since();
        least > 0.0 && largest_move().is_ok_and(|largest| largest < least)
    }

    /// Optimizes the graph with its newest edges; returns the iterations.
    fn optimize(&mut self, added: usize, poses_before: &[SE2]) -> Result<usize, LoopRejection> {
        let optimized = self.graph.optimized_edges();
        let config = &self.config;
        let report = self
            .graph
            .optimize_robust(config.iterations, config.tolerance, config.huber);
        let cost_before = report
            .steps
            .first()
            .map_or(report.cost, |step| step.cost_before);
        let rejection = match report.stop {
            stop @ StopReason::Failed { .. } => Some(LoopRejection::OptimizationFailed(stop)),
            _ if report.cost > cost_before || report.cost.is_nan() => {
                Some(LoopRejection::CostRose {
                    before: cost_before,
                    after: report.cost,
                })
            }
            _ => None,
        };
        let Some(rejection) = rejection else {
            return Ok(report.iterations);
        };
        for _ in 0..added {
            self.graph.pop_edge();
        }
        for (node, pose) in poses_before.iter().enumerate() {
            self.graph.set_pose(node, *pose);
        }
        self.graph.mark_optimized(optimized);
        Err(rejection)
    }

    /// Keeps only the inlier loops, by the truncated cost; returns which of the newest are, or `None` if the selection
    /// failed.
    fn reject_outliers(&mut self, added: usize) -> Option<Vec<bool>> {
        let selection = self.outlier_test?(&self.graph).ok()?;
        let mut graph = self
            .graph
            .with_edges(|view| selection.inliers[view.id.index()]);
        for (node, pose) in selection.poses.iter().enumerate() {
            graph.set_pose(node, *pose);
        }
        graph.mark_optimized(graph.edge_count());
        self.graph = graph;
        Some(selection.inliers[selection.inliers.len() - added..].to_vec())
    }

    /// Optimizes pending loops; returns the motion of the newest node. A graph that cannot be solved is unchanged.
    pub(super) fn optimize_pending(&mut self) -> Result<SE2, LoopRejection> {
        let Some(newest) = self.keyframes.len().checked_sub(1) else {
            return Ok(SE2::identity());
        };
        let before = self.graph.poses().to_vec();
        if self.has_pending() {
            let optimized = self.optimize(0, &before);
            self.chi2 = self.graph.chi2();
            optimized?;
        }
        Ok(self.graph.pose(newest) * before[newest].inverse())
    }

    /// Whether the poses do not follow the newest loops.
    pub(super) fn has_pending(&self) -> bool {
        self.graph.optimized_edges() < self.graph.edge_count()
    }

    /// Covariance of every keyframe relative to the first one, in the body's frame: x and y in m, θ in rad.
    ///
    /// The covariance of the graph, scaled by its variance factor: see `slam::uncertainty`.
    ///
    /// # Errors
    /// If the normal equations are not positive definite.
    pub fn keyframe_covariances(&mut self) -> Result<Vec<Matrix3<f64>>, OptimizeError> {
        let factor = super::uncertainty::keyframe_factor(&self.graph);
        let stated = self.graph.pose_covariances()?;
        Ok(stated.into_iter().map(|stated| stated * factor).collect())
    }

    /// Covariance of every keyframe's position after an alignment to the truth: see
    /// [`PoseGraph::aligned_covariances`]; scaled as [`keyframe_covariances`](Self::keyframe_covariances).
    ///
    /// # Errors
    /// If the normal equations are not positive definite.
    pub(super) fn aligned_covariances(&mut self) -> Result<Vec<Matrix2<f64>>, OptimizeError> {
        let factor = super::uncertainty::keyframe_factor(&self.graph);
        let stated = self.graph.aligned_covariances()?;
        Ok(stated.into_iter().map(|stated| stated * factor).collect())
    }

    /// Covariance of keyframe `to` relative to `from`, in the frame of `to`, scaled as
    /// [`keyframe_covariances`](Self::keyframe_covariances).
    ///
    /// # Errors
    /// If the normal equations are not positive definite.
    pub(super) fn relative_covariance(
        &mut self,
        from: usize,
        to: usize,
    ) -> Result<Matrix3<f64>, OptimizeError> {
        let factor = super::uncertainty::keyframe_factor(&self.graph);
        Ok(self.graph.relative_covariance(from, to)? * factor)
    }
}
