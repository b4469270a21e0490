//! The drift that the loop gate assumes: a diagonal covariance that grows with the path, or that of the graph.

use nalgebra::{Matrix3, Vector3};
use pr_optim::OptimizeError;

use crate::graph::PoseGraph;
use crate::loops::{GateModel, LoopConfig};

/// Information of the drift over a path of `gap` nodes: diagonal, with standard deviations proportional to √gap.
#[must_use]
pub fn path_information(gap: usize, config: &LoopConfig) -> Matrix3<f64> {
    let steps = gap as f64;
    let xy = 1.0 / (config.drift_sigma_m * config.drift_sigma_m * steps);
    let theta = 1.0 / (config.drift_sigma_rad * config.drift_sigma_rad * steps);
    Matrix3::from_diagonal(&Vector3::new(xy, xy, theta))
}

/// The S⁻¹ of the gate between two nodes.
pub(super) fn gate_information(
    graph: &mut PoseGraph,
    node: usize,
    candidate: usize,
    loops: &LoopConfig,
) -> Result<Matrix3<f64>, OptimizeError> {
    match loops.gate_model {
        GateModel::PathApproximation => Ok(path_information(node - candidate, loops)),
        GateModel::ExactMarginal => marginal_information(graph, candidate, node),
    }
}

/// Information of the drift by the graph: the inverse of the exact covariance of the pose of `new` in
/// the frame of `old`; see [`PoseGraph::relative_covariance`].
///
/// # Errors
/// If the graph has no covariance: its normal equations are not positive definite or not finite.
///
/// # Panics
/// If a node does not exist.
pub fn marginal_information(
    graph: &mut PoseGraph,
    old: usize,
    new: usize,
) -> Result<Matrix3<f64>, OptimizeError> {
    let covariance = graph.relative_covariance(old, new)?;
    covariance
        .try_inverse()
        .ok_or(OptimizeError::NotPositiveDefinite { node: new })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::chi_squared::CHAPTER_GATE;
    use crate::loops::chi_squared_gate;

    #[test]
    fn drift_of_the_path_grows_with_the_square_root_of_its_length() {
        let config = LoopConfig::default();
        let (one, nine) = (path_information(1, &config), path_information(9, &config));
        assert!((one[(0, 0)].sqrt() - 1.0 / 0.045).abs() < 1e-9);
        assert!((one[(2, 2)] / nine[(2, 2)] - 9.0).abs() < 1e-12);
    }

    #[test]
    fn an_innovation_of_three_sigma_in_x_has_chi2_nine() {
        let config = LoopConfig::default();
        let innovation = Vector3::new(-3.0 * 0.045 * 5.0, 0.0, 0.0);
        let test = chi_squared_gate(&innovation, &path_information(25, &config), CHAPTER_GATE);
        assert!((test.chi2 - 9.0).abs() < 1e-12);
        assert!(!test.passes());
        let nan = chi_squared_gate(&innovation, &Matrix3::repeat(f64::NAN), CHAPTER_GATE);
        assert!(!nan.passes());
    }
}
