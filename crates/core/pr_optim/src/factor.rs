//! One measurement between two poses: residual, Jacobians, contribution to the normal equations.
//!
//! A factor is the measured pose `Z` of pose `j` in the frame of pose `i`, with information Ω (3×3, in the order
//! of the tangent: x, y, θ). Its residual is
//!
//! ```text
//! e = log(E),   E = Z⁻¹ Tᵢ⁻¹ Tⱼ
//! ```
//!
//! With perturbations on the right, `T exp(δ)`:
//!
//! ```text
//! ∂e/∂δⱼ =  Jr⁻¹(e)                    ∂e/∂δᵢ = −Jr⁻¹(e) Ad(Tⱼ⁻¹Tᵢ)
//! ```
//!
//! Solà, Deray, Atchuthan 2018, eq. (65), (76), (77) and, for SE(2), (163).

use nalgebra::{Matrix3, Vector3};
use pr_geom::{Rotation, SE2, math, wrap_angle};

use crate::kernel::RobustKernel;

mod jacobians;

pub use jacobians::Jacobians;

/// Which derivative of the residual the solver uses.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum JacobianModel {
    /// `−Ad(Z⁻¹)` and `I`: exact for a zero residual, as in the chapter's listing.
    #[default]
    Chapter,
    /// The exact derivative of the log residual: fewer iterations for large residuals.
    Exact,
}

/// A measured relative pose `from_from_to` of two poses, with its information matrix.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Between {
    /// Index of the pose from which `to` was measured.
    pub from: usize,
    /// Index of the measured pose.
    pub to: usize,
    /// The measured pose of `to` in the frame of `from`, metres and radians.
    pub measurement: SE2,
    /// Inverse covariance of the residual, 1/m², 1/(m·rad), 1/rad².
    pub information: Matrix3<f64>,
}

/// A pose with precomputed sine and cosine of its heading, shared by all its factors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PreparedPose {
    /// x in metres.
    pub x: f64,
    /// y in metres.
    pub y: f64,
    /// Heading in radians.
    pub theta: f64,
    /// cos and sin of the heading.
    pub rotation: Rotation,
}

impl PreparedPose {
    /// Computes sine and cosine of `pose`.
    #[inline]
    #[must_use]
    pub fn new(pose: &SE2) -> Self {
        Self {
            x: pose.x(),
            y: pose.y(),
            theta: pose.theta(),
            rotation: pose.rotation(),
        }
    }

    /// `T ⊞ δ = T exp(δ)`, the same bits as [`SE2::boxplus`].
    #[inline]
    #[must_use]
    pub fn boxplus(&self, delta: &Vector3<f64>) -> SE2 {
        let motion = SE2::exp(delta);
        let (x, y) = self.rotation.rotate(motion.x(), motion.y());
        SE2::new(x + self.x, y + self.y, self.theta + motion.theta())
    }
}

/// Contribution of one factor to the normal equations `H δ = −g`.
///
/// With `W = JⱼᵀΩJⱼ`, `B = −Ad` and `g_j = JⱼᵀΩe`, the blocks are `H_jj = W`, `H_ji = W B`, `H_ii = BᵀW B`,
/// `g_i = Bᵀg_j`: only one 3×3 product with Ω is needed. A symmetric block is stored as its upper triangle, xx, xy, xθ,
/// yy, yθ, θθ; the other one is column-major.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Linearization {
    /// The symmetric block of pose `from`.
    pub from_from: [f64; 6],
    /// The block in the rows of pose `to` and the columns of pose `from`.
    pub to_from: [f64; 9],
    /// The symmetric block of pose `to`.
    pub to_to: [f64; 6],
    /// Half of the derivative of the cost with respect to pose `from`.
    pub gradient_from: [f64; 3],
    /// Half of the derivative of the cost with respect to pose `to`.
    pub gradient_to: [f64; 3],
    /// `eᵀΩe`, without the kernel.
    pub squared_norm: f64,
}

