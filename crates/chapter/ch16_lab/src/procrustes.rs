//! The orthogonal matrix that aligns paired points best: the trace over all candidates.
//!
//! About the centroids the cost of a matrix is `Σ‖p‖² + Σ‖q‖² − 2 tr(M W)` with `W = Σ p qᵀ`, so the best
//! matrix has the largest trace. In the plane the orthogonal matrices are two circles, the rotations `R(θ)`
//! and the reflections `R(θ) diag(1, −1)`, and on each of them the trace is one sinusoid:
//!
//! ```text
//! tr(R(θ) W)             = a cos(θ − θ_a),   a = hypot(w_xx + w_yy, w_xy − w_yx)
//! tr(R(θ) diag(1,−1) W)  = b cos(θ − θ_b),   b = hypot(w_xx − w_yy, w_xy + w_yx)
//! ```
//!
//! The singular values of `W` are `(a + b)/2` and `|a − b|/2`. Their sum bounds every trace, and the larger
//! of `a` and `b` reaches it. If `det W < 0` that is the reflection, and the best rotation reaches only `s₁ −
//! s₂`: the last singular value counts against it. If `W` has rank 1 both reach the bound.
//!
//! Sources: Schönemann 1966; Arun, Huang & Blostein 1987; Umeyama 1991.

mod pairs;

use ch16_slam2d::icp::closed_form;
use nalgebra::{Matrix2, Point2};
use pr_geom::{Rotation, SE2, math};

pub use pairs::{Pairs, Shape};

/// Relative difference below which two traces count as equal.
const TIE: f64 = 1e-9;

/// The two kinds of orthogonal matrices in the plane.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Handedness {
    /// Determinant +1: left stays left.
    Turn,
    /// Determinant −1: left becomes right.
    Mirror,
}

impl Handedness {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Turn, Self::Mirror];

    /// The orthogonal matrix of this kind with that angle: `R(θ)`, or `R(θ) diag(1, −1)`.
    #[must_use]
    pub fn matrix(self, theta_rad: f64) -> Matrix2<f64> {
        let Rotation { cos, sin } = Rotation::new(theta_rad);
        match self {
            Self::Turn => Matrix2::new(cos, -sin, sin, cos),
            Self::Mirror => Matrix2::new(cos, sin, sin, -cos),
        }
    }
}

/// The kind with the larger trace.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Winner {
    /// A rotation: `det W > 0`.
    Turn,
    /// A reflection: `det W < 0`.
    Mirror,
    /// Both, because `W` has rank 1 at most: two points, or a straight line.
    Tie,
}

/// The best matrix of one kind.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Best {
    /// Its angle, rad.
    pub theta_rad: f64,
    /// `tr(M W)`, m².
    pub trace_m2: f64,
}

/// Paired points about their centroids.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Procrustes {
    /// `W = Σ (p − p̄)(q − q̄)ᵀ`, m².
    pub moments: Matrix2<f64>,
    /// Mean of the source, m.
    pub source_mean: Point2<f64>,
    /// Mean of the target, m.
    pub target_mean: Point2<f64>,
    /// The result of [`svd_align`](ch16_slam2d::icp::svd_align), `target_from_source`.
    pub aligned: SE2,
    /// Whether the pairs measure its heading; coincident points do not.
    pub measures_rotation: bool,
    /// `Σ‖p‖² + Σ‖q‖²` about the means, m².
    spread_m2: f64,
}

impl Procrustes {
    /// Sets up the problem for these pairs; everything is zero without any.
    ///
    /// # Panics
    /// If the slices differ in length.
    #[must_use]
    pub fn new(source: &[Point2<f64>], target: &[Point2<f64>]) -> Self {
        let aligned = closed_form(source, target);
        let (source_mean, target_mean) = (mean(source), mean(target));
        let mut moments = Matrix2::zeros();
        let mut spread_m2 = 0.0;
        for (p, q) in source.iter().zip(target) {
            let (a, b) = (p - source_mean, q - target_mean);
            moments += a * b.transpose();
            spread_m2 += a.norm_squared() + b.norm_squared();
        }
        Self {
            moments,
            source_mean,
            target_mean,
            aligned: aligned.pose,
            measures_rotation: aligned.measures_rotation,
            spread_m2,
        }
    }

