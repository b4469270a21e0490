//! Marginalization of a node: removes it and keeps the information of its edges.
//!
//! The edges of node v measure its neighbours from it: `bᵢ = v Tᵢ exp(εᵢ)` with covariances Σᵢ. Without
//! v they still measure the relative poses of the neighbours,
//!
//! ```text
//! bᵢ⁻¹ bⱼ = Mᵢⱼ exp(ε),  Mᵢⱼ = Tᵢ⁻¹ Tⱼ,  Cᵢⱼ = Σⱼ + A Σᵢ Aᵀ,  A = Ad(Mᵢⱼ⁻¹)
//! ```
//!
//! but all jointly, because they share the errors of v: the Schur complement is dense. It is approximated by a
//! tree over the neighbours. Each of its edges keeps its marginal Cᵢⱼ, and the tree of smallest Kullback–Leibler
//! divergence is the minimum spanning tree with weights `ln det Cᵢⱼ`. The divergence, in nats, is half of the
//! excess of their sum over `ln det` of the dense covariance; for two neighbours it is zero. All to first order in
//! the covariances.
//!
//! Sources: Chow & Liu, "Approximating discrete probability distributions with dependence trees", 1968;
//! Mazuran, Burgard, Tipaldi, "Nonlinear factor recovery for long-term SLAM", 2016.

use nalgebra::Matrix3;
use pr_geom::{SE2, math};
use thiserror::Error;

use super::{EdgeKind, EdgeView, NodeId, PoseEdge, PoseGraph, PoseNode};

/// Result of a marginalization.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Marginalized {
    /// Number of neighbours of the node.
    pub neighbours: usize,
    /// Kullback–Leibler divergence of the tree from the exact marginal, nats.
    pub divergence: f64,
}

/// Why a node cannot be marginalized.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum MarginalizeError {
    /// The node is fixed.
    #[error("node {0} is fixed: marginalizing it would leave the gauge free")]
    Fixed(usize),
    /// An edge has no covariance.
    #[error("an edge of node {0} has a singular information matrix")]
    NoCovariance(usize),
}

/// A neighbour as measured from the marginalized node.
#[derive(Clone, Copy, Debug)]
struct Spoke {
    node: usize,
    /// `middle_from_neighbour`.
    pose: SE2,
    /// In the tangent space at the neighbour.
    covariance: Matrix3<f64>,
}

/// A measurement between two neighbours.
#[derive(Clone, Copy, Debug)]
struct Recovered {
    from: usize,
    to: usize,
    pose: SE2,
    information: Matrix3<f64>,
}

impl PoseGraph {
    /// Marginalizes a node; the numbers of later nodes and edges decrease.
    ///
    /// An edge between two nodes that already have one is merged with it, as odometry: the remains of a node
    /// belong to the path and are not tested again as a loop.
    ///
    /// # Errors
    /// If the node is fixed, or an edge has no covariance; the graph is unchanged.
    ///
    /// # Panics
    /// If the node does not exist.
    pub fn marginalize(
        &mut self,
        node: impl Into<NodeId>,
    ) -> Result<Marginalized, MarginalizeError> {
        let middle = node.into().index();
        let nodes: Vec<PoseNode> = self.nodes().map(|(_, node)| node).collect();
        if nodes[middle].fixed {
            return Err(MarginalizeError::Fixed(middle));
        }
        let mut spokes: Vec<Spoke> = Vec::new();
        let mut edges: Vec<EdgeView> = Vec::new();
        for view in self.edges() {
            match spoke(&view, middle) {
                None => edges.push(view),
                Some(spoke) => {
                    let spoke = spoke.ok_or(MarginalizeError::NoCovariance(middle))?;
                    add_spoke(&mut spokes, spoke);
                }
            }
        }
        let (tree, divergence) =
            nearest_tree(&spokes).ok_or(MarginalizeError::NoCovariance(middle))?;
        for edge in tree {
            add_edge(&mut edges, edge);
        }
        let left = (0..nodes.len()).filter(|&node| node != middle);
        let nodes: Vec<PoseNode> = left.map(|node| nodes[node]).collect();
        let moved_up =
            |node: NodeId| NodeId::from(node.index() - usize::from(node.index() > middle));
        for view in &mut edges {
            (view.from, view.to) = (moved_up(view.from), moved_up(view.to));
        }
        let mut graph = Self::from_parts(&nodes, &edges);
        graph.optimizer.settings = self.optimizer.settings;
        // A loop that is not optimized yet may now be part of any edge.
        let newer = &self.kinds[self.optimized_edges()..];
        if newer.iter().all(|kind| *kind == EdgeKind::Odometry) {
            graph.mark_optimized(graph.edge_count());
        }
        *self = graph;
        Ok(Marginalized {
            neighbours: spokes.len(),
            divergence,
        })
    }
}

/// The measurement of a neighbour by an edge of the middle node; `None` if it is not an edge of that node, and
/// `Some(None)` if it has no covariance.
fn spoke(view: &EdgeView, middle: usize) -> Option<Option<Spoke>> {
    let (from, to) = (view.from.index(), view.to.index());
    let PoseEdge {
        measurement,
        information,
        ..
    } = view.edge;
    let covariance = information.try_inverse();
    if from == middle {
        Some(covariance.map(|covariance| Spoke {
            node: to,
            pose: measurement,
            covariance,
        }))
    } else if to == middle {
        // v = b Z exp(e), so v⁻¹ b = Z⁻¹ exp(−Ad(Z) e).
        let adjoint = measurement.adjoint();
        Some(covariance.map(|covariance| Spoke {
            node: from,
            pose: measurement.inverse(),
            covariance: adjoint * covariance * adjoint.transpose(),
        }))
    } else {
        None
    }
}