/// The residual and the scalars of `Jr⁻¹` that its computation yields.
#[derive(Clone, Copy)]
struct Residual {
    e: [f64; 3],
    /// `(θ/2) cot(θ/2)`.
    alpha: f64,
    /// `(1 − alpha)/θ²`.
    gamma: f64,
}

/// A [`Between`] in the form that the inner loops read: sine and cosine of Z, six entries of Ω.
#[derive(Clone, Copy, Debug)]
pub struct PreparedFactor {
    measurement: PreparedPose,
    /// Ω as xx, xy, xθ, yy, yθ, θθ.
    omega: [f64; 6],
}

impl PreparedFactor {
    /// Computes sine and cosine of the measurement. Reads the upper triangle of Ω.
    #[must_use]
    pub fn new(factor: &Between) -> Self {
        let omega = &factor.information;
        Self {
            measurement: PreparedPose::new(&factor.measurement),
            omega: [
                omega[(0, 0)],
                omega[(0, 1)],
                omega[(0, 2)],
                omega[(1, 1)],
                omega[(1, 2)],
                omega[(2, 2)],
            ],
        }
    }

    /// `log(Z⁻¹ Tᵢ⁻¹ Tⱼ)`, order x, y, θ.
    #[inline]
    #[must_use]
    pub fn residual(&self, from: &PreparedPose, to: &PreparedPose) -> Vector3<f64> {
        Vector3::from(self.evaluate(from, to).e)
    }

    /// `eᵀΩe` of the residual.
    #[inline]
    #[must_use]
    pub fn squared_norm(&self, from: &PreparedPose, to: &PreparedPose) -> f64 {
        let e = self.evaluate(from, to).e;
        let t = self.weigh(e);
        e[0] * t[0] + e[1] * t[1] + e[2] * t[2]
    }

    #[inline]
    fn evaluate(&self, from: &PreparedPose, to: &PreparedPose) -> Residual {
        let z = &self.measurement;
        let (px, py) = from.rotation.unrotate(to.x - from.x, to.y - from.y);
        let (ux, uy) = z.rotation.unrotate(px - z.x, py - z.y);
        let theta = wrap_angle(to.theta - from.theta - z.theta);
        let gamma = log_curvature(theta);
        let alpha = 1.0 - gamma * theta * theta;
        let beta = 0.5 * theta;
        Residual {
            e: [alpha * ux + beta * uy, alpha * uy - beta * ux, theta],
            alpha,
            gamma,
        }
    }

    /// `Ω e`.
    #[inline]
    fn weigh(&self, e: [f64; 3]) -> [f64; 3] {
        let [xx, xy, xt, yy, yt, tt] = self.omega;
        [
            xx * e[0] + xy * e[1] + xt * e[2],
            xy * e[0] + yy * e[1] + yt * e[2],
            xt * e[0] + yt * e[1] + tt * e[2],
        ]
    }