    /// `tr(M W)` of the matrix of that kind and angle, m².
    #[must_use]
    pub fn trace_m2(&self, kind: Handedness, theta_rad: f64) -> f64 {
        (kind.matrix(theta_rad) * self.moments).trace()
    }

    /// `Σ ‖M p − q‖²` about the means, m².
    #[must_use]
    pub fn cost_m2(&self, kind: Handedness, theta_rad: f64) -> f64 {
        math::max(0.0, self.spread_m2 - 2.0 * self.trace_m2(kind, theta_rad))
    }

    /// The matrix of that kind with the largest trace.
    #[must_use]
    pub fn best(&self, kind: Handedness) -> Best {
        let h = &self.moments;
        let (cos_part, sin_part) = match kind {
            Handedness::Turn => (h[(0, 0)] + h[(1, 1)], h[(0, 1)] - h[(1, 0)]),
            Handedness::Mirror => (h[(0, 0)] - h[(1, 1)], h[(0, 1)] + h[(1, 0)]),
        };
        Best {
            theta_rad: math::atan2(sin_part, cos_part),
            trace_m2: math::norm2(sin_part, cos_part),
        }
    }

    /// The singular values of `W`, the larger one first, m².
    #[must_use]
    pub fn singular_values_m2(&self) -> [f64; 2] {
        let [turn, mirror] = Handedness::ALL.map(|kind| self.best(kind).trace_m2);
        [0.5 * (turn + mirror), 0.5 * (turn - mirror).abs()]
    }

    /// The bound `s₁ + s₂` of the trace of any orthogonal matrix, m².
    #[must_use]
    pub fn bound_m2(&self) -> f64 {
        let [first, second] = self.singular_values_m2();
        first + second
    }

    /// The kind of matrix that reaches the bound.
    #[must_use]
    pub fn winner(&self) -> Winner {
        let [turn, mirror] = Handedness::ALL.map(|kind| self.best(kind).trace_m2);
        if (turn - mirror).abs() <= TIE * math::max(turn, mirror) {
            Winner::Tie
        } else if turn > mirror {
            Winner::Turn
        } else {
            Winner::Mirror
        }
    }

    /// The result of the decomposition without the check of the determinant: the best orthogonal matrix. If
    /// both kinds tie, either may result; this returns the reflection.
    #[must_use]
    pub fn unchecked(&self) -> (Handedness, Best) {
        let kind = match self.winner() {
            Winner::Turn => Handedness::Turn,
            Winner::Mirror | Winner::Tie => Handedness::Mirror,
        };
        (kind, self.best(kind))
    }

    /// Transforms a point of the source by the matrix of that kind and angle, with the centroids aligned.
    #[must_use]
    pub fn moved(&self, kind: Handedness, theta_rad: f64, point: Point2<f64>) -> Point2<f64> {
        self.target_mean + kind.matrix(theta_rad) * (point - self.source_mean)
    }
}

fn mean(points: &[Point2<f64>]) -> Point2<f64> {
    let mut sum = nalgebra::Vector2::zeros();
    for point in points {
        sum += point.coords;
    }
    Point2::from(sum / points.len().max(1) as f64)
}

#[cfg(test)]
mod tests {
    use super::*;
    use ch16_slam2d::icp::svd_align;
    use pr_sim::Rng;

    fn points(count: usize, rng: &mut Rng) -> Vec<Point2<f64>> {
        let point = |_| Point2::new(rng.uniform(-2.0, 2.0), rng.uniform(-2.0, 2.0));
        (0..count).map(point).collect()
    }

    fn cases() -> impl Iterator<Item = (Vec<Point2<f64>>, Vec<Point2<f64>>)> {
        let mut rng = Rng::new(16);
        (0..200).map(move |k| {
            let count = 2 + k % 5;
            (points(count, &mut rng), points(count, &mut rng))
        })
    }

