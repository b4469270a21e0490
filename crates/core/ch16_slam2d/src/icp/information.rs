//! The information of a registration, for the edges of the pose graph.

use nalgebra::{Matrix3, Point2, Vector2};
use pr_geom::{Rotation, SE2};

use super::Pair;
use super::align::PlaneHessian;

/// The chapter's ridge for [`regularize`]: every direction has some information.
pub const INFORMATION_RIDGE: f64 = 1.0;
/// The chapter's cap for [`regularize`]: no direction is more certain than 2 cm.
pub const INFORMATION_CAP: f64 = 2500.0;

/// The information of a registration, `Σ J Jᵀ / (σ² · covariance_scale)`, 3×3, translation first.
///
/// A pair with a normal contributes the row `J = (n, lever)`, one without the rows of both axes.
/// `lever` is the displacement of the moved point by a rotation about the centroid of all pairs, along the row's
/// direction (m). The matrix therefore belongs to motions along the axes of the map, about
/// [`centroid`]`(pairs)`; [`move_information`] expresses it elsewhere. `sigma` is the range noise in
/// metres. `covariance_scale` accounts for correlated pairs.
#[must_use]
pub fn icp_information(pairs: &[Pair], sigma: f64, covariance_scale: f64) -> Matrix3<f64> {
    icp_information_along(pairs, sigma, covariance_scale, 0.0)
}

/// [`icp_information`] along the axes of heading `axes_theta` (rad) instead of the map's.
///
/// Each row is `(Rᵀ n, lever)` with the rotation `R` of that heading; the levers stay about the
/// centroid of the pairs. It equals [`move_information`] by a rotation about the centroid, up to rounding.
#[must_use]
pub fn icp_information_along(
    pairs: &[Pair],
    sigma: f64,
    covariance_scale: f64,
    axes_theta: f64,
) -> Matrix3<f64> {
    weighted_information(pairs, sigma, covariance_scale, axes_theta, |_| 1.0)
}

/// [`icp_information_along`] with the rows of each pair times its weight.
pub(crate) fn weighted_information(
    pairs: &[Pair],
    sigma: f64,
    covariance_scale: f64,
    axes_theta: f64,
    weight_of: impl Fn(&Pair) -> f64,
) -> Matrix3<f64> {
    let centroid = centroid(pairs);
    let axes = Rotation::new(axes_theta);
    let mut hessian = PlaneHessian::default();
    let weight = 1.0 / (sigma * sigma * covariance_scale);
    for pair in pairs {
        let arm = pair.source - centroid;
        let weight = weight * weight_of(pair);
        let mut add = |direction: Vector2<f64>| {
            let (nx, ny) = axes.unrotate(direction.x, direction.y);
            let lever = arm.x * direction.y - arm.y * direction.x;
            hessian.add(nx, ny, lever, weight);
        };
        match pair.normal {
            Some(normal) => add(normal),
            None => {
                add(Vector2::x());
                add(Vector2::y());
            }
        }
    }
    hessian.matrix()
}

/// Mean of the moved points of `pairs`, in the map's frame, m; the origin if there are none.
#[must_use]
pub fn centroid(pairs: &[Pair]) -> Point2<f64> {
    let sum = pairs
        .iter()
        .fold(Vector2::zeros(), |sum, pair| sum + pair.source.coords);
    (sum / pairs.len().max(1) as f64).into()
}

/// `Adᵀ Ω Ad` with the adjoint of `old_from_new`: the same information for perturbations at another
/// frame of the same rigid body.
///
/// `information` belongs to perturbations `T ⊞ δ` of the old frame, translation first. A perturbation
/// δ of the new frame moves the old one by `Ad δ`. The information of [`icp_information`] at the
/// origin of a registered body, along its axes, is that for `SE2::from_xy(cx, cy)⁻¹ · map_from_body`
/// with the centroid `(cx, cy)`.
///
/// Source: Solà, Deray, Atchuthan 2018, section II-F.
#[must_use]
pub fn move_information(information: &Matrix3<f64>, old_from_new: &SE2) -> Matrix3<f64> {
    let adjoint = old_from_new.adjoint();
    adjoint.transpose() * information * adjoint
}

/// Bounds an information matrix for the graph: adds `ridge` to the diagonal, then scales the
/// matrix so that no diagonal entry exceeds `cap`.
///
/// Scaling keeps the matrix positive definite; clipping single entries would not.
#[must_use]
pub fn regularize(information: Matrix3<f64>, ridge: f64, cap: f64) -> Matrix3<f64> {
    let ridged = information + Matrix3::identity() * ridge;
    let largest = ridged.diagonal().max();
    if largest > cap {
        ridged * (cap / largest)
    } else {
        ridged
    }
}
