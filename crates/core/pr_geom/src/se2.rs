//! The group SE(2): poses and rigid motions of the plane.

use core::ops::Mul;

use nalgebra::{Matrix2, Matrix3, Point2, Vector2, Vector3};
use serde::{Deserialize, Serialize};

use crate::angle::wrap_angle;
use crate::math;

/// Below this angle (rad) exp and log use the Taylor series of sin θ/θ and (1 − cos θ)/θ.
///
/// At 1e-4 the first neglected term, θ⁴/120, is 1e-18, below the last bit of 1.
const SMALL_ANGLE_RAD: f64 = 1e-4;

/// A rigid motion `world_from_body`: rotate by θ, then translate by `(x, y)`.
#[derive(Clone, Copy, Debug, PartialEq, Default, Serialize, Deserialize)]
#[serde(from = "[f64; 3]", into = "[f64; 3]")]
pub struct SE2 {
    x: f64,
    y: f64,
    theta: f64,
}

/// A rotation with precomputed sine and cosine, for loops over many points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rotation {
    /// cos θ.
    pub cos: f64,
    /// sin θ.
    pub sin: f64,
}

impl Rotation {
    /// The rotation by `theta` radians.
    #[inline]
    #[must_use]
    pub fn new(theta: f64) -> Self {
        let (sin, cos) = math::sin_cos(theta);
        Self { cos, sin }
    }

    /// `R v`.
    #[inline]
    #[must_use]
    pub fn rotate(&self, x: f64, y: f64) -> (f64, f64) {
        (self.cos * x - self.sin * y, self.sin * x + self.cos * y)
    }

    /// `Rᵀ v`.
    #[inline]
    #[must_use]
    pub fn unrotate(&self, x: f64, y: f64) -> (f64, f64) {
        (self.cos * x + self.sin * y, self.cos * y - self.sin * x)
    }
}

impl From<[f64; 3]> for SE2 {
    fn from([x, y, theta]: [f64; 3]) -> Self {
        Self::new(x, y, theta)
    }
}

impl From<SE2> for [f64; 3] {
    fn from(pose: SE2) -> Self {
        pose.to_array()
    }
}

impl SE2 {
    /// The pose at `(x, y)` metres with heading `theta` radians, wrapped to (−π, π].
    #[inline]
    #[must_use]
    pub fn new(x: f64, y: f64, theta: f64) -> Self {
        Self {
            x,
            y,
            theta: wrap_angle(theta),
        }
    }

    /// The identity motion.
    #[inline]
    #[must_use]
    pub fn identity() -> Self {
        Self::default()
    }

    /// A motion without rotation.
    #[inline]
    #[must_use]
    pub fn from_xy(x: f64, y: f64) -> Self {
        Self { x, y, theta: 0.0 }
    }

    /// x in metres.
    #[inline]
    #[must_use]
    pub fn x(&self) -> f64 {
        self.x
    }

    /// y in metres.
    #[inline]
    #[must_use]
    pub fn y(&self) -> f64 {
        self.y
    }

    /// The translation part `(x, y)`, m.
    #[inline]
    #[must_use]
    pub fn translation(&self) -> Vector2<f64> {
        Vector2::new(self.x, self.y)
    }

    /// Position of the body's origin in the world frame, m.
    #[inline]
    #[must_use]
    pub fn position(&self) -> Point2<f64> {
        Point2::new(self.x, self.y)
    }

    /// Heading in radians, in (−π, π].
    #[inline]
    #[must_use]
    pub fn theta(&self) -> f64 {
        self.theta
    }

    /// The pose as `[x, y, θ]`.
    #[inline]
    #[must_use]
    pub fn to_array(&self) -> [f64; 3] {
        [self.x, self.y, self.theta]
    }

    /// The heading as a rotation with precomputed sine and cosine, for a loop over points.
    #[inline]
    #[must_use]
    pub fn rotation(&self) -> Rotation {
        Rotation::new(self.theta)
    }

    /// The 2×2 rotation matrix.
    #[must_use]
    pub fn rotation_matrix(&self) -> Matrix2<f64> {
        let Rotation { cos, sin } = self.rotation();
        Matrix2::new(cos, -sin, sin, cos)
    }

    /// Transforms a point from the body frame to the world frame: `R p + t`.
    #[inline]
    #[must_use]
    pub fn transform(&self, point: Point2<f64>) -> Point2<f64> {
        let (x, y) = self.rotation().rotate(point.x, point.y);
        Point2::new(x + self.x, y + self.y)
    }

