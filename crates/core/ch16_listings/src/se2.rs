//! A pose of the plane, built from a vector and an angle.

use core::ops::Mul;

use nalgebra::{Matrix3, Point2, Vector2, Vector3};

/// A rigid motion `world_from_body`; the arithmetic is that of [`pr_geom::SE2`].
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct SE2(pr_geom::SE2);

impl SE2 {
    /// Rotation by `theta` (rad), then translation by `translation` (m).
    #[must_use]
    pub fn new(translation: Vector2<f64>, theta: f64) -> Self {
        Self(pr_geom::SE2::new(translation.x, translation.y, theta))
    }

    /// The identity.
    #[must_use]
    pub fn identity() -> Self {
        Self::default()
    }

    /// A translation by `(x, y)`, m, without rotation; [`Translation`] gives that of a pose.
    #[must_use]
    pub fn translation(x: f64, y: f64) -> Self {
        Self(pr_geom::SE2::new(x, y, 0.0))
    }

    /// Heading in (−π, π], rad.
    #[must_use]
    pub fn theta(&self) -> f64 {
        self.0.theta()
    }

    /// `R p + t`.
    #[must_use]
    pub fn transform(&self, point: &Point2<f64>) -> Point2<f64> {
        self.0.transform(*point)
    }

    /// `R v`: rotates a direction.
    #[must_use]
    pub fn rotate(&self, vector: &Vector2<f64>) -> Vector2<f64> {
        self.0.rotation_matrix() * vector
    }

    /// The inverse motion.
    #[must_use]
    pub fn inverse(&self) -> Self {
        Self(self.0.inverse())
    }

    /// The motion reached by following the twist `(v_x, v_y, ω)` for unit time.
    #[must_use]
    pub fn exp(twist: &Vector3<f64>) -> Self {
        Self(pr_geom::SE2::exp(twist))
    }

    /// The twist `(v_x, v_y, ω)` whose [`SE2::exp`] is this motion.
    #[must_use]
    pub fn log(&self) -> Vector3<f64> {
        self.0.log()
    }

    /// The adjoint, 3×3, translation first: `exp(Ad δ) T = T exp(δ)`.
    #[must_use]
    pub fn adjoint(&self) -> Matrix3<f64> {
        self.0.adjoint()
    }

    /// `‖(v_x, v_y)‖ + |ω|` of the log: the size of a step.
    #[must_use]
    pub fn step_size(&self) -> f64 {
        self.0.step_size()
    }
}

/// The translation of a pose. A trait, because [`SE2::translation`] has the name.
pub trait Translation {
    /// Translation part, m.
    fn translation(&self) -> Vector2<f64>;
}

impl Translation for SE2 {
    fn translation(&self) -> Vector2<f64> {
        self.0.translation()
    }
}

impl Mul for SE2 {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        Self(self.0 * other.0)
    }
}

impl From<pr_geom::SE2> for SE2 {
    fn from(pose: pr_geom::SE2) -> Self {
        Self(pose)
    }
}

impl From<SE2> for pr_geom::SE2 {
    fn from(pose: SE2) -> Self {
        pose.0
    }
}
