//! The chapter's worked example and the two increments.

use ch16_slam2d::icp::{closed_form, point_to_plane_step, svd_align};
use pr_geom::{Point2, SE2, Vector2};
use proptest::prelude::*;
use std::f64::consts::TAU;

/// Four points a metre from the origin along the axes.
fn square() -> [Point2<f64>; 4] {
    [
        Point2::new(1.0, 0.0),
        Point2::new(0.0, 1.0),
        Point2::new(-1.0, 0.0),
        Point2::new(0.0, -1.0),
    ]
}

/// The same four, turned by the angle of the 3-4-5 triangle and moved by (2, 1).
fn moved_square() -> [Point2<f64>; 4] {
    [
        Point2::new(2.8, 1.6),
        Point2::new(1.4, 1.8),
        Point2::new(1.2, 0.4),
        Point2::new(2.6, 0.2),
    ]
}

#[test]
fn four_points_give_two_one_and_36_8699_degrees_with_trace_bound_four() {
    let found = closed_form(&square(), &moved_square());
    // 1e-12: four roundings of numbers of order 1.
    assert!((found.pose.x() - 2.0).abs() < 1e-12);
    assert!((found.pose.y() - 1.0).abs() < 1e-12);
    assert!((found.pose.theta() - 0.6_f64.atan2(0.8)).abs() < 1e-12);
    assert!((found.trace_bound - 4.0).abs() < 1e-12);
    assert_eq!(format!("{:.4}", found.pose.theta().to_degrees()), "36.8699");
    assert_eq!(svd_align(&square(), &moved_square()), found.pose);
}

#[test]
fn a_reflection_is_not_aligned_as_a_rotation() {
    let mirrored = square().map(|p| Point2::new(-p.x, p.y));
    let found = closed_form(&square(), &mirrored);
    // About the axes of a mirrored square all rotations are equal: tr(R H) = 0.
    assert!(found.trace_bound < 1e-12);
}

#[test]
fn without_pairs_the_increment_is_the_identity() {
    assert_eq!(svd_align(&[], &[]), SE2::identity());
    assert_eq!(point_to_plane_step(&[], &[], &[]), SE2::identity());
}

#[test]
fn along_a_corridor_the_damped_step_is_zero() {
    // Two walls along x; the cloud has an offset of (0.5, 0.1), and no normal constrains the 0.5.
    let walls: Vec<Point2<f64>> = (0..20)
        .flat_map(|k| {
            let x = 0.1 * f64::from(k);
            [Point2::new(x, 0.0), Point2::new(x, 1.2)]
        })
        .collect();
    let source: Vec<_> = walls.iter().map(|p| p + Vector2::new(0.5, 0.1)).collect();
    let normals = vec![Some(Vector2::y()); walls.len()];
    let step = point_to_plane_step(&source, &walls, &normals);
    let twist = step.translation();
    assert!(twist.x.abs() < 1e-12, "{step:?}");
    // The ridge, 1e-4 of the mean eigenvalue, reduces the step across by that share.
    assert!((twist.y + 0.1).abs() < 2e-5, "{step:?}");
    assert!(step.theta().abs() < 1e-12, "{step:?}");
}

fn mean(points: &[Point2<f64>]) -> Point2<f64> {
    let sum: Vector2<f64> = points.iter().map(|p| p.coords).sum();
    (sum / points.len() as f64).into()
}

fn cost(pose: &SE2, src: &[Point2<f64>], dst: &[Point2<f64>]) -> f64 {
    let pairs = src.iter().zip(dst);
    pairs
        .map(|(p, q)| (pose.transform(*p) - q).norm_squared())
        .sum()
}

fn plane_cost(
    pose: &SE2,
    src: &[Point2<f64>],
    dst: &[Point2<f64>],
    normals: &[Vector2<f64>],
) -> f64 {
    let pairs = src.iter().zip(dst).zip(normals);
    pairs
        .map(|((p, q), n)| n.dot(&(pose.transform(*p) - q)).powi(2))
        .sum()
}

prop_compose! {
    fn pairs()(count in 4_usize..30)(
        numbers in prop::collection::vec((-3.0..3.0, -3.0..3.0, -3.0..3.0, -3.0..3.0, 0.0..TAU), count)
    ) -> (Vec<Point2<f64>>, Vec<Point2<f64>>, Vec<Vector2<f64>>) {
        let src = numbers.iter().map(|n| Point2::new(n.0, n.1)).collect();
        let dst = numbers.iter().map(|n| Point2::new(n.2, n.3)).collect();
        let normals = numbers.iter().map(|n: &(f64, f64, f64, f64, f64)| {
            Vector2::new(n.4.cos(), n.4.sin())
        }).collect();
        (src, dst, normals)
    }
}

proptest! {
    #[test]
    fn no_motion_near_the_closed_form_has_a_lower_cost(
        (src, dst, _) in pairs(),
        dx in -0.1..0.1, dy in -0.1..0.1, turn in -0.1..0.1,
    ) {
        let best = svd_align(&src, &dst);
        let other = best * SE2::new(dx, dy, turn);
        // 1e-9: the costs are sums of up to 30 squares of order 10.
        prop_assert!(cost(&best, &src, &dst) <= cost(&other, &src, &dst) + 1e-9);
    }

    #[test]
    fn the_cost_of_the_closed_form_follows_from_its_trace_bound((src, dst, _) in pairs()) {
        let found = closed_form(&src, &dst);
        let spread = |points: &[Point2<f64>]| {
            let mean = mean(points);
            points.iter().map(|p| (p - mean).norm_squared()).sum::<f64>()
        };
        let expected = spread(&src) + spread(&dst) - 2.0 * found.trace_bound;
        prop_assert!((cost(&found.pose, &src, &dst) - expected).abs() < 1e-9);
    }

    /// The step's Jacobian `(n, lever)` against finite differences: the step solves
    /// `(H + ridge) step = −g/2`, so with the right Jacobian it descends for any positive H.
    #[test]
    fn the_plane_step_goes_down_the_numeric_gradient((src, far, normals) in pairs()) {
        // Targets a few centimetres away, so that the linearization is valid.
        let dst: Vec<_> = src.iter().zip(&far).map(|(p, q)| p + 0.01 * q.coords).collect();
        let wrapped: Vec<_> = normals.iter().copied().map(Some).collect();
        let step = point_to_plane_step(&src, &dst, &wrapped);
        let center = mean(&src);
        let about = |x: f64, y: f64, turn: f64| {
            SE2::from_xy(center.x + x, center.y + y)
                * SE2::new(0.0, 0.0, turn)
                * SE2::from_xy(-center.x, -center.y)
        };
        let h = 1e-5;
        let slope = |x: f64, y: f64, turn: f64| {
            let ahead = plane_cost(&about(h * x, h * y, h * turn), &src, &dst, &normals);
            let behind = plane_cost(&about(-h * x, -h * y, -h * turn), &src, &dst, &normals);
            (ahead - behind) / (2.0 * h)
        };
        prop_assume!(step.theta().abs() < 1.0);
        let moved_center = step.transform(center) - center;
        let descent = slope(1.0, 0.0, 0.0) * moved_center.x
            + slope(0.0, 1.0, 0.0) * moved_center.y
            + slope(0.0, 0.0, 1.0) * step.theta();
        // 1e-8: central differences of a cost of order 0.01 at h = 1e-5 round to about 1e-12/h.
        prop_assert!(descent <= 1e-8, "slope along the step: {descent}");

    }
}
