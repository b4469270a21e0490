//! Rebuilds a graph from its odometry and the user's decisions.

use std::collections::BTreeMap;

use ch16_slam2d::graph::{EdgeKind, PoseGraph};
use pr_geom::SE2;

use crate::links::Link;

/// Solver settings after a manual change.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Solving {
    /// Most iterations.
    pub iterations: usize,
    /// Stops when a step moves no node by more, m and rad added.
    pub tolerance: f64,
    /// Width of the robust kernel, in standard deviations of an edge.
    pub huber: f64,
}

/// The graph with its odometry, these links and these pins, at the previous poses.
///
/// `fixed` states which nodes were fixed before any pin.
#[must_use]
pub fn rebuilt(
    base: &PoseGraph,
    fixed: &[bool],
    links: &[Link],
    pins: &BTreeMap<usize, SE2>,
) -> PoseGraph {
    let mut graph = PoseGraph::with_jacobians(base.jacobians());
    for ((node, old), &is_fixed) in base.nodes().zip(fixed) {
        match pins.get(&node.index()) {
            Some(pin) => graph.add_fixed_node(*pin),
            None if is_fixed => graph.add_fixed_node(old.pose),
            None => graph.add_node(old.pose),
        };
    }
    let odometry = base
        .edges()
        .filter(|view| view.edge.kind == EdgeKind::Odometry);
    for view in odometry {
        let edge = view.edge;
        graph.add_edge(
            view.from,
            view.to,
            edge.measurement,
            edge.information,
            edge.kind,
        );
    }
    for link in links.iter().filter(|link| link.decision.is_in_graph()) {
        graph.add_edge(
            link.old,
            link.new,
            link.measurement,
            link.information,
            EdgeKind::Loop,
        );
    }
    graph
}

/// Optimizes the graph; returns false and keeps the previous poses if that fails.
pub fn solve(graph: &mut PoseGraph, how: &Solving) -> bool {
    let report = graph.optimize_robust(how.iterations, how.tolerance, how.huber);
    !matches!(report.stop, pr_optim::StopReason::Failed { .. })
}
