//! 3. The residual of an edge and its Jacobians.

use core::f64::consts::FRAC_PI_2;

use ch16_listings::SE2;
use exercises::{jacobians, residual};
use nalgebra::{Matrix3, Vector2, Vector3};
use pr_geom::Rng;

fn random_pose(rng: &mut Rng) -> SE2 {
    let at = Vector2::new(rng.uniform(-3.0, 3.0), rng.uniform(-3.0, 3.0));
    SE2::new(at, rng.uniform(-3.0, 3.0))
}

/// The chapter's worked example: 2 m by the poses, 2.6 m by the loop.
#[test]
fn a_loop_that_says_more_than_the_poses_has_a_negative_error() {
    let at = |x: f64| SE2::new(Vector2::new(x, 0.0), 0.0);
    let e = residual(&at(0.0), &at(2.0), &at(2.6));
    assert!((e - Vector3::new(-0.6, 0.0, 0.0)).norm() < 1e-12, "{e}");
}

/// By hand: a quarter of a circle of radius 1 ends at (1, 1), turned by 90°; followed for unit time it is (π/2, 0, π/2).
#[test]
fn the_error_is_the_logarithm() {
    let quarter = SE2::new(Vector2::new(1.0, 1.0), FRAC_PI_2);
    let e = residual(&SE2::identity(), &quarter, &SE2::identity());
    assert!(
        (e - Vector3::new(FRAC_PI_2, 0.0, FRAC_PI_2)).norm() < 1e-12,
        "{e}"
    );
}

#[test]
fn it_is_zero_if_the_poses_say_what_was_measured_and_depends_on_their_relation_alone() {
    let mut rng = Rng::new(7);
    for _ in 0..50 {
        let [from, z, world] = core::array::from_fn(|_| random_pose(&mut rng));
        let right = residual(&from, &(from * z), &z);
        assert!(right.norm() < 1e-12, "{right}");
        let to = random_pose(&mut rng);
        let e = residual(&from, &to, &z);
        let elsewhere = residual(&(world * from), &(world * to), &z);
        // Turned by almost π a logarithm may jump to −π.
        let apart = SE2::exp(&e).inverse() * SE2::exp(&elsewhere);
        assert!(apart.step_size() < 1e-9, "{e} and {elsewhere}");
    }
}

/// By hand: Z = (1, 2, 90°) has the inverse (−2, 1, −90°).
#[test]
fn the_jacobians_of_a_quarter_turn() {
    let (from, to) = jacobians(&SE2::new(Vector2::new(1.0, 2.0), FRAC_PI_2));
    let expected = Matrix3::new(0.0, -1.0, -1.0, 1.0, 0.0, -2.0, 0.0, 0.0, -1.0);
    assert!((from - expected).amax() < 1e-12, "{from}");
    assert_eq!(to, Matrix3::identity());
}

#[test]
fn if_the_error_is_zero_the_jacobians_are_the_derivatives() {
    let mut rng = Rng::new(8);
    let small = 1e-6;
    for _ in 0..50 {
        let (from, z) = (random_pose(&mut rng), random_pose(&mut rng));
        let to = from * z;
        let (at_from, at_to) = jacobians(&z);
        for k in 0..3 {
            let step = SE2::exp(&(Vector3::ith(k, small)));
            let by_from = residual(&(from * step), &to, &z) / small;
            let by_to = residual(&from, &(to * step), &z) / small;
            // 1e-4: one-sided differences, with arms of up to 4 m.
            assert!(
                (by_from - at_from.column(k)).amax() < 1e-4,
                "{by_from} {at_from}"
            );
            assert!((by_to - at_to.column(k)).amax() < 1e-4, "{by_to} {at_to}");
        }
    }
}
