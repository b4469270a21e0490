//! How well a location constrains a pose.

use nalgebra::{Matrix3, SymmetricEigen, Vector2, Vector3};
use pr_geom::math;

use ch16_slam2d::icp::{Pair, icp_information};

/// A direction with less than this share of the largest information counts as degenerate.
const NULL_SHARE: f64 = 0.01;

/// Eigendecomposition of an information matrix, 3×3 over `(v_x, v_y, ω)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PoseInformation {
    /// The matrix: 1/m² for translations, 1/rad² for the heading.
    pub matrix: Matrix3<f64>,
    /// Its eigenvalues, smallest first.
    pub eigenvalues: Vector3<f64>,
    /// The unit eigenvectors, one a column, in the order of the eigenvalues.
    pub eigenvectors: Matrix3<f64>,
}

impl PoseInformation {
    /// Decomposes a symmetric matrix.
    #[must_use]
    pub fn new(matrix: Matrix3<f64>) -> Self {
        let eigen = SymmetricEigen::new(matrix);
        let mut order = [0, 1, 2];
        order.sort_by(|&a, &b| eigen.eigenvalues[a].total_cmp(&eigen.eigenvalues[b]));
        Self {
            matrix,
            eigenvalues: Vector3::from_fn(|k, _| eigen.eigenvalues[order[k]]),
            eigenvectors: Matrix3::from_fn(|row, k| eigen.eigenvectors[(row, order[k])]),
        }
    }

    /// Number of directions with at least 1 % of the largest information.
    #[must_use]
    pub fn rank(&self) -> usize {
        let floor = NULL_SHARE * self.eigenvalues[2];
        self.eigenvalues
            .iter()
            .filter(|&&value| value > floor)
            .count()
    }

    /// The information of a shift with fixed heading: the 2×2 block of the translations.
    #[must_use]
    pub fn of_shift(&self) -> ShiftInformation {
        let (xx, xy, yy) = (self.matrix.m11, self.matrix.m12, self.matrix.m22);
        let center = 0.5 * (xx + yy);
        let half_gap = math::norm2(0.5 * (xx - yy), xy);
        let (sin, cos) = math::sin_cos(0.5 * math::atan2(2.0 * xy, xx - yy));
        ShiftInformation {
            // The block is positive semidefinite; the difference may round below zero.
            eigenvalues: [center + half_gap, (center - half_gap).max(0.0)],
            axes: [Vector2::new(cos, sin), Vector2::new(-sin, cos)],
        }
    }

    /// The direction with the least information, if that is less than 1 % of the largest.
    #[must_use]
    pub fn null_direction(&self) -> Option<Vector3<f64>> {
        (self.rank() < 3).then(|| self.eigenvectors.column(0).into_owned())
    }
}

/// Eigendecomposition of the information of a shift with fixed heading.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShiftInformation {
    /// The eigenvalues, 1/m², the larger first.
    pub eigenvalues: [f64; 2],
    /// The unit eigenvectors in their order.
    pub axes: [Vector2<f64>; 2],
}

/// The point-to-plane information of `pairs` for range noise of `sigma_m`, about their centroid.
#[must_use]
pub fn pose_information(pairs: &[Pair], sigma_m: f64) -> PoseInformation {
    PoseInformation::new(icp_information(pairs, sigma_m, 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_axes_of_a_shift_put_the_block_together_again() {
        for (xx, xy, yy) in [
            (4.0, 0.0, 1.0),
            (1.0, 0.0, 4.0),
            (3.0, -1.2, 2.0),
            (0.0, 0.0, 5.0),
        ] {
            let matrix = Matrix3::new(xx, xy, 0.3, xy, yy, -0.2, 0.3, -0.2, 7.0);
            let ShiftInformation { eigenvalues, axes } = PoseInformation::new(matrix).of_shift();
            assert!(eigenvalues[0] >= eigenvalues[1]);
            let block = axes[0] * axes[0].transpose() * eigenvalues[0]
                + axes[1] * axes[1].transpose() * eigenvalues[1];
            // 1e-14: a few roundings of numbers below 10.
            let block_error = block - matrix.fixed_view::<2, 2>(0, 0);
            assert!(block_error.norm() < 1e-14, "{block}");
        }
    }
}
