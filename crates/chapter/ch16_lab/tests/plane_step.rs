//! The point-to-plane step against finite differences of the cost that it lowers.

use ch16_lab::basin::BasinScene;
use ch16_slam2d::icp::{IcpConfig, IcpVariant, Pair, centroid, correspondences, icp};
use pr_geom::{Matrix3, Point2, SE2, Vector3};
use proptest::prelude::*;
use std::f64::consts::TAU;

/// Half the step of a central difference, m and rad.
const H: f64 = 1e-5;

/// The steps of a difference: `H` along x, along y, and in heading.
fn axes() -> [Vector3<f64>; 3] {
    [Vector3::x() * H, Vector3::y() * H, Vector3::z() * H]
}

/// The pairs that have normals, frozen: the points move, their partners do not change.
struct FrozenPairs {
    pairs: Vec<Pair>,
    centroid: Point2<f64>,
}

impl FrozenPairs {
    fn new(mut pairs: Vec<Pair>) -> Self {
        pairs.retain(|pair| pair.normal.is_some());
        let centroid = centroid(&pairs);
        Self { pairs, centroid }
    }

    /// The distance along the normal with the point turned by ω about the centroid and then moved
    /// by `(t_x, t_y)`, m.
    fn residual(&self, pair: &Pair, step: Vector3<f64>) -> f64 {
        let turn = SE2::new(0.0, 0.0, step.z).rotation_matrix();
        let moved = self.centroid + turn * (pair.source - self.centroid) + step.xy();
        pair.normal
            .expect("kept for its normal")
            .dot(&(moved - pair.target))
    }

    fn cost(&self, step: Vector3<f64>) -> f64 {
        let squares = self
            .pairs
            .iter()
            .map(|pair| self.residual(pair, step).powi(2));
        squares.sum()
    }

    /// The derivative of the cost by `(t_x, t_y, ω)`.
    fn gradient(&self) -> Vector3<f64> {
        Vector3::from(axes().map(|step| (self.cost(step) - self.cost(-step)) / (2.0 * H)))
    }

    /// `Σ J Jᵀ`, every row J a difference of a residual.
    fn hessian(&self) -> Matrix3<f64> {
        let row = |pair: &Pair| {
            let change = |step| self.residual(pair, step) - self.residual(pair, -step);
            Vector3::from(axes().map(|step| change(step) / (2.0 * H)))
        };
        let rows = self.pairs.iter().map(row);
        rows.map(|row| row * row.transpose()).sum()
    }

    /// The motion `increment` as `(t_x, t_y, ω)` about the centroid.
    fn about_the_centroid(&self, increment: &SE2) -> Vector3<f64> {
        let moved = increment.transform(self.centroid) - self.centroid;
        Vector3::new(moved.x, moved.y, increment.theta())
    }
}

/// Residual of `(H + ridge) step = −½ gradient` as a share of the gradient, from differences alone.
fn left_over(frozen: &FrozenPairs, step: Vector3<f64>) -> f64 {
    let gradient = frozen.gradient();
    let hessian = frozen.hessian();
    let ridge = Matrix3::identity() * (1e-4 * hessian.trace() / 3.0 + 1e-12);
    ((hessian + ridge) * step + 0.5 * gradient).norm() / (1.0 + gradient.norm())
}

/// The third derivative by ω times H²/6, and the rounding of the cost over 2 H.
const DIFFERENCES: f64 = 1e-7;

/// The pairs at a guess, and the step that one iteration makes from there.
fn frozen_pairs_and_step(scene: &BasinScene, init: SE2, tau: f64) -> (FrozenPairs, Vector3<f64>) {
    let config = IcpConfig {
        max_iterations: 1,
        ..BasinScene::config(IcpVariant::PointToPlane, tau)
    };
    let (source, map) = (scene.source(), scene.map());
    let frozen = FrozenPairs::new(correspondences(source, map, init, &config));
    let moved = icp(source, map, init, &config).pose;
    let step = frozen.about_the_centroid(&(moved * init.inverse()));
    (frozen, step)
}

proptest! {
    #[test]
    fn the_step_solves_the_damped_system_of_differences(
        dx in -0.6..0.6, dy in -0.6..0.6, turn_rad in -3.0..3.0, tau in 0.3..1.6,
    ) {
        let scene = BasinScene::new();
        let truth = scene.truth();
        let init = SE2::new(truth.x() + dx, truth.y() + dy, truth.theta() + turn_rad);
        let (frozen, step) = frozen_pairs_and_step(&scene, init, tau);
        prop_assume!(frozen.pairs.len() >= IcpConfig::default().min_pairs);
        // From a guess with the wrong heading a linear step may turn by more than π, which the pose stores
        // modulo a full turn.
        let left_over = [-TAU, 0.0, TAU]
            .map(|whole_turn| left_over(&frozen, step + Vector3::z() * whole_turn))
            .into_iter()
            .fold(f64::INFINITY, f64::min);
        prop_assert!(left_over < DIFFERENCES, "{left_over:e} after {step}");
    }
}

#[test]
fn a_step_of_the_wrong_sign_or_length_does_not_solve_it() {
    let scene = BasinScene::new();
    let init = scene.truth() * SE2::new(0.1, -0.05, 0.1);
    let (frozen, step) = frozen_pairs_and_step(&scene, init, 0.7);
    assert!(left_over(&frozen, step) < DIFFERENCES);
    for axis in 0..3 {
        let mut wrong = step;
        wrong[axis] = -wrong[axis];
        assert!(left_over(&frozen, wrong) > 1e-3, "{step}");
    }
    assert!(left_over(&frozen, step * 1.001) > 1e-4);
}
