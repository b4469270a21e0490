//! The pose graph on `petgraph`, solved by `faer`'s sparse Cholesky factorization.

use faer::Side;
use faer::linalg::solvers::Solve;
use faer::sparse::{SparseColMat, Triplet};
use nalgebra::{Matrix3, Vector3};
use petgraph::graph::{NodeIndex, UnGraph};
use petgraph::visit::EdgeRef;
use pr_geom::{math, twist_size};

use crate::SE2;
pub use ch16_slam2d::graph::EdgeKind;

/// Added to each diagonal entry of the normal equations.
const RIDGE: f64 = 1e-9;

/// A measured relative pose of two nodes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PoseEdge {
    /// The measured pose of the second node in the frame of the first.
    pub z: SE2,
    /// Inverse covariance of the residual, translation first.
    pub omega: Matrix3<f64>,
    /// Origin of the measurement.
    pub kind: EdgeKind,
}

/// Poses and the measurements between them.
#[derive(Clone, Debug, Default)]
pub struct PoseGraph {
    /// An edge keeps the order of its ends: it measures its target in the frame of its source.
    pub graph: UnGraph<SE2, PoseEdge>,
    /// The fixed node: it fixes the gauge and adds no information. The first one, unless another is added as such.
    pub fixed: NodeIndex,
}

impl PoseGraph {
    /// An empty graph.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds the node that fixes the gauge.
    pub fn add_fixed_node(&mut self, pose: SE2) -> NodeIndex {
        self.fixed = self.graph.add_node(pose);
        self.fixed
    }

    /// Adds a node at its initial guess.
    pub fn add_node(&mut self, pose: SE2) -> NodeIndex {
        self.graph.add_node(pose)
    }

    /// Adds the measured pose `z` of `j` in the frame of `i`, with its information `omega`.
    pub fn add_edge(
        &mut self,
        i: NodeIndex,
        j: NodeIndex,
        z: SE2,
        omega: Matrix3<f64>,
        kind: EdgeKind,
    ) {
        self.graph.add_edge(i, j, PoseEdge { z, omega, kind });
    }

    /// The present pose of a node.
    #[must_use]
    pub fn pose(&self, node: NodeIndex) -> SE2 {
        self.graph[node]
    }

    /// `e = log(Z⁻¹ Tᵢ⁻¹ Tⱼ)`: zero if the poses agree with the measurement.
    #[must_use]
    pub fn residual(&self, i: NodeIndex, j: NodeIndex, edge: &PoseEdge) -> Vector3<f64> {
        (edge.z.inverse() * self.graph[i].inverse() * self.graph[j]).log()
    }

    /// `χ² = Σ eᵀ Ω e`, without kernel and factor ½.
    #[must_use]
    pub fn chi2(&self) -> f64 {
        let squares = self.graph.edge_references().map(|edge| {
            let e = self.residual(edge.source(), edge.target(), edge.weight());
            e.dot(&(edge.weight().omega * e))
        });
        squares.sum()
    }

    /// Gauss–Newton without a kernel until the largest correction is below `tolerance`; returns the number of steps.
    ///
    /// The ridge shortens a step by 1e-9 of it, and the next one makes up for that: it costs the result no digit.
    pub fn optimize(&mut self, max_iters: usize, tolerance: f64) -> usize {
        for step in 1..=max_iters {
            let largest = self.optimize_once(f64::INFINITY);
            if largest.is_nan() || largest < tolerance {
                return step;
            }
        }
        max_iters
    }

    /// One Gauss–Newton step; returns the largest correction of a node, m and rad added.
    ///
    /// The Jacobians are `−Ad(Z⁻¹)` and the identity, without the right Jacobian. The gradient of an edge beyond
    /// `huber` standard deviations is bounded. Returns NaN and moves no node if the matrix is not positive definite.
    pub fn optimize_once(&mut self, huber: f64) -> f64 {
        let size = 3 * self.graph.node_count();
        let mut entries = Vec::new();
        let mut rhs = faer::Mat::<f64>::zeros(size, 1);
        for edge in self.graph.edge_references() {
            let (i, j, edge) = (edge.source(), edge.target(), edge.weight());
            let e = self.residual(i, j, edge);
            let m = math::sqrt(e.dot(&(edge.omega * e)));
            let omega = edge.omega * if m > huber { huber / m } else { 1.0 };
            let jacobians = [(i, -edge.z.inverse().adjoint()), (j, Matrix3::identity())];
            for (row, left) in jacobians {
                if row == self.fixed {
                    continue;
                }
                let gradient = left.transpose() * omega * e;
                for k in 0..3 {
                    rhs[(3 * row.index() + k, 0)] -= gradient[k];
                }
                for (column, right) in jacobians {
                    if column != self.fixed {
                        let block = left.transpose() * omega * right;
                        push_block(&mut entries, row.index(), column.index(), &block);
                    }
                }
            }
        }
        for node in self.graph.node_indices() {
            let held = if node == self.fixed { 1.0 } else { 0.0 };
            let diagonal = Matrix3::identity() * (held + RIDGE);
            push_block(&mut entries, node.index(), node.index(), &diagonal);
        }
        // Entries at the same position are summed.
        let matrix = SparseColMat::<usize, f64>::try_new_from_triplets(size, size, &entries);
        let Some(factor) = matrix.ok().and_then(|h| h.sp_cholesky(Side::Lower).ok()) else {
            return f64::NAN;
        };
        let delta = factor.solve(&rhs);
        let mut largest = 0.0;
        for node in self.graph.node_indices() {
            let at = |k: usize| delta[(3 * node.index() + k, 0)];
            let correction = Vector3::new(at(0), at(1), at(2));
            self.graph[node] = self.graph[node] * SE2::exp(&correction);
            largest = math::max(largest, twist_size(&correction));
        }
        largest
    }
}

fn push_block(
    entries: &mut Vec<Triplet<usize, usize, f64>>,
    row: usize,
    column: usize,
    block: &Matrix3<f64>,
) {
    for (k, l) in (0..3).flat_map(|k| (0..3).map(move |l| (k, l))) {
        entries.push(Triplet::new(3 * row + k, 3 * column + l, block[(k, l)]));
    }
}