    /// Blocks and gradients of this factor at the given poses.
    #[inline(always)]
    #[must_use]
    pub fn linearize(
        &self,
        from: &PreparedPose,
        to: &PreparedPose,
        model: JacobianModel,
        kernel: RobustKernel,
    ) -> Linearization {
        let residual = self.evaluate(from, to);
        let e = residual.e;
        let t = self.weigh(e);
        let squared_norm = e[0] * t[0] + e[1] * t[1] + e[2] * t[2];
        let weight = kernel.weight(squared_norm);
        let [xx, xy, xt, yy, yt, tt] = self.omega.map(|entry| weight * entry);
        let t = t.map(|entry| weight * entry);
        match model {
            JacobianModel::Chapter => {
                let z = &self.measurement;
                // Z⁻¹ = (−Rᵀz, −θ).
                let (mx, my) = z.rotation.unrotate(-z.x, -z.y);
                let to_to = [xx, xy, xt, yy, yt, tt];
                push_back(
                    to_to,
                    t,
                    (z.rotation.cos, -z.rotation.sin),
                    (mx, my),
                    squared_norm,
                )
            }
            JacobianModel::Exact => {
                let Residual { alpha, gamma, .. } = residual;
                let beta = 0.5 * e[2];
                // Jr⁻¹ = [α −β k; β α l; 0 0 1].
                let k = 0.5 * e[1] + gamma * e[2] * e[0];
                let l = gamma * e[2] * e[1] - 0.5 * e[0];
                // Columns of Ω Jr⁻¹, the entries that the upper triangle of W needs.
                let (ax, ay) = (alpha * xx + beta * xy, alpha * xy + beta * yy);
                let (bx, by) = (alpha * xy - beta * xx, alpha * yy - beta * xy);
                let cx = k * xx + l * xy + xt;
                let cy = k * xy + l * yy + yt;
                let ct = k * xt + l * yt + tt;
                let to_to = [
                    alpha * ax + beta * ay,
                    alpha * bx + beta * by,
                    alpha * cx + beta * cy,
                    alpha * by - beta * bx,
                    alpha * cy - beta * cx,
                    k * cx + l * cy + ct,
                ];
                let gradient = [
                    alpha * t[0] + beta * t[1],
                    alpha * t[1] - beta * t[0],
                    k * t[0] + l * t[1] + t[2],
                ];
                // Tⱼ⁻¹Tᵢ.
                let (mx, my) = to.rotation.unrotate(from.x - to.x, from.y - to.y);
                let cos = from.rotation.cos * to.rotation.cos + from.rotation.sin * to.rotation.sin;
                let sin = from.rotation.sin * to.rotation.cos - from.rotation.cos * to.rotation.sin;
                push_back(to_to, gradient, (cos, sin), (mx, my), squared_norm)
            }
        }
    }
}

/// Fills in a [`Linearization`] from `W` and `g_j`. `−B = Ad` is the adjoint of the motion with rotation
/// `(cos, sin)` and translation `(x, y)`.
#[inline]
fn push_back(
    to_to: [f64; 6],
    gradient_to: [f64; 3],
    (cos, sin): (f64, f64),
    (x, y): (f64, f64),
    squared_norm: f64,
) -> Linearization {
    let [xx, xy, xt, yy, yt, tt] = to_to;
    // Columns of W Ad.
    let p = [
        cos * xx + sin * xy,
        cos * xy + sin * yy,
        cos * xt + sin * yt,
    ];
    let q = [
        cos * xy - sin * xx,
        cos * yy - sin * xy,
        cos * yt - sin * xt,
    ];
    let r = [
        y * xx - x * xy + xt,
        y * xy - x * yy + yt,
        y * xt - x * yt + tt,
    ];
    let [gx, gy, gt] = gradient_to;
    Linearization {
        from_from: [
            cos * p[0] + sin * p[1],
            cos * q[0] + sin * q[1],
            cos * r[0] + sin * r[1],
            cos * q[1] - sin * q[0],
            cos * r[1] - sin * r[0],
            y * r[0] - x * r[1] + r[2],
        ],
        to_from: [
            -p[0], -p[1], -p[2], -q[0], -q[1], -q[2], -r[0], -r[1], -r[2],
        ],
        to_to,
        gradient_from: [
            -(cos * gx + sin * gy),
            -(cos * gy - sin * gx),
            -(y * gx - x * gy + gt),
        ],
        gradient_to,
        squared_norm,
    }
}

/// `(1 − (θ/2) cot(θ/2)) / θ²`, which is 1/12 at zero.
///
/// The coefficients of the Taylor series are the Bernoulli numbers `B₂ₙ/(2n)!`. Below 0.5 rad the first
/// neglected term is less than 1e-15 of the sum, so small residuals need no call of sin or cos.
#[inline]
fn log_curvature(theta: f64) -> f64 {
    let square = theta * theta;
    if square < 0.25 {
        let tail = 691.0 / 1_307_674_368_000.0 + square / 74_724_249_600.0;
        1.0 / 12.0
            + square
                * (1.0 / 720.0
                    + square
                        * (1.0 / 30_240.0
                            + square
                                * (1.0 / 1_209_600.0
                                    + square * (1.0 / 47_900_160.0 + square * tail))))
    } else {
        let (sin, cos) = math::sin_cos(0.5 * theta);
        (1.0 - 0.5 * theta * cos / sin) / square
    }
}

#[cfg(test)]
mod tests;
