//! A ring of poses whose initial guess is wound up: each heading of it is off by more than the one before.
//!
//! The measurements are good, and one minimum explains them. Beyond half a turn in all, the loop's heading residual is
//! nearer to zero by the wrong side, and Gauss–Newton rests in a ring that goes round twice.

use nalgebra::{Matrix3, Vector3};
use pr_geom::{Rng, SE2};
use pr_optim::init::chordal;
use pr_optim::{Between, JacobianModel, LinearSolver, Optimizer, Problem, Settings};

/// Poses of the ring.
const POSES: usize = 12;
/// Length of an edge, m.
const SIDE_M: f64 = 1.0;
/// Standard deviations of an edge, m and rad.
const SIGMA_M: f64 = 0.05;
const SIGMA_RAD: f64 = 0.05;

/// The ring at the poses of its own odometry.
pub fn ring() -> Problem {
    let turn = core::f64::consts::TAU / POSES as f64;
    let step = SE2::new(SIDE_M, 0.0, turn);
    let sigmas = [SIGMA_M, SIGMA_M, SIGMA_RAD];
    let information = sigmas.map(|sigma| 1.0 / (sigma * sigma));
    let information = Matrix3::from_diagonal(&Vector3::from(information));
    let mut rng = Rng::new(16);
    let mut problem = Problem::new();
    problem.add_fixed_pose(SE2::identity());
    for from in 0..POSES {
        let noise = Vector3::from(sigmas.map(|sigma| rng.normal(0.0, sigma)));
        let measurement = step * SE2::exp(&noise);
        let to = (from + 1) % POSES;
        if to > 0 {
            problem.add_pose(problem.poses()[from] * measurement);
        }
        problem.add_factor(Between {
            from,
            to,
            measurement,
            information,
        });
    }
    problem
}

/// The poses of the ring's odometry with `twist_rad` more rotation from the first to the last.
pub fn wound_up(ring: &Problem, twist_rad: f64) -> Vec<SE2> {
    let more = SE2::new(0.0, 0.0, twist_rad / POSES as f64);
    let mut poses = vec![ring.poses()[0]];
    for edge in &ring.factors()[..POSES - 1] {
        poses.push(poses[edge.from] * edge.measurement * more);
    }
    poses
}

/// The ring after Gauss–Newton from these poses.
pub fn solved_from(poses: &[SE2]) -> Problem {
    let mut problem = ring();
    problem.poses_mut().copy_from_slice(poses);
    let settings = Settings {
        jacobians: JacobianModel::Exact,
        max_iterations: 50,
        ..Settings::default()
    };
    let _ = Optimizer::new(settings).run(&mut problem);
    problem
}

/// The poses of the chordal relaxation, which ignores all given ones.
///
/// # Panics
/// Never: all poses of the ring are connected.
pub fn chordal_start(ring: &Problem) -> Vec<SE2> {
    let mut linear = LinearSolver::new(ring);
    chordal(ring, &mut linear).expect("the ring is connected")
}

#[cfg(test)]
pub mod tests {
    use super::*;

    /// The ring at its best poses.
    pub fn optimum() -> Problem {
        solved_from(&chordal_start(&ring()))
    }

    /// The ring that goes round twice.
    pub fn knot() -> Problem {
        solved_from(&wound_up(&ring(), core::f64::consts::TAU))
    }

    fn chi2_from(twist_deg: f64) -> f64 {
        solved_from(&wound_up(&ring(), twist_deg.to_radians())).chi2()
    }

    #[test]
    fn a_guess_that_is_wound_up_by_more_than_half_a_turn_ends_in_another_minimum() {
        let best = optimum().chi2();
        // 1e-6: both end at the same minimum, up to the tolerance of the step.
        assert!((chi2_from(0.0) - best).abs() < 1e-6);
        assert!((chi2_from(90.0) - best).abs() < 1e-6);
        assert!(chi2_from(360.0) > 10.0 * best);
    }

    #[test]
    fn the_chordal_start_does_not_depend_on_the_guess() {
        let ring = ring();
        let mut wound = ring.clone();
        let poses = wound_up(&ring, 5.0);
        wound.poses_mut()[1..].copy_from_slice(&poses[1..]);
        assert_eq!(chordal_start(&ring), chordal_start(&wound));
    }
}
