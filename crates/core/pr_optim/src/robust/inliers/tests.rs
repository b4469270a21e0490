//! Tests of the refinement of a selection.

use nalgebra::Matrix3;

use super::*;
use crate::factor::Between;
use crate::robust::LOOP_CHI2;

/// Ten poses on a line with true loops from the first to the last five, and a false one to the fourth.
fn line() -> (Problem, Vec<bool>) {
    let mut problem = Problem::new();
    let along = |from: usize, to: usize, off_m: f64| Between {
        from,
        to,
        measurement: SE2::from_xy((to - from) as f64, off_m),
        information: Matrix3::identity() * 100.0,
    };
    for k in 0..10 {
        problem.add_pose(SE2::from_xy(f64::from(k), 0.0));
    }
    problem.fix(0);
    (1..10).for_each(|to| problem.add_factor(along(to - 1, to, 0.0)));
    (5..10).for_each(|to| problem.add_factor(along(0, to, 0.0)));
    problem.add_factor(along(0, 3, 2.0));
    let trusted = (0..problem.factors().len()).map(|k| k < 9).collect();
    (problem, trusted)
}

#[test]
fn a_refinement_ends_at_the_first_selection_that_is_enough() {
    let (problem, trusted) = line();
    let search = Search::new(&problem, &trusted, Settings::default(), LOOP_CHI2);
    let (poses, all) = (problem.poses(), vec![true; trusted.len()]);
    let start = InlierStart::PresentPoses;
    let mut passed = Vec::new();
    let refined = search.improved_until(poses.to_vec(), all.clone(), start, |inliers| {
        passed.push(inliers.to_vec());
        false
    });
    let is_false_loop = |k: usize| k == trusted.len() - 1;
    let refined = refined.unwrap().inliers;
    assert!((0..refined.len()).all(|k| refined[k] != is_false_loop(k)));
    assert_eq!(passed, [all.clone(), refined]);
    let again = search.improved_until(poses.to_vec(), all.clone(), start, |inliers| {
        passed.iter().any(|known| known == inliers)
    });
    assert_eq!(again.unwrap().inliers, all);
}
