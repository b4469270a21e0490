//! The group laws of SE(2) on random motions, and the angles at which implementations fail.

use pr_geom::{Matrix3, Point2, SE2, Vector2, Vector3};
use proptest::prelude::*;

/// Rounding of a handful of products of numbers up to 30.
const ROUNDING: f64 = 1e-12;

fn motions() -> impl Strategy<Value = SE2> {
    (-10.0..10.0, -10.0..10.0, -3.1..3.1).prop_map(|(x, y, theta)| SE2::new(x, y, theta))
}

fn twists() -> impl Strategy<Value = Vector3<f64>> {
    (-10.0..10.0, -10.0..10.0, -3.1..3.1).prop_map(|(x, y, omega)| Vector3::new(x, y, omega))
}

fn assert_same(a: SE2, b: SE2, tolerance: f64) {
    let gap = a.boxminus(&b).norm();
    assert!(gap <= tolerance, "{a:?} and {b:?} differ by {gap:e}");
}

proptest! {
    #[test]
    fn composition_is_associative(a in motions(), b in motions(), c in motions()) {
        assert_same((a * b) * c, a * (b * c), 10.0 * ROUNDING);
    }

    #[test]
    fn inverse_undoes_from_both_sides(a in motions()) {
        assert_same(a * a.inverse(), SE2::identity(), 10.0 * ROUNDING);
        assert_same(a.inverse() * a, SE2::identity(), 10.0 * ROUNDING);
    }

    #[test]
    fn between_is_inverse_then_compose(a in motions(), b in motions()) {
        assert_same(a.between(&b), a.inverse() * b, 10.0 * ROUNDING);
    }

    #[test]
    fn log_undoes_exp(twist in twists()) {
        prop_assert!((SE2::exp(&twist).log() - twist).norm() < 100.0 * ROUNDING);
    }

    #[test]
    fn exp_undoes_log(a in motions()) {
        assert_same(SE2::exp(&a.log()), a, 100.0 * ROUNDING);
    }

    #[test]
    fn boxplus_undoes_boxminus(a in motions(), b in motions()) {
        assert_same(a.boxplus(&b.boxminus(&a)), b, 100.0 * ROUNDING);
    }

    #[test]
    fn adjoint_moves_a_perturbation_from_right_to_left(a in motions(), twist in twists()) {
        let left = SE2::exp(&(a.adjoint() * twist)) * a;
        assert_same(left, a * SE2::exp(&twist), 1000.0 * ROUNDING);
    }

    #[test]
    fn adjoint_of_a_product_is_the_product_of_adjoints(a in motions(), b in motions()) {
        let gap: Matrix3<f64> = (a * b).adjoint() - a.adjoint() * b.adjoint();
        prop_assert!(gap.norm() < 100.0 * ROUNDING);
    }

    #[test]
    fn transform_follows_composition(a in motions(), b in motions(), x in -5.0..5.0, y in -5.0..5.0) {
        let point = Point2::new(x, y);
        let gap = (a * b).transform(point) - a.transform(b.transform(point));
        prop_assert!(gap.norm() < 10.0 * ROUNDING);
    }
}

#[test]
fn exp_and_log_are_smooth_across_the_small_angle_branch() {
    for omega in [
        0.0, 1e-12, 1e-8, 1e-6, 9.999e-5, 1.0e-4, 1.001e-4, 1e-3, 1e-2,
    ] {
        for sign in [-1.0, 1.0] {
            let twist = Vector3::new(2.0, -3.0, sign * omega);
            let back = SE2::exp(&twist).log();
            assert!((back - twist).norm() < 1e-14, "omega {omega}: {back:?}");
            // A wrong sign in the odd term moves the end point by ω·‖v‖, far above rounding.
            let half = SE2::exp(&(twist * 0.5));
            assert_same(half * half, SE2::exp(&twist), 1e-14);
        }
    }
}

#[test]
fn exp_and_log_hold_near_the_half_turn() {
    for gap in [1e-3, 1e-8, 1e-12, 0.0] {
        for sign in [-1.0, 1.0] {
            let twist = Vector3::new(0.7, -0.4, sign * (std::f64::consts::PI - gap));
            let back = SE2::exp(&twist);
            assert_same(SE2::exp(&back.log()), back, 1e-14);
        }
    }
}

#[test]
fn a_quarter_turn_of_unit_arc_ends_where_geometry_says() {
    // Radius 2/π forward, so the end is (r, r) with heading 90°.
    let radius = 2.0 / std::f64::consts::PI;
    let end = SE2::exp(&Vector3::new(1.0, 0.0, std::f64::consts::FRAC_PI_2));
    assert!((end.x() - radius).abs() < 1e-15 && (end.y() - radius).abs() < 1e-15);
}

#[test]
fn translation_is_both_constructor_and_accessor() {
    let pose = SE2::from_xy(1.5, -2.0);
    assert_eq!(pose.translation(), Vector2::new(1.5, -2.0));
    assert_eq!(pose.position(), Point2::new(1.5, -2.0));
    assert_eq!(pose.theta(), 0.0);
}
