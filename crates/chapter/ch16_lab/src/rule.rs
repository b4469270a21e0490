//! What a loop is worth: a path out and back along a line, whose edges have independent errors or share a bias.
//!
//! Only positions are uncertain. An error per edge of variance 1 makes a random walk: variance s after s edges. A
//! loop that ties both passes of one place makes the path beyond it a cycle of L edges: u edges into the cycle the
//! variance grows by `u (1 − u/L)` in place of `u`. Seen from its tip, the arm is then measured twice.

use ch16_slam2d::graph::{EdgeKind, PoseGraph};
use nalgebra::{Matrix3, Vector3};
use pr_geom::{Rng, SE2, math};

/// Edges of the path; its tip is in the middle.
pub const EDGES: usize = 40;
/// Standard deviation of an edge of one metre, m.
pub const SIGMA_M: f64 = 0.1;
/// By how much every measurement of a biased path is too short, m.
pub const BIAS_M: f64 = 0.1;

/// Information of what is exact beside the edges: the loop, and all headings.
const EXACT: f64 = 1e10;

/// The graph of the path with measurements of the lengths 1 m plus `errors_m`, which have the sign of the path, and a
/// loop between both passes of the place `tie` metres from the start.
#[must_use]
pub fn graph(errors_m: impl Fn(usize) -> f64, tie: Option<usize>) -> PoseGraph {
    let information =
        |position: f64| Matrix3::from_diagonal(&Vector3::new(position, position, EXACT));
    let mut graph = PoseGraph::new();
    let mut nodes = vec![graph.add_fixed_node(SE2::identity())];
    for edge in 0..EDGES {
        let ahead_m = if edge < EDGES / 2 { 1.0 } else { -1.0 };
        let step = SE2::from_xy(ahead_m + errors_m(edge), 0.0);
        let node = graph.add_node(graph.pose(nodes[edge]) * step);
        let information = information(1.0 / (SIGMA_M * SIGMA_M));
        graph.add_edge(nodes[edge], node, step, information, EdgeKind::Odometry);
        nodes.push(node);
    }
    if let Some(tie) = tie {
        let ends = (nodes[tie], nodes[EDGES - tie]);
        let here = SE2::identity();
        graph.add_edge(ends.0, ends.1, here, information(EXACT), EdgeKind::Loop);
    }
    graph
}

/// The graph's standard deviation of every node along the path, m.
///
/// # Panics
/// Never: the first node is fixed, and the path connects all others to it.
#[must_use]
pub fn sigmas_m(tie: Option<usize>) -> Vec<f64> {
    let covariances = graph(|_| 0.0, tie).pose_covariances();
    let covariances = covariances.expect("the first node is fixed");
    covariances.iter().map(|c| math::sqrt(c[(0, 0)])).collect()
}

/// The error of every node at the optimum, m: the loop's gap is shared by the edges of its cycle in equal parts.
#[must_use]
pub fn errors_m(edges_m: &[f64; EDGES], tie: Option<usize>) -> Vec<f64> {
    let mut sums = vec![0.0];
    for error in edges_m {
        sums.push(sums[sums.len() - 1] + error);
    }
    let Some(tie) = tie else { return sums };
    let back = EDGES - tie;
    let gap = sums[back] - sums[tie];
    let share = |node: usize| {
        let into = node.clamp(tie, back) - tie;
        into as f64 / (back - tie) as f64
    };
    let corrected = sums.iter().enumerate();
    corrected
        .map(|(node, sum)| sum - share(node) * gap)
        .collect()
}

/// Root mean square error of every node over many drives, m.
#[must_use]
pub fn driven_m(tie: Option<usize>, drives: usize, seed: u32) -> Vec<f64> {
    let mut rng = Rng::new(seed);
    let mut squares = vec![0.0; EDGES + 1];
    for _ in 0..drives {
        let edges: [f64; EDGES] = core::array::from_fn(|_| rng.normal(0.0, SIGMA_M));
        for (square, error) in squares.iter_mut().zip(errors_m(&edges, tie)) {
            *square += error * error;
        }
    }
    let mean = squares.iter().map(|square| square / drives as f64);
    mean.map(math::sqrt).collect()
}

/// The error of every node if all edges share a bias, m, at the optimum of the graph.
#[must_use]
pub fn biased_m(tie: Option<usize>) -> Vec<f64> {
    let short = |edge: usize| if edge < EDGES / 2 { -BIAS_M } else { BIAS_M };
    let mut graph = graph(short, tie);
    graph.optimize(10, 1e-12);
    let truth = |node: usize| node.min(EDGES - node) as f64;
    let poses = graph.poses().iter().enumerate();
    poses.map(|(node, pose)| pose.x() - truth(node)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const TIES: [Option<usize>; 4] = [None, Some(0), Some(7), Some(18)];

    #[test]
    fn the_shared_gap_is_the_optimum_of_the_graph() {
        let mut rng = Rng::new(3);
        let edges: [f64; EDGES] = core::array::from_fn(|_| rng.normal(0.0, SIGMA_M));
        for tie in TIES {
            let mut graph = graph(|edge| edges[edge], tie);
            graph.optimize(10, 1e-12);
            let truth = |node: usize| node.min(EDGES - node) as f64;
            for (node, error) in errors_m(&edges, tie).into_iter().enumerate() {
                let solved = graph.pose(node).x() - truth(node);
                // 1e-6: the loop's information is finite.
                assert!(
                    (solved - error).abs() < 1e-6,
                    "{tie:?} {node}: {solved} {error}"
                );
            }
        }
    }

    #[test]
    fn the_graph_predicts_s_times_one_less_s_over_l_and_the_drives_scatter_by_that() {
        for tie in TIES {
            let driven = driven_m(tie, 4000, 5);
            for (node, sigma) in sigmas_m(tie).into_iter().enumerate().skip(1) {
                let (start, end) = tie.map_or((EDGES, EDGES), |tie| (tie, EDGES - tie));
                let into = (node.clamp(start, end) - start) as f64;
                let length = (end - start).max(1) as f64;
                let outside = (node - (node.clamp(start, end) - start)) as f64;
                let rule = SIGMA_M * (outside + into * (1.0 - into / length)).sqrt();
                // 1e-5: the loop's information is finite.
                assert!(
                    (sigma - rule).abs() < 1e-5,
                    "{tie:?} {node}: {sigma} {rule}"
                );
                // Five standard deviations of a root mean square over 4000 drives; a tied place has none.
                let off = (driven[node] - sigma).abs();
                assert!(off < 0.06 * sigma + 1e-4, "{tie:?} {node}: {off}");
            }
        }
    }

    #[test]
    fn a_shared_bias_stays_wherever_the_loop_ties() {
        let without = biased_m(None);
        for tie in TIES {
            for (with, without) in biased_m(tie).iter().zip(&without) {
                // 1e-9: both passes agree, so the loop has no gap to share.
                assert!((with - without).abs() < 1e-9, "{tie:?}: {with} {without}");
            }
        }
        assert!((without[EDGES / 2] + 2.0).abs() < 1e-9);
    }
}
