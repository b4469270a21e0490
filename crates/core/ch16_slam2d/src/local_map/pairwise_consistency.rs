//! Mutual consistency of two loops.

use nalgebra::Matrix3;
use pr_geom::SE2;

use crate::chi_squared::GATE_99;
use crate::loops::LoopVerification;
use crate::slam::Mapper;

/// Whether two loops imply the same correction of the path: `e = log((Tᵢ Z)⁻¹ Tₖ Zₖ Tⱼ⁻¹ T)` within the gate of the
/// covariances of both loops and of the paths between their ends.
pub(super) fn are_consistent(
    mapper: &mut Mapper,
    first: &LoopVerification,
    second: &LoopVerification,
) -> bool {
    let graph = mapper.graph_mut();
    let (Ok(between_new), Ok(between_old)) = (
        graph.relative_covariance(first.from_node, second.from_node),
        graph.relative_covariance(first.candidate.node, second.candidate.node),
    ) else {
        return false;
    };
    let way = graph
        .pose(first.from_node)
        .between(&graph.pose(second.from_node));
    let claim = |found: &LoopVerification| graph.pose(found.candidate.node) * found.registered;
    let e = claim(second).between(&(claim(first) * way)).log();
    // Each in the tangent space of the second one's new keyframe.
    let moved = |covariance: &Matrix3<f64>, by: &SE2| {
        let adjoint = by.inverse().adjoint();
        adjoint * covariance * adjoint.transpose()
    };
    let (Some(first_own), Some(second_own)) = (
        first.information.try_inverse(),
        second.information.try_inverse(),
    ) else {
        return false;
    };
    let covariance = between_new
        + second_own
        + moved(&first_own, &way)
        + moved(&between_old, &second.registered);
    let information = covariance.try_inverse();
    information.is_some_and(|information| e.dot(&(information * e)) <= GATE_99)
}