    /// Composes two motions, `self ∘ other`: first `other`, then `self`.
    #[inline]
    #[must_use]
    pub fn compose(&self, other: &Self) -> Self {
        let (x, y) = self.rotation().rotate(other.x, other.y);
        Self::new(x + self.x, y + self.y, self.theta + other.theta)
    }

    /// The inverse motion.
    #[inline]
    #[must_use]
    pub fn inverse(&self) -> Self {
        let (x, y) = self.rotation().unrotate(self.x, self.y);
        Self::new(-x, -y, -self.theta)
    }

    /// The relative pose `self⁻¹ ∘ other`: `other` in the frame of `self`.
    #[inline]
    #[must_use]
    pub fn between(&self, other: &Self) -> Self {
        let (x, y) = self.rotation().unrotate(other.x - self.x, other.y - self.y);
        Self::new(x, y, other.theta - self.theta)
    }

    /// The exponential map: the motion of the twist `(v_x, v_y, ω)` in unit time.
    ///
    /// Solà, Deray, Atchuthan 2018, eq. (156) and (158).
    #[must_use]
    pub fn exp(twist: &Vector3<f64>) -> Self {
        let (a, b) = left_jacobian_terms(twist.z);
        Self::new(
            a * twist.x - b * twist.y,
            b * twist.x + a * twist.y,
            twist.z,
        )
    }

    /// The logarithm: the twist `(v_x, v_y, ω)` whose [`SE2::exp`] is this motion, with ω in (−π, π].
    ///
    /// Solà, Deray, Atchuthan 2018, eq. (157).
    #[must_use]
    pub fn log(&self) -> Vector3<f64> {
        let (a, b) = left_jacobian_terms(self.theta);
        let determinant = a * a + b * b;
        Vector3::new(
            (a * self.x + b * self.y) / determinant,
            (a * self.y - b * self.x) / determinant,
            self.theta,
        )
    }

    /// The adjoint: `exp(Ad δ) ∘ T = T ∘ exp(δ)`, 3×3, translation first.
    ///
    /// Solà, Deray, Atchuthan 2018, eq. (159).
    #[must_use]
    pub fn adjoint(&self) -> Matrix3<f64> {
        let Rotation { cos, sin } = self.rotation();
        Matrix3::new(
            cos, -sin, self.y, //
            sin, cos, -self.x, //
            0.0, 0.0, 1.0,
        )
    }

    /// `T ⊞ δ = T ∘ exp(δ)`.
    #[must_use]
    pub fn boxplus(&self, delta: &Vector3<f64>) -> Self {
        self.compose(&Self::exp(delta))
    }

    /// `self ⊟ other = log(other⁻¹ ∘ self)`: the δ with `other ⊞ δ = self`.
    #[must_use]
    pub fn boxminus(&self, other: &Self) -> Vector3<f64> {
        other.between(self).log()
    }

    /// Size of the motion by the chapter's measure of steps: `‖(v_x, v_y)‖ + |ω|` of its log.
    #[must_use]
    pub fn step_size(&self) -> f64 {
        twist_size(&self.log())
    }
}

/// Size of a tangent vector by the chapter's measure of steps: `‖(v_x, v_y)‖ + |ω|`, m and rad added.
#[must_use]
pub fn twist_size(twist: &Vector3<f64>) -> f64 {
    math::norm2(twist.x, twist.y) + twist.z.abs()
}

impl Mul for SE2 {
    type Output = Self;

    #[inline]
    fn mul(self, other: Self) -> Self {
        self.compose(&other)
    }
}

impl Mul<&SE2> for &SE2 {
    type Output = SE2;

    #[inline]
    fn mul(self, other: &SE2) -> SE2 {
        self.compose(other)
    }
}

/// `(sin θ/θ, (1 − cos θ)/θ)`, the two entries of the matrix that couples translation to rotation.
fn left_jacobian_terms(theta: f64) -> (f64, f64) {
    if theta.abs() < SMALL_ANGLE_RAD {
        let square = theta * theta;
        (1.0 - square / 6.0, theta * (0.5 - square / 24.0))
    } else {
        let (sin, cos) = math::sin_cos(theta);
        // 1 − cos θ cancels if θ is small; sin²/(1 + cos) does not.
        let one_minus_cos = if cos > 0.0 {
            sin * sin / (1.0 + cos)
        } else {
            1.0 - cos
        };
        (sin / theta, one_minus_cos / theta)
    }
}
