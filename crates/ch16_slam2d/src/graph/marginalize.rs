//! A node is taken out, and what its edges told of the nodes around it is kept.
//!
//! The edges of node v measure its neighbours from it: `bᵢ = v Tᵢ exp(εᵢ)` with covariances Σᵢ. Without
//! v they still measure each neighbour from each other one,
//!
//! ```text
//! bᵢ⁻¹ bⱼ = Mᵢⱼ exp(ε),  Mᵢⱼ = Tᵢ⁻¹ Tⱼ,  Cᵢⱼ = Σⱼ + A Σᵢ Aᵀ,  A = Ad(Mᵢⱼ⁻¹)
//! ```
//!
//! and all together, since they share the errors of v: the Schur complement is dense. A tree over the
//! neighbours has as many measurements as relative poses, so each edge keeps its own marginal Cᵢⱼ, and
//! of all trees the nearest in Kullback–Leibler divergence is the one with the smallest
//! `Σ ln det Cᵢⱼ`: a minimum spanning tree. The divergence is half of what that sum exceeds
//! `ln det` of the dense covariance by, in nats; with two neighbours it is zero. It holds to first
//! order in the covariances.
//!
//! Sources: Chow & Liu, "Approximating discrete probability distributions with dependence trees", 1968;
//! Mazuran, Burgard, Tipaldi, "Nonlinear factor recovery for long-term SLAM", 2016.

use nalgebra::Matrix3;
use pr_geom::{SE2, math};
use thiserror::Error;

use super::{EdgeKind, EdgeView, NodeId, PoseEdge, PoseGraph, PoseNode};

/// What taking a node out did.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Marginalized {
    /// Nodes that it was tied to.
    pub neighbours: usize,
    /// What the tree leaves out of what the edges told, nats.
    pub divergence: f64,
}

/// Why a node stays.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum MarginalizeError {
    /// It holds the gauge.
    #[error("node {0} is fixed; the graph hangs on it")]
    Fixed(usize),
    /// An edge has no covariance.
    #[error("an edge of node {0} has an information without inverse")]
    NoCovariance(usize),
}

/// A neighbour as the node in the middle measures it.
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
    /// Takes a node out; later nodes get the number before theirs, and so do edges.
    ///
    /// Edges between two nodes that are tied already are made one, of the kind of odometry: what is
    /// left of a node belongs to the way, and no loop that is tested again.
    ///
    /// # Errors
    /// Where the node is fixed, or an edge has no covariance; the graph stays as it was.
    ///
    /// # Panics
    /// Where the node does not exist.
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
        let moved_up = |node: NodeId| NodeId(node.0 - usize::from(node.0 > middle));
        for view in &mut edges {
            (view.from, view.to) = (moved_up(view.from), moved_up(view.to));
        }
        let mut graph = Self::of(&nodes, &edges);
        graph.optimizer.settings = self.optimizer.settings;
        // A loop that is yet to correct the graph may be a part of any edge now.
        let newer = &self.kinds[self.settled_edges()..];
        if newer.iter().all(|kind| *kind == EdgeKind::Odometry) {
            graph.settle(graph.edge_count());
        }
        *self = graph;
        Ok(Marginalized {
            neighbours: spokes.len(),
            divergence,
        })
    }
}

/// What an edge of the middle node measures; none where it is no edge of it, and no spoke where it has
/// no covariance.
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

/// Adds a spoke; a second one to the same neighbour is made one with the first.
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

/// Two measurements of one relative pose as one: `Z₁ exp((Ω₁ + Ω₂)⁻¹ Ω₂ log(Z₁⁻¹ Z₂))`.
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

/// Pose of spoke `to` from spoke `from`, with its covariance.
fn between(from: &Spoke, to: &Spoke) -> (SE2, Matrix3<f64>) {
    let pose = from.pose.between(&to.pose);
    let adjoint = pose.inverse().adjoint();
    let covariance = to.covariance + adjoint * from.covariance * adjoint.transpose();
    (pose, covariance)
}

/// The tree over the neighbours that is nearest to what the spokes tell, and how far it is, nats.
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
    // Prim's tree: the neighbour next taken is the one that is known best from one in the tree.
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
    // Rounding may leave a little less than nothing where the tree is all there is.
    let divergence = math::max(0.5 * (sum - dense), 0.0);
    Some((tree, if others.is_empty() { 0.0 } else { divergence }))
}

/// Adds a recovered edge; one between the same nodes is made one with it.
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
mod tests {
    use nalgebra::Vector3;

    use super::*;

    fn information(x: f64, y: f64, theta: f64) -> Matrix3<f64> {
        let turned = SE2::new(0.2, -0.1, 0.4).adjoint();
        turned.transpose() * Matrix3::from_diagonal(&Vector3::new(x, y, theta)) * turned
    }

