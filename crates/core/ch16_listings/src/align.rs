//! The two increments: the best motion for given pairs.

use nalgebra::{Matrix2, Matrix3, Point2, Vector2, Vector3};

use crate::{Correspondence, SE2};

/// A point-to-plane step needs a row for each degree of freedom.
const MIN_ROWS: usize = 3;

/// The motion that minimizes `Σ ‖R p + t − q‖²`, by the singular value decomposition of
/// `W = Σ (p − p̄)(q − q̄)ᵀ = U D Vᵀ`: `R = V diag(1, det(V Uᵀ)) Uᵀ`.
///
/// The determinant keeps reflections out (Umeyama 1991). Without pairs, the result is the identity.
///
/// # Panics
/// If the slices differ in length.
#[must_use]
pub fn svd_align(src: &[Point2<f64>], dst: &[Point2<f64>]) -> SE2 {
    assert_eq!(src.len(), dst.len(), "points come in pairs");
    if src.is_empty() {
        return SE2::identity();
    }
    let mean = |points: &[Point2<f64>]| {
        points.iter().map(|p| p.coords).sum::<Vector2<f64>>() / points.len() as f64
    };
    let (p_mean, q_mean) = (mean(src), mean(dst));
    let w: Matrix2<f64> = src
        .iter()
        .zip(dst)
        .map(|(p, q)| (p.coords - p_mean) * (q.coords - q_mean).transpose())
        .sum();
    let svd = w.svd(true, true);
    let (Some(u), Some(v_t)) = (svd.u, svd.v_t) else {
        return SE2::identity();
    };
    let v = v_t.transpose();
    let sign = (v * u.transpose()).determinant().signum();
    // The singular values come in descending order: the sign goes to the smaller one.
    let r = v * Matrix2::from_diagonal(&Vector2::new(1.0, sign)) * u.transpose();
    let theta = pr_geom::math::atan2(r[(1, 0)], r[(0, 0)]);
    SE2::new(q_mean - r * p_mean, theta)
}

/// One Gauss–Newton step on `Σ (n·(p − q))²` over the pairs with normals.
///
/// Rows `(n, (p − c) × n)` about the centroid c of the moved points: about a far origin each turn
/// would be a shift as well. The ridge, `1e-4 · tr(H)/3 + 1e-12`, gives a direction that no normal
/// sees no step instead of an arbitrary one. Fewer than three normals give the identity.
#[must_use]
pub fn point_to_plane_step(pairs: &[Correspondence]) -> SE2 {
    let planes: Vec<(Point2<f64>, Vector2<f64>, f64)> = pairs
        .iter()
        .filter_map(|pair| {
            let n = pair.normal?;
            Some((pair.src, n, n.dot(&(pair.src - pair.dst))))
        })
        .collect();
    if planes.len() < MIN_ROWS {
        return SE2::identity();
    }
    let sum: Vector2<f64> = planes.iter().map(|(p, ..)| p.coords).sum();
    let centroid = sum / planes.len() as f64;
    let (mut h, mut g) = (Matrix3::zeros(), Vector3::zeros());
    for (p, n, error) in planes {
        let row = Vector3::new(n.x, n.y, (p.coords - centroid).perp(&n));
        h += row * row.transpose();
        g += row * error;
    }
    h += Matrix3::identity() * (1e-4 * h.trace() / 3.0 + 1e-12);
    let Some(step) = h.lu().solve(&-g) else {
        return SE2::identity();
    };
    // Turn about the centroid, then shift.
    let about = SE2::new(centroid, 0.0);
    SE2::new(step.xy(), 0.0) * about * SE2::new(Vector2::zeros(), step.z) * about.inverse()
}
