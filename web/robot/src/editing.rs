//! A graph made anew of what stays and what the reader decided.

use std::collections::BTreeMap;

use ch16_slam2d::graph::{EdgeKind, PoseGraph};
use pr_geom::SE2;

use crate::links::Link;

/// What the reader may change of a graph, and how it is solved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Solving {
    /// Most iterations.
    pub iterations: usize,
    /// A step that moves no node by as much ends it, m and rad added.
    pub tolerance: f64,
    /// Width of the robust kernel, in standard deviations of an edge.
    pub huber: f64,
}

/// The graph with its odometry, these links and these pins; poses as they were.
///
/// `fixed` says which nodes held the gauge before any pin.
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
    for link in links.iter().filter(|link| link.verdict.is_in_graph()) {
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

/// Solves; false where it could not be, and then the poses are those before.
pub fn solve(graph: &mut PoseGraph, how: &Solving) -> bool {
    let report = graph.optimize_robust(how.iterations, how.tolerance, how.huber);
    !matches!(report.stop, pr_optim::StopReason::Failed { .. })
}
