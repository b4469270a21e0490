//! 4. Gauss–Newton on a pose graph, with a dense matrix.
//!
//! **Task.** Move all nodes except the fixed one to minimize the weighted sum of squared residuals. Use
//! `crate::residual` and `crate::jacobians` from exercise 3.
//!
//! **Formula.** For n nodes H is 3n × 3n. Every edge (i, j) adds, with its Ω, its e and its Jacobians Jᵢ, Jⱼ,
//!
//! ```text
//! w = min(1, huber / m)        m = √(eᵀ Ω e)
//! H[a, b] += Jₐᵀ w Ω J_b        g[a] += Jₐᵀ w Ω e        a, b ∈ {i, j}
//! ```
//!
//! Rows and columns of the fixed node are zero except for a unit diagonal, and 1e-9 is added to the whole diagonal. Solve
//! `H x = −g` by Cholesky, and move every node: `T ← T exp(x)`.
//!
//! **What the types offer.** `graph.fixed` is the fixed node. `graph.graph` is petgraph's:
//! `graph.graph.edge_references()` with `petgraph::visit::EdgeRef` has `source()`, `target()` and `weight()`, a
//! `PoseEdge`, and `graph.graph[node]` is a pose that can be set. `nalgebra::DMatrix` has `fixed_view_mut::<3, 3>`.

use ch16_listings::PoseGraph;

/// One step; returns the largest correction of a node, `‖(v_x, v_y)‖ + |ω|`.
///
/// If the matrix is not positive definite it returns NaN, and no node moves.
pub fn optimize_once(graph: &mut PoseGraph, huber: f64) -> f64 {
    crate::not_written("gauss_newton")
}

/// Steps until the largest correction is below `tolerance` or NaN, at most `max_iters`; returns how many.
pub fn optimize(graph: &mut PoseGraph, max_iters: usize, tolerance: f64, huber: f64) -> usize {
    crate::not_written("gauss_newton")
}
