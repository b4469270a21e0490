//! The second gate: the exact covariance of the relative pose instead of the path approximation.

use ch16_lab::lap::{Lap, LapConfig};
use ch16_slam2d::graph::EdgeKind;
use ch16_slam2d::loops::{GateModel, LoopVerification};
use nalgebra::Matrix3;
use pr_geom::SE2;

/// The canonical lap with a gate, and its first attempt to close a loop.
fn lap(gate_model: GateModel) -> (Lap, LoopVerification) {
    let mut config = LapConfig::default();
    config.slam.chapter.loops.gate_model = gate_model;
    let mut lap = Lap::new(config);
    let attempt = lap
        .run()
        .into_iter()
        .find_map(|report| report.loop_attempt)
        .expect("the canonical lap tries to close a loop");
    (lap, attempt.verification)
}

#[test]
fn before_the_first_loop_the_exact_gate_adds_up_the_odometry_edges() {
    let (lap, verification) = lap(GateModel::ExactMarginal);
    // No loop yet: the relative pose is a chain of measurements, and each one's covariance
    // reaches the end through the adjoint of the motion that follows it.
    let mut covariance = Matrix3::zeros();
    let mut end_from_edge = SE2::identity();
    let mut edges: Vec<_> = lap
        .graph()
        .edges()
        .filter(|view| view.edge.kind == EdgeKind::Odometry)
        .filter(|view| view.from.index() >= verification.candidate.node)
        .filter(|view| view.to.index() <= verification.from_node)
        .collect();
    edges.sort_by_key(|view| core::cmp::Reverse(view.from));
    for view in edges {
        let adjoint = end_from_edge.adjoint();
        let own = view.edge.information.try_inverse().unwrap();
        covariance += adjoint * own * adjoint.transpose();
        end_from_edge = end_from_edge * view.edge.measurement.inverse();
    }
    let exact = verification.gate_information.try_inverse().unwrap();
    // 1e-6: the solver's ridge of 1e-9 over a chain of some thirty nodes.
    assert!((covariance - exact).amax() < 1e-6, "{covariance} {exact}");
}

#[test]
fn both_gates_weigh_the_same_innovation_by_their_own_covariance() {
    let (_, path) = lap(GateModel::PathApproximation);
    let (_, exact) = lap(GateModel::ExactMarginal);
    // Up to the first attempt the laps are the same.
    assert_eq!(path.innovation, exact.innovation);
    assert_ne!(path.gate_information, exact.gate_information);
    for verification in [path, exact] {
        let innovation = verification.innovation;
        let chi2 = innovation.dot(&(verification.gate_information * innovation));
        assert_eq!(verification.gate.chi2, chi2);
    }
    // The true relative pose is within both gates.
    assert!(path.accepted() && exact.accepted());
}
