//! The information of a registration about its pose.

use nalgebra::Matrix3;
use pr_geom::SE2;

use crate::icp::{
    IcpConfig, IcpResult, Pair, centroid, icp_information, move_information, weighted_information,
};

/// Information of a pair, `1/(σ² · covariance_scale)`, and the bound of their sum.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrustConfig {
    /// Standard deviation of a point in metres.
    pub sigma_m: f64,
    /// Factor on the variance, because pairs are correlated.
    pub covariance_scale: f64,
    /// Largest diagonal entry of an edge's information; see [`regularize`](crate::icp::regularize).
    pub information_cap: f64,
}

/// The information of `pairs` about the pose `target_from_body`, 3×3, translation first.
///
/// With `p` the point in the body's frame, `R` the rotation of the pose and `n` the measured direction of a
/// pair, `Σ J Jᵀ / (σ² · covariance_scale)` with `J = (Rᵀ n, p × Rᵀ n)`: the Gauss–Newton Hessian of
/// `½ Σ (n · (T exp(δ) p − q))² / (σ² · covariance_scale)` at δ = 0. A pair with a normal measures along it,
/// one without along both axes.
#[must_use]
pub fn match_information(
    pairs: &[Pair],
    target_from_body: &SE2,
    trust: &TrustConfig,
) -> Matrix3<f64> {
    let middle = centroid(pairs);
    let middle_from_body = SE2::from_xy(middle.x, middle.y).between(target_from_body);
    move_information(
        &icp_information(pairs, trust.sigma_m, trust.covariance_scale),
        &middle_from_body,
    )
}

/// The information of a result of ICP about its pose: that of the rows that its last increment used, by their weights.
///
/// Zero if the pose is no result of them; see [`StopReason::is_supported`](crate::icp::StopReason::is_supported).
#[must_use]
pub fn result_information(
    found: &IcpResult,
    config: &IcpConfig,
    trust: &TrustConfig,
) -> Matrix3<f64> {
    if !found.stop.is_supported() {
        return Matrix3::zeros();
    }
    let middle = centroid(&found.pairs);
    let (sigma_m, scale) = (trust.sigma_m, trust.covariance_scale);
    let weight = |pair: &Pair| config.weight(pair);
    move_information(
        &weighted_information(&found.pairs, sigma_m, scale, 0.0, weight),
        &SE2::from_xy(middle.x, middle.y).between(&found.pose),
    )
}

#[cfg(test)]
mod tests {
    use nalgebra::{Point2, Vector2, Vector3};

    use super::*;
    use crate::matching::chapter_information;

    const TRUST: TrustConfig = TrustConfig {
        sigma_m: 0.05,
        covariance_scale: 3.0,
        information_cap: f64::INFINITY,
    };

    /// Pairs with zero residual: the body sees a corner of two walls and a post.
    fn pairs() -> Vec<Pair> {
        let in_target = |k: i32| {
            let along = 0.3 * f64::from(k);
            match k % 3 {
                0 => (Point2::new(along, 2.0), Some(Vector2::y())),
                1 => (Point2::new(3.0, along - 1.0), Some(Vector2::x())),
                _ => (Point2::new(-1.0, 0.2 * along), None),
            }
        };
        (0..12)
            .map(|k| {
                let (point, normal) = in_target(k);
                Pair {
                    source_index: k as usize,
                    target_index: k as usize,
                    source: point,
                    target: point,
                    normal,
                }
            })
            .collect()
    }

    /// The cost at the pose `T exp(δ)`, for a numerical Hessian.
    fn cost(pairs: &[Pair], pose: &SE2, delta: &Vector3<f64>) -> f64 {
        let moved = pose.boxplus(delta) * pose.inverse();
        let weight = 1.0 / (TRUST.sigma_m * TRUST.sigma_m * TRUST.covariance_scale);
        let squares = pairs.iter().map(|pair| {
            let (x, y) = moved.rotation().rotate(pair.source.x, pair.source.y);
            let gap = Vector2::new(x + moved.x() - pair.target.x, y + moved.y() - pair.target.y);
            match pair.normal {
                Some(normal) => normal.dot(&gap) * normal.dot(&gap),
                None => gap.norm_squared(),
            }
        });
        0.5 * weight * squares.sum::<f64>()
    }

    fn numerical_hessian(pairs: &[Pair], pose: &SE2) -> Matrix3<f64> {
        let step = 1e-4;
        let unit = |k: usize| Vector3::from_fn(|row, _| if row == k { step } else { 0.0 });
        Matrix3::from_fn(|a, b| {
            let at = |i: f64, j: f64| cost(pairs, pose, &(unit(a) * i + unit(b) * j));
            (at(1.0, 1.0) - at(1.0, -1.0) - at(-1.0, 1.0) + at(-1.0, -1.0)) / (4.0 * step * step)
        })
    }

    /// Largest difference of two matrices, as a share of the first one's largest entry.
    fn off(a: &Matrix3<f64>, b: &Matrix3<f64>) -> f64 {
        (a - b).abs().max() / a.abs().max()
    }

    #[test]
    fn the_information_is_the_hessian_at_the_target_and_the_chapters_is_not() {
        for theta in [0.0, 0.7, core::f64::consts::FRAC_PI_2, -2.5] {
            let pose = SE2::new(0.4, -0.3, theta);
            let pairs = pairs();
            let hessian = numerical_hessian(&pairs, &pose);
            let exact = match_information(&pairs, &pose, &TRUST);
            let chapter = chapter_information(&pairs, theta, &TRUST);
            // 1e-6: steps of 1e-4 have an error of 1e-8 of the fourth derivative, and a rounding error of
            // 1e-16/1e-8.
            assert!(off(&hessian, &exact) < 1e-6, "{theta}");
            assert!(off(&hessian, &chapter) > 0.1, "{theta}");
        }
    }
}
