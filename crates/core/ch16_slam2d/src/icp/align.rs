//! The two increments: the best rigid motion for given pairs.

use nalgebra::{Matrix3, Point2, Vector2, Vector3};
use pr_geom::{Rotation, SE2, math};

/// Pairs with normals that a point-to-plane step needs: one for every degree of freedom.
const MIN_NORMALS: usize = 3;

/// The rigid motion that aligns paired points, and the bound that it reaches.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct RigidAlignment {
    /// The motion `dst_from_src`.
    pub pose: SE2,
    /// The largest `tr(R H)` over all rotations, m²: the cost is `Σ‖p‖² + Σ‖q‖² − 2 tr(R H)` about
    /// the centroids, so no rotation has a lower cost.
    pub trace_bound: f64,
}

/// The motion that minimizes `Σ ‖R p_k + t − q_k‖²` over paired points.
///
/// Equals the solution by the singular value decomposition of `H = Σ (p_k − p̄)(q_k − q̄)ᵀ`, without
/// reflections; in the plane it has a closed form, see [`closed_form`]. No pairs give the identity.
///
/// Source: Arun, Huang & Blostein 1987.
///
/// # Panics
/// If the slices differ in length.
#[must_use]
pub fn svd_align(src: &[Point2<f64>], dst: &[Point2<f64>]) -> SE2 {
    closed_form(src, dst).pose
}

/// [`svd_align`] with the trace of its rotation.
///
/// `θ = atan2(Σ p × q, Σ p · q)` about the centroids, and `tr(R H) = hypot` of the same two sums.
///
/// # Panics
/// If the slices differ in length.
#[must_use]
pub fn closed_form(src: &[Point2<f64>], dst: &[Point2<f64>]) -> RigidAlignment {
    assert_eq!(src.len(), dst.len(), "points come in pairs");
    let pairs = src.iter().zip(dst);
    point_to_point(pairs.map(|(p, q)| PointPair {
        source: (p.x, p.y),
        target: (q.x, q.y),
        weight: 1.0,
    }))
}

/// One Gauss–Newton step on `Σ (n_k·(p_k − q_k))²` over motions of the points `src`.
///
/// The step `(t_x, t_y, ω)` rotates about the centroid of the points that have normals. It is damped
/// by `1e-4 · tr(H)/3 + 1e-12`, so an unconstrained direction, as along a corridor, gets a zero
/// step instead of an arbitrary one. Fewer than 3 normals give the identity.
///
/// Source: Chen & Medioni 1992.
///
/// # Panics
/// If the slices differ in length.
#[must_use]
pub fn point_to_plane_step(
    src: &[Point2<f64>],
    dst: &[Point2<f64>],
    normals: &[Option<Vector2<f64>>],
) -> SE2 {
    assert_eq!(src.len(), dst.len(), "points come in pairs");
    assert_eq!(src.len(), normals.len(), "every pair has an entry");
    let pairs = src.iter().zip(dst).zip(normals);
    point_to_plane(pairs.filter_map(|((p, q), normal)| {
        normal.map(|n| PlanePair {
            source: (p.x, p.y),
            residual_m: n.x * (p.x - q.x) + n.y * (p.y - q.y),
            normal: (n.x, n.y),
            weight: 1.0,
        })
    }))
}

#[derive(Clone, Copy)]
pub(super) struct PointPair {
    pub source: (f64, f64),
    pub target: (f64, f64),
    pub weight: f64,
}

#[derive(Clone, Copy)]
pub(super) struct PlanePair {
    pub source: (f64, f64),
    pub residual_m: f64,
    pub normal: (f64, f64),
    pub weight: f64,
}

