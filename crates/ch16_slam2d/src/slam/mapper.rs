//! The map: keyframes and the pose graph.

use nalgebra::Matrix3;
use pr_geom::SE2;
use pr_optim::{OptimizeError, StopReason};

use super::config::SlamConfig;
use super::report::{Change, Keyframe, LoopEffect};
use crate::graph::{EdgeKind, EdgeView, InlierEdges, PoseGraph};
use crate::loops::{LoopRejection, LoopVerification};
use crate::metrics::position_error_m;

/// Selects the inlier edges of a graph in which any loop may be false, such as [`PoseGraph::inlier_edges`].
///
/// A function pointer, so a program that does not use it does not link it.
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

/// Keyframes and pose graph; node k is keyframe k.
#[derive(Clone)]
pub struct Mapper {
    pub(crate) graph: PoseGraph,
    pub(crate) keyframes: Vec<Keyframe>,
    /// The newest node at which a loop was closed; the first before any was.
    pub(super) last_loop_node: usize,
    pub(super) chi2: f64,
    pub(super) outlier_test: Option<LoopOutlierTest>,
    config: Optimization,
}

impl Mapper {
    pub(super) fn new(config: &SlamConfig) -> Self {
        Self {
            graph: PoseGraph::with_jacobians(config.jacobians),
            keyframes: Vec::new(),
            last_loop_node: 0,
            chi2: 0.0,
            outlier_test: None,
            config: Optimization {
                least_correction: config.least_correction,
                iterations: config.optimizer_iterations,
                tolerance: config.optimizer_tolerance,
                huber: config.huber,
            },
        }
    }

    /// The pose graph. It is empty before the first frame.
    #[must_use]
    pub fn graph(&self) -> &PoseGraph {
        &self.graph
    }

    /// The keyframes in order.
    #[must_use]
    pub fn keyframes(&self) -> &[Keyframe] {
        &self.keyframes
    }

    /// Path length over the keyframes from the first to each, m.
    pub(super) fn path_lengths_m(&self) -> Vec<f64> {
        let mut length_m = 0.0;
        let poses = self.graph.poses();
        let mut lengths_m = vec![0.0; poses.len()];
        for (node, pair) in poses.windows(2).enumerate() {
            length_m += position_error_m(&pair[0], &pair[1]);
            lengths_m[node + 1] = length_m;
        }
        lengths_m
    }

    /// Adds the edges of loops and optimizes; returns the effect, with the correction `last ∘ last before⁻¹`.
    ///
    /// # Errors
    /// If the graph cannot be optimized with them; edges and nodes are then reverted.
    pub(super) fn close(
        &mut self,
        loops: &[LoopVerification],
        consistency: Consistency,
    ) -> Result<LoopEffect, LoopRejection> {
        let poses_before = self.graph.poses().to_vec();
        for found in loops {
            self.graph.add_edge(
                found.candidate.node,
                found.from_node,
                found.registered,
                found.information,
                EdgeKind::Loop,
            );
            self.last_loop_node = self.last_loop_node.max(found.from_node);
        }
        let chi2_before = self.graph.chi2();
        let iterations = match consistency {
            Consistency::Contradicting if self.reject_outliers() => 1,
            Consistency::Expected if self.is_correction_small() => 0,
            _ => self.optimize(loops.len(), &poses_before)?,
        };
        self.chi2 = self.graph.chi2();
        let newest = poses_before.len() - 1;
        let correction = if iterations == 0 {
            SE2::identity()
        } else {
            self.graph.pose(newest) * poses_before[newest].inverse()
        };
        let shifts = poses_before.iter().zip(self.graph.poses());
        Ok(LoopEffect {
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
        })
    }

    /// Replaces the loops by the accepted `links` and optimizes with this width of the robust cost, in standard
    /// deviations; returns whether that succeeded, otherwise nothing changes.
    pub(super) fn replace_loops(&mut self, links: &[LoopVerification], huber: f64) -> bool {
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

    /// Keeps only the inlier loops, by the truncated cost; returns whether the selection succeeded.
    fn reject_outliers(&mut self) -> bool {
        let Some(Ok(selection)) = self.outlier_test.map(|test| test(&self.graph)) else {
            return false;
        };
        let mut graph = self
            .graph
            .with_edges(|view| selection.inliers[view.id.index()]);
        for (node, pose) in selection.poses.iter().enumerate() {
            graph.set_pose(node, *pose);
        }
        graph.mark_optimized(graph.edge_count());
        self.graph = graph;
        true
    }

    /// Optimizes pending loops; returns the motion of the newest node.
    pub(super) fn optimize_pending(&mut self) -> SE2 {
        let Some(newest) = self.keyframes.len().checked_sub(1) else {
            return SE2::identity();
        };
        let before = self.graph.poses().to_vec();
        if self.graph.optimized_edges() < self.graph.edge_count() {
            // A graph that cannot be solved is unchanged.
            let _ = self.optimize(0, &before);
            self.chi2 = self.graph.chi2();
        }
        self.graph.pose(newest) * before[newest].inverse()
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
