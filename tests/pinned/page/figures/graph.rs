//! The worked example of the pose graph: three poses on a line, and a loop that disagrees.

use ch16_slam2d::graph::{EdgeKind, PoseGraph};
use nalgebra::Matrix3;
use pr_geom::SE2;

/// Measurement of each odometry edge, m.
const ODOMETRY_M: f64 = 1.0;
/// Measurement of the loop edge, m.
const LOOP_M: f64 = 2.6;

/// `start2`, `end1`, `chi2_after`: poses along the line and disagreement, before and after.
pub fn value(what: &str) -> Option<f64> {
    let mut graph = PoseGraph::new();
    let step = SE2::from_xy(ODOMETRY_M, 0.0);
    let first = graph.add_fixed_node(SE2::identity());
    let second = graph.add_node(step);
    let third = graph.add_node(step * step);
    let weight = Matrix3::identity();
    graph.add_edge(first, second, step, weight, EdgeKind::Odometry);
    graph.add_edge(second, third, step, weight, EdgeKind::Odometry);
    let seen = SE2::from_xy(LOOP_M, 0.0);
    graph.add_edge(first, third, seen, weight, EdgeKind::Loop);
    let before = graph.clone();
    graph.optimize(10, 1e-9);
    let x = |graph: &PoseGraph, node: usize| graph.pose(node).translation().x;
    Some(match what {
        "fixed" => x(&graph, 0),
        "odometry" => ODOMETRY_M,
        "loop" => LOOP_M,
        "gap" => LOOP_M - x(&before, 2),
        "start1" => x(&before, 1),
        "start2" => x(&before, 2),
        "end1" => x(&graph, 1),
        "end2" => x(&graph, 2),
        "share" => x(&graph, 1) - ODOMETRY_M,
        "chi2_before" => before.chi2(),
        "chi2_after" => graph.chi2(),
        _ => return None,
    })
}
