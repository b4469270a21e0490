//! Covariance scale of the keyframes, from the contradictions between the measurements of the graph.
//!
//! The information of an edge models the scatter of points about walls. It does not model the effect of a sparse
//! sensor or of curved walls on a registration. Closed loops reveal it: they are redundant measurements, and the
//! residual at the optimum should be one standard deviation on average. The ratio of both scales every covariance.
//! It is the variance of unit weight of an adjustment.
//!
//! Source: Förstner & Wrobel, "Photogrammetric computer vision", 2016, §4.2.3.

use pr_geom::math;

use crate::graph::PoseGraph;

/// Weight of the stated variance, as a number of measurements: without a loop there is no other evidence.
const STATED_WEIGHT: f64 = 1.0;
/// Factor for correlated errors along a chain: consecutive scans have similar errors, and loops
/// reveal only part of them. The variances are twice the geometric mean of the stated and the
/// observed ones. Calibrated on simulated laps and buildings; see `docs/robots.md`.
const CHAIN_FACTOR: f64 = 2.0;

/// The factor on every covariance of the graph.
pub(super) fn keyframe_factor(graph: &PoseGraph) -> f64 {
    CHAIN_FACTOR * math::sqrt(variance_factor(graph))
}

/// `χ² / (3E − 3N)` for E edges and N free nodes, shrunk towards 1 if there is little redundancy.
pub(super) fn variance_factor(graph: &PoseGraph) -> f64 {
    let free = graph.nodes().filter(|(_, node)| !node.fixed).count();
    let redundant = 3.0 * graph.edge_count().saturating_sub(free) as f64;
    (graph.chi2() + STATED_WEIGHT) / (redundant + STATED_WEIGHT)
}

#[cfg(test)]
mod tests {
    use nalgebra::{Matrix3, Vector3};
    use pr_geom::{Rng, SE2};

    use super::*;
    use crate::graph::EdgeKind;

    /// A chain whose nodes are linked to the next ones; the errors of the measurements are normal, with
    /// `times` the stated deviation.
    fn linked(nodes: usize, reach: usize, times: f64) -> PoseGraph {
        let mut rng = Rng::new(1);
        let mut graph = PoseGraph::new();
        graph.add_fixed_node(SE2::identity());
        (1..nodes).for_each(|k| {
            graph.add_node(SE2::from_xy(k as f64, 0.0));
        });
        let sigma = 0.01;
        let information = Matrix3::identity() / (sigma * sigma);
        for from in 0..nodes {
            for to in (from + 1..nodes).take(reach) {
                let error = Vector3::from_fn(|_, _| rng.normal(0.0, times * sigma));
                let measured = SE2::from_xy((to - from) as f64, 0.0) * SE2::exp(&error);
                graph.add_edge(from, to, measured, information, EdgeKind::Odometry);
            }
        }
        graph.optimize(20, 1e-12);
        graph
    }

    #[test]
    fn a_chain_without_loops_keeps_its_stated_variance() {
        let factor = variance_factor(&linked(30, 1, 5.0));
        assert!((factor - 1.0).abs() < 1e-9, "{factor}");
    }

    #[test]
    fn understated_noise_is_detected_from_loop_residuals() {
        for (times, expected) in [(0.2, 0.04), (1.0, 1.0), (3.0, 9.0)] {
            let factor = variance_factor(&linked(120, 3, times));
            // 235 measurements of three numbers each are redundant: the deviation of their mean square is 5 %.
            assert!(
                (factor / expected - 1.0).abs() < 0.15,
                "{factor}, {expected}"
            );
        }
    }
}
