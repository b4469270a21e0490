//! The two increments: the best rigid motion for given pairs.

use nalgebra::{Matrix3, Point2, SymmetricEigen, Vector2, Vector3};
use pr_geom::{Rotation, SE2, math};

/// Pairs with normals that a point-to-plane step needs: one for every degree of freedom.
pub(super) const MIN_NORMALS: usize = 3;
/// Most sweeps of the eigenvalue decomposition that names a direction.
const MAX_SWEEPS: usize = 100;
/// `tr(R H)` of a pair, m², up to which no rotation is measured: the points lie within a micrometre of their centroid.
const MIN_TRACE_M2: f64 = 1e-12;

/// The rigid motion that aligns paired points, and the bound that it reaches.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct RigidAlignment {
    /// The motion `dst_from_src`.
    pub pose: SE2,
    /// The largest `tr(R H)` over all rotations, m²: the cost is `Σ‖p‖² + Σ‖q‖² − 2 tr(R H)` about
    /// the centroids, so no rotation has a lower cost.
    pub trace_bound: f64,
    /// Whether the pairs measure the rotation. Those of one point, or of a cloud and its mirror image, fit as well at
    /// every heading, and the heading of `pose` is arbitrary.
    pub measures_rotation: bool,
}

/// The motion that minimizes `Σ ‖R p_k + t − q_k‖²` over paired points.
///
/// Equals the solution by the singular value decomposition of `W = Σ (p_k − p̄)(q_k − q̄)ᵀ`, without
/// reflections; in the plane it has a closed form, see [`closed_form`], which also returns whether the pairs measure
/// the rotation: coincident points do not, and keep the heading. Without pairs, the result is the identity.
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
    .pose
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
            measures_rotation: false,
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
    let trace_bound = math::norm2(cross, dot);
    RigidAlignment {
        pose: SE2::new(qx - rx, qy - ry, theta),
        trace_bound,
        measures_rotation: trace_bound > MIN_TRACE_M2 * total,
    }
}

#[inline]
pub(super) fn point_to_plane(pairs: impl Iterator<Item = PlanePair>) -> PlaneStep {
    let (mut count, mut cx, mut cy) = (0_usize, 0.0, 0.0);
    let mut hessian = PlaneHessian::default();
    let (mut gx, mut gy, mut gw) = (0.0, 0.0, 0.0);
    // A pair's row of the Jacobian is (nx, ny, lever). The levers are about the map's origin here, and moved to the
    // centroid later.
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
        return PlaneStep::none(count);
    }
    let (cx, cy) = (cx / count as f64, cy / count as f64);
    hessian.turn_about(cx, cy);
    gw -= cx * gy - cy * gx;
    let measured = hessian.matrix();
    let mut damped = measured;
    let ridge = 1e-4 * damped.trace() / 3.0 + 1e-12;
    for k in 0..3 {
        damped[(k, k)] += ridge;
    }
    let Some(factor) = damped.cholesky() else {
        return PlaneStep::none(count);
    };
    let step = factor.solve(&Vector3::new(-gx, -gy, -gw));
    let (rx, ry) = Rotation::new(step.z).rotate(cx, cy);
    PlaneStep {
        pose: SE2::new(cx + step.x - rx, cy + step.y - ry, step.z),
        normals: count,
        measured,
        ridge,
    }
}

/// An increment, and what its pairs measured.
pub(super) enum Solved {
    Points(RigidAlignment),
    Planes(PlaneStep),
    Custom(SE2),
}

impl Solved {
    pub fn pose(&self) -> SE2 {
        match self {
            Self::Points(found) => found.pose,
            Self::Planes(step) => step.pose,
            Self::Custom(pose) => *pose,
        }
    }

    /// Pairs with a normal, if it is by them.
    pub fn normals(&self) -> Option<usize> {
        match self {
            Self::Planes(step) => Some(step.normals),
            Self::Points(_) | Self::Custom(_) => None,
        }
    }

    /// A motion `(t_x, t_y, ω)` about the centroid that the pairs do not measure, of unit length.
    pub fn unobservable(&self) -> Option<[f64; 3]> {
        match self {
            Self::Points(found) => (!found.measures_rotation).then_some([0.0, 0.0, 1.0]),
            Self::Planes(step) => step.unobservable(),
            Self::Custom(_) => None,
        }
    }
}

/// A point-to-plane step, and the system that it solved.
pub(super) struct PlaneStep {
    pub pose: SE2,
    /// Pairs with a normal.
    pub normals: usize,
    /// `Σ w J Jᵀ` about the centroid, without the ridge.
    measured: Matrix3<f64>,
    ridge: f64,
}

impl PlaneStep {
    fn none(normals: usize) -> Self {
        Self {
            pose: SE2::identity(),
            normals,
            measured: Matrix3::zeros(),
            ridge: 1.0,
        }
    }

    /// The motion that the pairs measure least, if the ridge holds it and not the pairs.
    fn unobservable(&self) -> Option<[f64; 3]> {
        let excess = self.measured - Matrix3::identity() * self.ridge;
        if excess.cholesky().is_some() {
            return None;
        }
        // Scaled, because squares of numbers near the largest overflow; without a solution the rotation stands for all.
        let scaled = self.measured / math::max(self.measured.amax(), f64::MIN_POSITIVE);
        let eigen = SymmetricEigen::try_new(scaled, f64::EPSILON, MAX_SWEEPS);
        Some(eigen.map_or([0.0, 0.0, 1.0], |eigen| {
            let least = eigen.eigenvectors.column(eigen.eigenvalues.imin());
            [least[0], least[1], least[2]]
        }))
    }
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