    #[test]
    fn no_turn_and_no_mirror_image_passes_the_sum_of_the_singular_values() {
        for (source, target) in cases() {
            let problem = Procrustes::new(&source, &target);
            let singular = problem.moments.singular_values();
            let [first, second] = problem.singular_values_m2();
            // 1e-12: another algorithm, and values of at most some tens.
            assert!((first - singular.max()).abs() < 1e-12);
            assert!((second - singular.min()).abs() < 1e-12);
            for kind in Handedness::ALL {
                for degrees in 0..360 {
                    let trace = problem.trace_m2(kind, f64::from(degrees).to_radians());
                    assert!(trace <= problem.bound_m2() + 1e-12);
                    assert!(trace <= problem.best(kind).trace_m2 + 1e-12);
                }
                let best = problem.best(kind);
                let reached = problem.trace_m2(kind, best.theta_rad);
                assert!((reached - best.trace_m2).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn the_alignment_of_the_core_is_the_best_turn_also_where_a_mirror_image_wins() {
        let mut mirrored = 0;
        for (source, target) in cases() {
            let problem = Procrustes::new(&source, &target);
            let best = problem.best(Handedness::Turn);
            assert_eq!(problem.aligned, svd_align(&source, &target));
            let off = SE2::new(0.0, 0.0, problem.aligned.theta() - best.theta_rad);
            assert!(off.theta().abs() < 1e-9);
            mirrored += usize::from(problem.winner() == Winner::Mirror);
        }
        assert!(
            mirrored > 40,
            "random pairs are as often mirrored: {mirrored}"
        );
    }

    #[test]
    fn the_sign_of_the_determinant_decides_between_rotation_and_reflection() {
        for (source, target) in cases().filter(|(source, _)| source.len() > 2) {
            let problem = Procrustes::new(&source, &target);
            let expected = if problem.moments.determinant() > 0.0 {
                Winner::Turn
            } else {
                Winner::Mirror
            };
            assert_eq!(problem.winner(), expected);
            let (kind, best) = problem.unchecked();
            assert_eq!(
                kind.matrix(best.theta_rad).determinant() > 0.0,
                expected == Winner::Turn
            );
        }
    }

    #[test]
    fn two_points_fit_a_rotation_and_a_reflection_equally() {
        for (source, target) in cases().filter(|(source, _)| source.len() == 2) {
            let problem = Procrustes::new(&source, &target);
            assert_eq!(problem.winner(), Winner::Tie);
            let costs =
                Handedness::ALL.map(|kind| problem.cost_m2(kind, problem.best(kind).theta_rad));
            assert!((costs[0] - costs[1]).abs() < 1e-12, "{costs:?}");
        }
    }

    #[test]
    fn a_mirrored_copy_is_matched_without_a_rest_by_the_mirror_image_alone() {
        let source = points(4, &mut Rng::new(3));
        let target: Vec<_> = source.iter().map(|p| Point2::new(p.y, p.x)).collect();
        let problem = Procrustes::new(&source, &target);
        let cost = |kind| problem.cost_m2(kind, problem.best(kind).theta_rad);
        assert!(cost(Handedness::Mirror) < 1e-12 && cost(Handedness::Turn) > 0.1);
        let best = problem.best(Handedness::Mirror);
        for (p, q) in source.iter().zip(&target) {
            let moved = problem.moved(Handedness::Mirror, best.theta_rad, *p);
            assert!((moved - q).norm() < 1e-12);
        }
    }

    #[test]
    fn no_pairs_and_equal_points_give_zeros() {
        let here = [Point2::new(1.0, 2.0); 3];
        for (source, target) in [(&here[..0], &here[..0]), (&here[..], &here[..])] {
            let problem = Procrustes::new(source, target);
            assert_eq!(problem.bound_m2(), 0.0);
            assert_eq!(problem.winner(), Winner::Tie);
            assert_eq!(problem.aligned.theta(), 0.0);
        }
    }
}
