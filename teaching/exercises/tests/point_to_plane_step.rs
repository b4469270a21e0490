//! 2. The step across the walls.

use ch16_listings::{Correspondence, SE2, Translation};
use ch16_slam2d::icp;
use exercises::point_to_plane_step;
use nalgebra::{Point2, Vector2};
use pr_geom::Rng;

use crate::canonical::assert_same_pose;

fn pair(src: [f64; 2], dst: [f64; 2], normal: Option<Vector2<f64>>) -> Correspondence {
    Correspondence {
        src: src.into(),
        dst: dst.into(),
        normal,
    }
}

/// By hand: points of a wall at x = −1, 0, 1, 0.1 m above it. H = diag(0, 3, 2), so λ = 5e-4/3 + 1e-12, and the step in
/// y is −0.3/(3 + λ).
#[test]
fn a_wall_pulls_across_itself_and_not_along() {
    let wall = [-1.0, 0.0, 1.0].map(|x| pair([x, 0.1], [x + 0.5, 0.0], Some(Vector2::y())));
    let step = point_to_plane_step(&wall);
    let expected = -0.3 / (3.0 + 5e-4 / 3.0 + 1e-12);
    assert!((step.translation().y - expected).abs() < 1e-12, "{step:?}");
    assert_eq!((step.translation().x, step.theta()), (0.0, 0.0));
}

/// Two walls that meet, seen from a pose that is off by `off`.
fn corner(off: SE2, at: Vector2<f64>) -> Vec<Correspondence> {
    let points = (1..=20).flat_map(|k| {
        let along = 0.1 * f64::from(k);
        [
            ([along, 0.0], Vector2::y()),
            ([0.0, along], Vector2::x()),
            ([along, 3.0], -Vector2::y()),
        ]
    });
    let pairs = points.map(|(q, normal)| {
        let moved = off.transform(&Point2::from(q)) + at;
        let q = Point2::from(q) + at;
        pair([moved.x, moved.y], [q.x, q.y], Some(normal))
    });
    pairs.collect()
}

#[test]
fn a_small_error_is_undone_but_for_the_ridge_and_the_square_of_the_turn() {
    let off = SE2::new(Vector2::new(0.02, -0.03), 0.01);
    let left = point_to_plane_step(&corner(off, Vector2::zeros())) * off;
    // 5e-4: the ridge is 1e-4 of the mean curvature, and the weakest direction has about a third of it.
    assert!(left.step_size() < 5e-4, "{left:?} is left");
}

#[test]
fn far_from_the_origin_the_step_is_the_same() {
    let off = SE2::new(Vector2::new(0.02, -0.03), 0.01);
    let near = point_to_plane_step(&corner(off, Vector2::zeros()));
    let away = Vector2::new(1000.0, -2000.0);
    let far = point_to_plane_step(&corner(off, away));
    // Both turn about the centroid of their points; 1e-9: 2000 m have 13 digits left below 1 m.
    let there = SE2::new(away, 0.0);
    assert_same_pose(there.inverse() * far * there, near, 1e-9);
}

#[test]
fn it_gives_what_the_core_gives_and_skips_pairs_without_a_normal() {
    let mut rng = Rng::new(3);
    for _ in 0..50 {
        let mut number = || rng.uniform(-3.0, 3.0);
        let pairs: Vec<Correspondence> = (0..12)
            .map(|k| {
                let normal = Vector2::new(number(), number()).normalize();
                let (src, dst) = ([number(), number()], [number(), number()]);
                pair(src, dst, (k % 4 != 0).then_some(normal))
            })
            .collect();
        let (src, dst): (Vec<_>, Vec<_>) = pairs.iter().map(|c| (c.src, c.dst)).unzip();
        let normals: Vec<_> = pairs.iter().map(|c| c.normal).collect();
        let core = icp::point_to_plane_step(&src, &dst, &normals);
        // 1e-9: the core adds terms in a different order.
        assert_same_pose(point_to_plane_step(&pairs), core.into(), 1e-9);
    }
}

#[test]
fn two_normals_give_the_identity() {
    let mut pairs = corner(
        SE2::new(Vector2::new(0.1, 0.1), 0.1),
        Vector2::new(1.0, 1.0),
    );
    for pair in &mut pairs[2..] {
        pair.normal = None;
    }
    assert_eq!(point_to_plane_step(&pairs), SE2::identity());
}
