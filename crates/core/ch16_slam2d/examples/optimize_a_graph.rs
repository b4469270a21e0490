//! A robot drives around a square with drifting odometry, and one loop closure corrects it.
//!
//! `cargo run -p ch16_slam2d --example optimize_a_graph`

use ch16_slam2d::prelude::*;

/// Excess of each quarter turn, rad.
const DRIFT_RAD: f64 = 0.04;

/// The graph of odometry alone, with poses by dead reckoning.
pub fn drive() -> (PoseGraph, Vec<NodeId>) {
    let mut graph = PoseGraph::new();
    let mut nodes = vec![graph.add_fixed_node(SE2::identity())];
    // 5 cm and 2°, as information 1/σ².
    let omega = Matrix3::from_diagonal(&Vector3::new(400.0, 400.0, 820.0));
    let side = SE2::new(2.0, 0.0, std::f64::consts::FRAC_PI_2 + DRIFT_RAD);
    for k in 0..4 {
        let node = graph.add_node(graph.pose(nodes[k]) * side);
        graph.add_edge(nodes[k], node, side, omega, EdgeKind::Odometry);
        nodes.push(node);
    }
    (graph, nodes)
}

/// Adds a loop closure: the last node is at the pose of the first.
pub fn close_the_loop(graph: &mut PoseGraph, nodes: &[NodeId]) {
    let omega = Matrix3::from_diagonal_element(2500.0);
    let (first, last) = (nodes[0], nodes[4]);
    graph.add_edge(first, last, SE2::identity(), omega, EdgeKind::Loop);
    graph.optimize(20, 1e-9);
}

/// Distance of the last node from the start, m.
pub fn gap_m(graph: &PoseGraph, nodes: &[NodeId]) -> f64 {
    graph.pose(nodes[4]).translation().norm()
}

/// Prints the end of the drive without and with the loop.
pub fn main() {
    let (mut graph, nodes) = drive();
    println!(
        "The odometry ends {:.3} m from the start.",
        gap_m(&graph, &nodes)
    );
    close_the_loop(&mut graph, &nodes);
    println!(
        "With the loop it is {:.3} m, and χ² is {:.2}.",
        gap_m(&graph, &nodes),
        graph.chi2()
    );
    for (_, node) in graph.nodes() {
        let at = node.pose.translation();
        println!("x {:.3} m, y {:.3} m", at.x, at.y);
    }
}
