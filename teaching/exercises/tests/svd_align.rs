//! 1. The closed form.

use ch16_listings::{SE2, Translation};
use ch16_slam2d::icp;
use exercises::svd_align;
use nalgebra::{Point2, Vector2, Vector3};
use pr_geom::Rng;

use crate::canonical::assert_same_pose;

/// Twelve random pairs: no motion fits them well.
fn random_pairs(seed: u32) -> [Vec<Point2<f64>>; 2] {
    let mut rng = Rng::new(seed);
    let mut point = |_| Point2::new(rng.uniform(-3.0, 3.0), rng.uniform(-3.0, 3.0));
    [
        (0..12).map(&mut point).collect(),
        (0..12).map(point).collect(),
    ]
}

/// The chapter's worked example: the rotation of the 3-4-5 triangle, multiplied out by hand, and t = (2, 1).
#[test]
fn four_points_on_the_unit_circle_give_the_motion_that_moved_them() {
    let src = [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]].map(Point2::from);
    let dst = [[2.8, 1.6], [1.4, 1.8], [1.2, 0.4], [2.6, 0.2]].map(Point2::from);
    let found = svd_align(&src, &dst);
    // 1e-12: a dozen roundings of numbers of order 1.
    assert!((found.translation() - Vector2::new(2.0, 1.0)).norm() < 1e-12);
    assert!((found.theta().cos() - 0.8).abs() < 1e-12);
    assert!((found.theta().sin() - 0.6).abs() < 1e-12);
}

#[test]
fn no_motion_nearby_costs_less() {
    for seed in 1..=20 {
        let [src, dst] = random_pairs(seed);
        let cost = |pose: SE2| -> f64 {
            let pairs = src.iter().zip(&dst);
            pairs
                .map(|(p, q)| (pose.transform(p) - q).norm_squared())
                .sum()
        };
        let found = svd_align(&src, &dst);
        for direction in [Vector3::x(), Vector3::y(), Vector3::z()] {
            for step in [-1.0, -1e-3, 1e-3, 1.0, 2.0, 3.0] {
                let moved = found * SE2::exp(&(direction * step));
                assert!(
                    cost(moved) > cost(found),
                    "{step} along {direction} is better"
                );
            }
        }
    }
}

/// Mirrored points: without the sign of the determinant the result would be a reflection.
#[test]
fn mirrored_points_give_the_best_rotation() {
    let src = [[2.0, 0.1], [-2.0, -0.1], [0.3, 1.0], [-0.3, -1.0]].map(Point2::from);
    let dst = src.map(|p| Point2::new(p.x, -p.y));
    // The core solves for the angle.
    assert_same_pose(
        svd_align(&src, &dst),
        icp::svd_align(&src, &dst).into(),
        1e-12,
    );
}

#[test]
fn it_gives_what_the_core_gives() {
    for seed in 21..=60 {
        let [src, dst] = random_pairs(seed);
        // 1e-9: the core adds terms in a different order.
        assert_same_pose(
            svd_align(&src, &dst),
            icp::svd_align(&src, &dst).into(),
            1e-9,
        );
    }
}

#[test]
fn no_pairs_give_the_identity() {
    assert_eq!(svd_align(&[], &[]), SE2::identity());
}

/// Every rotation about the place fits as well, but none moves it elsewhere.
#[test]
fn coincident_points_are_carried_onto_their_partners() {
    let (here, there) = (Point2::new(1.3, -0.7), Point2::new(-0.4, 2.1));
    for count in [1, 2, 9] {
        let found = svd_align(&vec![here; count], &vec![there; count]);
        let off = (found.transform(&here) - there).norm();
        assert!(
            off < 1e-12 && found.theta().is_finite(),
            "{count} coincident points end {off:.2e} m from their partners: {found:?}"
        );
    }
}
