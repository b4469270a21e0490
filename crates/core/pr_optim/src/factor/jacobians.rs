//! Residual and Jacobians of a factor as matrices, to inspect or to modify.
//!
//! The solver does not form them: it multiplies them into blocks at once, see
//! [`Linearization`](super::Linearization).

use nalgebra::{Matrix3, Vector3};
use pr_geom::SE2;

use super::{PreparedFactor, PreparedPose, Residual};

/// A residual and its derivatives with respect to the two poses, for perturbations on the right.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Jacobians {
    /// e, tangent order x, y, θ.
    pub residual: Vector3<f64>,
    /// ∂e/∂δ of the pose from which the other was measured, 3×3.
    pub from: Matrix3<f64>,
    /// ∂e/∂δ of the measured pose, 3×3.
    pub to: Matrix3<f64>,
}

impl PreparedFactor {
    /// `e`, `−Jr⁻¹(e) Ad(Tⱼ⁻¹Tᵢ)` and `Jr⁻¹(e)`: the residual and its exact derivatives.
    ///
    /// Solà, Deray, Atchuthan 2018, eq. (65), (76), (77) and, for SE(2), (163).
    #[must_use]
    pub fn jacobians(&self, from: &PreparedPose, to: &PreparedPose) -> Jacobians {
        let Residual { e, alpha, gamma } = self.evaluate(from, to);
        let beta = 0.5 * e[2];
        let jr_inverse = Matrix3::new(
            alpha,
            -beta,
            0.5 * e[1] + gamma * e[2] * e[0],
            beta,
            alpha,
            gamma * e[2] * e[1] - 0.5 * e[0],
            0.0,
            0.0,
            1.0,
        );
        let pose = |pose: &PreparedPose| SE2::new(pose.x, pose.y, pose.theta);
        let from_from_to = pose(to).between(&pose(from));
        Jacobians {
            residual: Vector3::from(e),
            from: -(jr_inverse * from_from_to.adjoint()),
            to: jr_inverse,
        }
    }
}