#[inline]
pub(super) fn point_to_point(pairs: impl Iterator<Item = PointPair> + Clone) -> RigidAlignment {
    let (mut total, mut px, mut py, mut qx, mut qy) = (0.0, 0.0, 0.0, 0.0, 0.0);
    for PointPair {
        source,
        target,
        weight,
    } in pairs.clone()
    {
        total += weight;
        px += weight * source.0;
        py += weight * source.1;
        qx += weight * target.0;
        qy += weight * target.1;
    }
    if total <= 0.0 {
        return RigidAlignment {
            pose: SE2::identity(),
            trace_bound: 0.0,
        };
    }
    let (px, py, qx, qy) = (px / total, py / total, qx / total, qy / total);
    let (mut dot, mut cross) = (0.0, 0.0);
    for PointPair {
        source,
        target,
        weight,
    } in pairs
    {
        let (ax, ay) = (source.0 - px, source.1 - py);
        let (bx, by) = (target.0 - qx, target.1 - qy);
        dot += weight * (ax * bx + ay * by);
        cross += weight * (ax * by - ay * bx);
    }
    let theta = math::atan2(cross, dot);
    let (rx, ry) = Rotation::new(theta).rotate(px, py);
    RigidAlignment {
        pose: SE2::new(qx - rx, qy - ry, theta),
        trace_bound: math::norm2(cross, dot),
    }
}

#[inline]
pub(super) fn point_to_plane(pairs: impl Iterator<Item = PlanePair>) -> SE2 {
    let (mut count, mut cx, mut cy) = (0_usize, 0.0, 0.0);
    let mut hessian = PlaneHessian::default();
    let (mut gx, mut gy, mut gw) = (0.0, 0.0, 0.0);
    // The levers are about the map's origin here, and moved to the centroid later.
    for pair in pairs {
        count += 1;
        cx += pair.source.0;
        cy += pair.source.1;
        let (nx, ny) = pair.normal;
        let lever = pair.source.0 * ny - pair.source.1 * nx;
        hessian.add(nx, ny, lever, pair.weight);
        let weighted = pair.weight * pair.residual_m;
        gx += weighted * nx;
        gy += weighted * ny;
        gw += weighted * lever;
    }
    if count < MIN_NORMALS {
        return SE2::identity();
    }
    let (cx, cy) = (cx / count as f64, cy / count as f64);
    hessian.turn_about(cx, cy);
    gw -= cx * gy - cy * gx;
    let mut damped = hessian.matrix();
    let ridge = 1e-4 * damped.trace() / 3.0 + 1e-12;
    for k in 0..3 {
        damped[(k, k)] += ridge;
    }
    let Some(factor) = damped.cholesky() else {
        return SE2::identity();
    };
    let step = factor.solve(&Vector3::new(-gx, -gy, -gw));
    let (rx, ry) = Rotation::new(step.z).rotate(cx, cy);
    SE2::new(cx + step.x - rx, cy + step.y - ry, step.z)
}

/// `Σ w J Jᵀ` for rows `J = (n_x, n_y, lever)`.
#[derive(Clone, Copy, Default)]
pub(super) struct PlaneHessian {
    xx: f64,
    xy: f64,
    yy: f64,
    xw: f64,
    yw: f64,
    ww: f64,
}

impl PlaneHessian {
    #[inline]
    pub(super) fn add(&mut self, nx: f64, ny: f64, lever: f64, weight: f64) {
        self.xx += weight * nx * nx;
        self.xy += weight * nx * ny;
        self.yy += weight * ny * ny;
        self.xw += weight * nx * lever;
        self.yw += weight * ny * lever;
        self.ww += weight * lever * lever;
    }

    /// Moves the levers from the origin to `(cx, cy)`: `lever ← lever − (c_x n_y − c_y n_x)`.
    fn turn_about(&mut self, cx: f64, cy: f64) {
        let (xw, yw) = (self.xw, self.yw);
        self.xw = xw - cx * self.xy + cy * self.xx;
        self.yw = yw - cx * self.yy + cy * self.xy;
        // Σ w (l − s)² with s = c_x n_y − c_y n_x, one factor after the other.
        self.ww -= cx * (yw + self.yw) - cy * (xw + self.xw);
    }

    pub(super) fn matrix(&self) -> Matrix3<f64> {
        Matrix3::new(
            self.xx, self.xy, self.xw, //
            self.xy, self.yy, self.yw, //
            self.xw, self.yw, self.ww,
        )
    }
}
