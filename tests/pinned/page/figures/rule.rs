//! What a loop is worth, on graphs of one kind of error: a random walk of the position, or a bias.

use ch16_slam2d::graph::{EdgeKind, PoseGraph};
use nalgebra::{Matrix3, Vector3};
use pr_geom::{SE2, Translation};

/// Edges of the path; its middle is the tip of an arm, or the far side of a cycle.
const EDGES: usize = 40;
/// Node after a quarter of the path.
const QUARTER: usize = EDGES / 4;
/// Length of an edge that every measurement misses, m.
const BIAS_M: f64 = 0.1;

/// `revisit_percent`, `cycle_left`: by how much, or to what, an error shrinks.
pub fn value(what: &str) -> Option<f64> {
    let share_left = |node: usize| variance(&walk(true), node) / variance(&walk(false), node);
    Some(match what {
        "revisit_percent" => 100.0 * (1.0 - share_left(EDGES / 2).sqrt()),
        "cycle_share" => QUARTER as f64 / EDGES as f64,
        "cycle_left" => share_left(QUARTER),
        "bias_percent" => {
            let [without, with_loop] = [false, true].map(|closed| {
                let mut graph = walk(closed);
                graph.optimize(10, 1e-12);
                let tip_m = (EDGES / 2) as f64;
                (graph.pose(EDGES / 2).translation().x - tip_m).abs()
            });
            100.0 * (1.0 - with_loop / without)
        }
        _ => return None,
    })
}

/// Out and back along x with unit steps, each measured too short, and with a loop from the end to the start.
/// Only positions are uncertain.
fn walk(is_closed: bool) -> PoseGraph {
    let information =
        |position: f64| Matrix3::from_diagonal(&Vector3::new(position, position, 1e8));
    let mut graph = PoseGraph::new();
    let mut node = graph.add_fixed_node(SE2::identity());
    let start = node;
    for edge in 0..EDGES {
        let step_m = if edge < EDGES / 2 { 1.0 } else { -1.0 } * (1.0 - BIAS_M);
        let step = SE2::translation(step_m, 0.0);
        let next = graph.add_node(graph.pose(node) * step);
        graph.add_edge(node, next, step, information(1.0), EdgeKind::Odometry);
        node = next;
    }
    if is_closed {
        // The same place to within nothing, against edges of 1 m.
        graph.add_edge(
            start,
            node,
            SE2::identity(),
            information(1e8),
            EdgeKind::Loop,
        );
    }
    graph
}

/// Variance of a node along x, m².
fn variance(graph: &PoseGraph, node: usize) -> f64 {
    let covariances = graph.clone().pose_covariances();
    covariances.expect("the first node is fixed")[node][(0, 0)]
}