    /// Five nodes: a chain 0 1 2 3 with a loop from 0 to 2, and node 4 hanging on node 2.
    fn graph() -> PoseGraph {
        let mut graph = PoseGraph::with_jacobians(pr_optim::JacobianModel::Exact);
        graph.add_fixed_node(SE2::new(1.0, -2.0, 0.3));
        let steps = [
            (
                0,
                1,
                SE2::new(1.0, 0.1, 0.5),
                information(400.0, 900.0, 2500.0),
            ),
            (
                1,
                2,
                SE2::new(0.9, -0.2, -0.8),
                information(300.0, 500.0, 1600.0),
            ),
            (
                2,
                3,
                SE2::new(0.8, 0.3, 1.2),
                information(700.0, 200.0, 900.0),
            ),
            (
                4,
                2,
                SE2::new(0.5, 0.5, -0.3),
                information(800.0, 300.0, 3600.0),
            ),
        ];
        for _ in 0..4 {
            graph.add_node(SE2::identity());
        }
        for (from, to, z, omega) in steps {
            if to == 2 && from == 4 {
                let at = graph.pose(2) * z.inverse();
                graph.set_pose(4, at);
            } else {
                let at = graph.pose(from) * z;
                graph.set_pose(to, at);
            }
            graph.add_edge(from, to, z, omega, EdgeKind::Odometry);
        }
        let around = graph.pose(0).between(&graph.pose(2)) * SE2::new(0.01, -0.02, 0.01);
        let omega = information(250.0, 350.0, 900.0);
        graph.add_edge(0, 2, around, omega, EdgeKind::Loop);
        graph.optimize(20, 1e-12);
        graph
    }

    #[test]
    fn a_loop_that_is_yet_to_correct_the_graph_does_so_when_a_node_is_gone() {
        let mut corrected = graph();
        corrected.marginalize(1).unwrap();
        assert_eq!(corrected.settled_edges(), corrected.edge_count());
        let mut waiting = graph();
        let seen = waiting.pose(0).between(&waiting.pose(3)) * SE2::new(0.0, 0.02, 0.0);
        let omega = information(250.0, 350.0, 900.0);
        waiting.add_edge(0, 3, seen, omega, EdgeKind::Loop);
        waiting.marginalize(1).unwrap();
        assert_eq!(waiting.settled_edges(), 0);
    }

    #[test]
    fn a_node_of_a_chain_leaves_the_covariance_of_its_neighbours_as_it_was() {
        let mut whole = graph();
        let expected = whole.relative_covariance(0, 3).unwrap();
        let mut graph = graph();
        let done = graph.marginalize(1).unwrap();
        assert_eq!((done.neighbours, done.divergence), (2, 0.0));
        assert_eq!((graph.node_count(), graph.edge_count()), (4, 3));
        let found = graph.relative_covariance(0, 2).unwrap();
        // 2 %: what the loop moved is second order in the covariances.
        assert!(
            (found - expected).norm() < 0.02 * expected.norm(),
            "{found} {expected}"
        );
        graph.optimize(20, 1e-12);
        let moved = whole.pose(3).between(&graph.pose(2)).log();
        assert!(moved.norm() < 1e-3, "{moved}");
    }

    #[test]
    fn a_node_that_hangs_on_one_edge_leaves_nothing_behind() {
        let mut graph = graph();
        let poses = graph.poses()[..4].to_vec();
        let done = graph.marginalize(4).unwrap();
        assert_eq!((done.neighbours, done.divergence), (1, 0.0));
        graph.optimize(20, 1e-12);
        for (a, b) in poses.iter().zip(graph.poses()) {
            assert!(a.between(b).log().norm() < 1e-9);
        }
    }

    #[test]
    fn of_a_star_the_tree_keeps_each_of_its_relative_poses_and_no_other_tree_is_nearer() {
        // Equal spokes from the middle: each relative pose has 2 Σ, the dense covariance of n of them
        // ln det = 3 ln(n + 1) more than n Σ, so the divergence is 1.5 (n ln 2 − ln(n + 1)).
        for leaves in 2..6_usize {
            let spokes: Vec<Spoke> = (0..leaves)
                .map(|node| Spoke {
                    node,
                    pose: SE2::identity(),
                    covariance: Matrix3::identity() * 0.01,
                })
                .collect();
            let (tree, divergence) = nearest_tree(&spokes).unwrap();
            let others = (leaves - 1) as f64;
            let expected = 1.5 * (others * 2_f64.ln() - (others + 1.0).ln());
            assert!(
                (divergence - expected).abs() < 1e-9,
                "{leaves}: {divergence}"
            );
            assert_eq!(tree.len(), leaves - 1);
        }
        // A spoke that is known well is the hub of the tree, wherever it stands in the list.
        let spoke = |node: usize, variance: f64| Spoke {
            node,
            pose: SE2::new(node as f64, 0.5, 0.3 * node as f64),
            covariance: Matrix3::identity() * variance,
        };
        let spokes = [spoke(0, 0.1), spoke(1, 0.2), spoke(2, 1e-6), spoke(3, 0.3)];
        let (tree, divergence) = nearest_tree(&spokes).unwrap();
        assert!(tree.iter().all(|edge| edge.from == 2 || edge.to == 2));
        assert!(divergence < 1e-3, "{divergence}");
    }

    #[test]
    fn a_node_with_loops_is_taken_out_and_the_map_stays() {
        let whole = graph();
        let mut graph = graph();
        let done = graph.marginalize(2).unwrap();
        assert_eq!(done.neighbours, 4);
        assert!(done.divergence > 0.0 && done.divergence < 3.0, "{done:?}");
        // Of five edges four go, and three come.
        assert_eq!(graph.edge_count(), 4);
        graph.optimize(20, 1e-12);
        for (old, new) in [(1, 1), (3, 2), (4, 3)] {
            let moved = whole.pose(old).between(&graph.pose(new)).log();
            // 0.01: the loop was off by 2 cm, and the tree shares it out otherwise.
            assert!(moved.norm() < 0.01, "{moved}");
        }
    }

    #[test]
    fn what_holds_the_graph_stays() {
        let mut graph = graph();
        assert_eq!(graph.marginalize(0), Err(MarginalizeError::Fixed(0)));
        assert_eq!(graph.node_count(), 5);
    }
}
