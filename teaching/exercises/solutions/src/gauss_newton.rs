//! 4. Dense Gauss–Newton on a pose graph.

use ch16_listings::{PoseGraph, SE2};
use nalgebra::{DMatrix, DVector, Vector3};
use petgraph::visit::EdgeRef;

use crate::{jacobians, residual};

/// Added to each diagonal entry of the normal equations.
const RIDGE: f64 = 1e-9;

/// One step; returns the largest correction of a node, or NaN if the matrix is not positive definite.
pub fn optimize_once(graph: &mut PoseGraph, huber: f64) -> f64 {
    let size = 3 * graph.graph.node_count();
    let mut h = DMatrix::<f64>::identity(size, size) * RIDGE;
    let mut g = DVector::<f64>::zeros(size);
    let fixed = graph.fixed;
    for edge in graph.graph.edge_references() {
        let (i, j, edge) = (edge.source(), edge.target(), edge.weight());
        let e = residual(&graph.pose(i), &graph.pose(j), &edge.z);
        let m = e.dot(&(edge.omega * e)).sqrt();
        let omega = edge.omega * if m > huber { huber / m } else { 1.0 };
        let (at_i, at_j) = jacobians(&edge.z);
        let free = [(i, at_i), (j, at_j)];
        let free = || free.iter().filter(|(node, _)| *node != fixed);
        for (row, left) in free() {
            let mut gradient = g.fixed_rows_mut::<3>(3 * row.index());
            gradient += left.transpose() * omega * e;
            for (column, right) in free() {
                let at = (3 * row.index(), 3 * column.index());
                let mut block = h.fixed_view_mut::<3, 3>(at.0, at.1);
                block += left.transpose() * omega * right;
            }
        }
    }
    for k in 3 * fixed.index()..3 * fixed.index() + 3 {
        h[(k, k)] += 1.0;
    }
    let Some(factor) = h.cholesky() else {
        return f64::NAN;
    };
    let step = factor.solve(&-g);
    let mut largest = 0.0_f64;
    for node in graph.graph.node_indices() {
        let correction: Vector3<f64> = step.fixed_rows::<3>(3 * node.index()).into();
        graph.graph[node] = graph.graph[node] * SE2::exp(&correction);
        largest = largest.max(correction.xy().norm() + correction.z.abs());
    }
    largest
}

/// Steps until the largest correction is below `tolerance` or NaN; returns how many.
pub fn optimize(graph: &mut PoseGraph, max_iters: usize, tolerance: f64, huber: f64) -> usize {
    for step in 1..=max_iters {
        let largest = optimize_once(graph, huber);
        if largest.is_nan() || largest < tolerance {
            return step;
        }
    }
    max_iters
}
