//! How well the keyframes are known, by how far the measurements of the graph contradict each other.
//!
//! The information of an edge says how points scatter about walls. It says nothing of what a sparse
//! sensor or a wall that is not straight do to a registration. The closed loops do: they measure more
//! than is needed, and what the optimum leaves over should be one standard deviation on the mean.
//! The ratio of both multiplies every covariance. It is the variance of unit weight of an adjustment.
//!
//! Source: Förstner & Wrobel, "Photogrammetric computer vision", 2016, §4.2.3.

use pr_geom::math;

use crate::graph::PoseGraph;

/// The edges are taken at their word as if so many measurements said so: without a loop nothing else does.
const STATED: f64 = 1.0;
/// A chain strays farther than its links: errors of scans that follow each other go the same way, and loops
/// show less of it than the way between them. So the variances are twice the geometric mean of what is
/// stated and what is left over. Found on simulated laps and buildings; `docs/robots.md` has both.
const CHAINED: f64 = 2.0;

/// What every covariance of the graph is multiplied by.
pub(super) fn keyframe_factor(graph: &PoseGraph) -> f64 {
    CHAINED * math::sqrt(variance_factor(graph))
}

/// `χ² / (3E − 3N)` of E edges and N nodes that are not fixed, drawn to 1 where little is measured twice.
pub(super) fn variance_factor(graph: &PoseGraph) -> f64 {
    let free = graph.nodes().filter(|(_, node)| !node.fixed).count();
    let redundant = 3.0 * graph.edge_count().saturating_sub(free) as f64;
    (graph.chi2() + STATED) / (redundant + STATED)
}

#[cfg(test)]
mod tests {
    use nalgebra::{Matrix3, Vector3};
    use pr_geom::{Rng, SE2};

    use super::*;
    use crate::graph::EdgeKind;

    /// A chain whose nodes are tied to the next ones; the errors of the measurements are normal, with
    /// so many times the deviation that they state.
    fn tied(nodes: usize, reach: usize, times: f64) -> PoseGraph {
        let mut rng = Rng::new(1);
        let mut graph = PoseGraph::new();
        graph.add_fixed_node(SE2::identity());
        (1..nodes).for_each(|k| {
            graph.add_node(SE2::translation(k as f64, 0.0));
        });
        let sigma = 0.01;
        let information = Matrix3::identity() / (sigma * sigma);
        for from in 0..nodes {
            for to in (from + 1..nodes).take(reach) {
                let error = Vector3::from_fn(|_, _| rng.normal(0.0, times * sigma));
                let measured = SE2::translation((to - from) as f64, 0.0) * SE2::exp(&error);
                graph.add_edge(from, to, measured, information, EdgeKind::Odometry);
            }
        }
        graph.optimize(20, 1e-12);
        graph
    }

    #[test]
    fn a_chain_without_loops_is_taken_at_its_word() {
        let factor = variance_factor(&tied(30, 1, 5.0));
        assert!((factor - 1.0).abs() < 1e-9, "{factor}");
    }

    #[test]
    fn measurements_that_are_off_by_more_than_they_say_show_in_what_contradicts() {
        for (times, expected) in [(0.2, 0.04), (1.0, 1.0), (3.0, 9.0)] {
            let factor = variance_factor(&tied(120, 3, times));
            // 235 measurements of three numbers each more than needed: the deviation of their mean square is 5 %.
            assert!(
                (factor / expected - 1.0).abs() < 0.15,
                "{factor}, {expected}"
            );
        }
    }
}