/// Adds a neighbour; a second measurement of the same one is fused with the first.
fn add_spoke(spokes: &mut Vec<Spoke>, spoke: Spoke) {
    let known = spokes.iter_mut().find(|known| known.node == spoke.node);
    let both = known.and_then(|known| {
        let informations = (
            known.covariance.try_inverse()?,
            spoke.covariance.try_inverse()?,
        );
        let (pose, information) =
            merged((&known.pose, informations.0), (&spoke.pose, informations.1))?;
        known.pose = pose;
        known.covariance = information.try_inverse()?;
        Some(())
    });
    if both.is_none() {
        spokes.push(spoke);
    }
}

/// Fuses two measurements of one relative pose: `Z₁ exp((Ω₁ + Ω₂)⁻¹ Ω₂ log(Z₁⁻¹ Z₂))`.
fn merged(
    (a, of_a): (&SE2, Matrix3<f64>),
    (b, of_b): (&SE2, Matrix3<f64>),
) -> Option<(SE2, Matrix3<f64>)> {
    let information = of_a + of_b;
    let step = information.try_inverse()? * (of_b * a.between(b).log());
    Some((a.boxplus(&step), information))
}

fn ln_det(matrix: &Matrix3<f64>) -> f64 {
    math::ln(matrix.determinant())
}

/// Pose of neighbour `to` in the frame of neighbour `from`, with its covariance.
fn between(from: &Spoke, to: &Spoke) -> (SE2, Matrix3<f64>) {
    let pose = from.pose.between(&to.pose);
    let adjoint = pose.inverse().adjoint();
    let covariance = to.covariance + adjoint * from.covariance * adjoint.transpose();
    (pose, covariance)
}

/// The tree over the neighbours with the smallest divergence, and that divergence, nats.
fn nearest_tree(spokes: &[Spoke]) -> Option<(Vec<Recovered>, f64)> {
    let Some((root, others)) = spokes.split_first() else {
        return Some((Vec::new(), 0.0));
    };
    // ln det of the dense covariance of all others from the root.
    let mut inner = root.covariance.try_inverse()?;
    let mut dense = ln_det(&root.covariance);
    for other in others {
        let adjoint = root.pose.between(&other.pose).inverse().adjoint();
        inner += adjoint.transpose() * other.covariance.try_inverse()? * adjoint;
        dense += ln_det(&other.covariance);
    }
    dense += ln_det(&inner);
    // Prim's algorithm: next comes the neighbour with the smallest covariance from one in the tree.
    let mut tree = Vec::with_capacity(others.len());
    let mut sum = 0.0;
    let mut outside: Vec<(usize, usize, f64)> = (1..spokes.len())
        .map(|to| (to, 0, ln_det(&between(root, &spokes[to]).1)))
        .collect();
    while !outside.is_empty() {
        let best = (1..outside.len()).fold(0, |best, k| {
            if outside[k].2 < outside[best].2 {
                k
            } else {
                best
            }
        });
        let (to, from, cost) = outside.remove(best);
        if !cost.is_finite() {
            return None;
        }
        let (pose, covariance) = between(&spokes[from], &spokes[to]);
        tree.push(Recovered {
            from: spokes[from].node,
            to: spokes[to].node,
            pose,
            information: covariance.try_inverse()?,
        });
        sum += cost;
        for (other, nearest, cost) in &mut outside {
            let over = ln_det(&between(&spokes[to], &spokes[*other]).1);
            if over < *cost {
                (*nearest, *cost) = (to, over);
            }
        }
    }
    // Rounding may give a value slightly below zero if the tree is exact.
    let divergence = math::max(0.5 * (sum - dense), 0.0);
    Some((tree, if others.is_empty() { 0.0 } else { divergence }))
}

/// Adds a recovered edge, or fuses it with an edge between the same nodes.
fn add_edge(edges: &mut Vec<EdgeView>, edge: Recovered) {
    let known = edges.iter_mut().find_map(|view| {
        let ends = (view.from.index(), view.to.index());
        let is_same = ends == (edge.from, edge.to);
        (is_same || ends == (edge.to, edge.from)).then_some((view, is_same))
    });
    let both = known.and_then(|(view, is_same)| {
        let (pose, information) = if is_same {
            (edge.pose, edge.information)
        } else {
            // e of the inverse is −Ad(Z) e.
            let adjoint = edge.pose.inverse().adjoint();
            let information = adjoint.transpose() * edge.information * adjoint;
            (edge.pose.inverse(), information)
        };
        let first = (&view.edge.measurement, view.edge.information);
        let (measurement, information) = merged(first, (&pose, information))?;
        view.edge = PoseEdge {
            measurement,
            information,
            kind: EdgeKind::Odometry,
        };
        Some(())
    });
    if both.is_none() {
        edges.push(EdgeView {
            id: edges.len().into(),
            from: edge.from.into(),
            to: edge.to.into(),
            edge: PoseEdge {
                measurement: edge.pose,
                information: edge.information,
                kind: EdgeKind::Odometry,
            },
        });
    }
}

#[cfg(test)]
mod tests;
