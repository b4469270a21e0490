//! False loops in small graphs.

use nalgebra::{Matrix3, Vector3};
use pr_geom::{SE2, math};

use super::*;
use crate::settings::Settings;

/// Pseudo-random numbers: Knuth's multiplier and increment for 64 bits, the upper half.
struct Numbers(u64);

impl Numbers {
    fn unit(&mut self) -> f64 {
        let next = self.0.wrapping_mul(6_364_136_223_846_793_005);
        self.0 = next.wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 40) as f64 / (1_u64 << 24) as f64
    }

    /// Approximately normal with variance 1, by the sum of twelve.
    fn normal(&mut self) -> f64 {
        (0..12).map(|_| self.unit()).sum::<f64>() - 6.0
    }
}

const ROUNDS: usize = 3;
const CORNER: usize = 10;

/// Three laps of a square of 10 m, a loop to the lap before at every second pose, and false loops, `share` times
/// as many, between arbitrary poses.
fn graph(share: f64, seed: u64) -> (Problem, usize) {
    let mut numbers = Numbers(seed);
    let sigmas = Vector3::new(0.02, 0.02, 0.005);
    let information = Matrix3::from_diagonal(&sigmas.map(|s| 1.0 / (s * s)));
    let noisy = |pose: &SE2, numbers: &mut Numbers| {
        let noise = sigmas.map(|s| s * numbers.normal());
        pose.boxplus(&noise)
    };
    let side = |k: usize| {
        let turn = if k % CORNER == CORNER - 1 {
            core::f64::consts::FRAC_PI_2
        } else {
            0.0
        };
        SE2::new(1.0, 0.0, turn)
    };
    let count = ROUNDS * 4 * CORNER;
    let mut truth = vec![SE2::identity()];
    let mut problem = Problem::new();
    problem.add_fixed_pose(truth[0]);
    let add = |problem: &mut Problem, from, to, measurement| {
        problem.add_factor(Between {
            from,
            to,
            measurement,
            information,
        });
    };
    for k in 0..count {
        truth.push(truth[k] * side(k));
        let step = noisy(&side(k), &mut numbers);
        let pose = problem.poses()[k] * step;
        problem.add_pose(pose);
        add(&mut problem, k, k + 1, step);
    }
    let mut right = 0;
    for to in (4 * CORNER..=count).step_by(2) {
        let from = to - 4 * CORNER;
        let between = truth[from].between(&truth[to]);
        add(&mut problem, from, to, noisy(&between, &mut numbers));
        right += 1;
    }
    let last_true = problem.factors().len();
    let mut wrong = (share * f64::from(right)).round() as usize;
    while wrong > 0 {
        let [from, to] = [0, 1].map(|_| (numbers.unit() * count as f64) as usize);
        let apart = truth[from.min(to)].between(&truth[from.max(to)]);
        if math::norm2(apart.x(), apart.y()) < 2.0 || from.abs_diff(to) < 2 {
            continue;
        }
        let claim = SE2::new(
            0.3 * numbers.normal(),
            0.3 * numbers.normal(),
            0.2 * numbers.normal(),
        );
        add(&mut problem, from.min(to), from.max(to), claim);
        wrong -= 1;
    }
    (problem, last_true)
}

fn solved(problem: &Problem) -> Problem {
    let mut problem = problem.clone();
    // With false loops it may not converge: then these are the lowest-cost poses.
    crate::Optimizer::new(Settings::default()).run(&mut problem);
    problem
}

/// Largest distance between corresponding poses of two graphs, m.
fn apart_m(a: &Problem, b: &Problem) -> f64 {
    let pairs = a.poses().iter().zip(b.poses());
    pairs
        .map(|(a, b)| math::norm2(a.x() - b.x(), a.y() - b.y()))
        .fold(0.0, f64::max)
}

fn trusted(problem: &Problem) -> Vec<bool> {
    problem.factors().iter().map(is_sequential).collect()
}

#[test]
fn gnc_drops_false_loops_and_keeps_true_ones_up_to_half_outliers() {
    for loss in [GncLoss::TruncatedLeastSquares, GncLoss::GemanMcClure] {
        for (share, seed) in [(0.0, 1), (0.1, 2), (0.3, 3), (0.5, 4), (1.0, 5)] {
            let settings = GncSettings {
                loss,
                ..GncSettings::default()
            };
            let gnc = |mut problem: Problem| {
                let gnc = Gnc::new(&problem, trusted(&problem), Settings::default(), settings);
                let outcome = gnc.run(&mut problem).unwrap();
                (problem, outcome)
            };
            let (clean, _) = gnc(graph(0.0, seed).0);
            let (spoilt, last_true) = graph(share, seed);
            let plain_m = apart_m(&solved(&spoilt), &clean);
            let (problem, outcome) = gnc(spoilt);
            let robust_m = apart_m(&problem, &clean);
            // Geman–McClure leaves a false loop some thousandths of its weight.
            assert!(robust_m < 0.02, "{loss:?} {share}: {robust_m}");
            assert!(share == 0.0 || plain_m > 1.0, "{share}: {plain_m}");
            let wrong = (last_true..problem.factors().len()).filter(|&k| outcome.is_inlier(k));
            assert_eq!(wrong.count(), 0, "{loss:?} {share}");
        }
    }
}

#[test]
fn gnc_keeps_true_loops_if_drift_makes_all_initial_weights_tiny() {
    // Two laps of a circle of 20 m by odometry that turns 0.01 rad too far at each step, within its noise;
    // loops to the lap before have a noise of a millimetre.
    let diagonal = |xy: f64, theta: f64| Matrix3::from_diagonal(&Vector3::new(xy, xy, theta));
    let (lap, step) = (20, SE2::new(1.0, 0.0, core::f64::consts::TAU / 20.0));
    let mut problem = Problem::new();
    problem.add_fixed_pose(SE2::identity());
    for k in 0..2 * lap {
        let measurement = step * SE2::new(0.0, 0.0, 0.01);
        problem.add_pose(problem.poses()[k] * measurement);
        problem.add_factor(Between {
            from: k,
            to: k + 1,
            measurement,
            information: diagonal(1e2, 1e3),
        });
    }
    for from in 0..=lap {
        problem.add_factor(Between {
            from,
            to: from + lap,
            measurement: SE2::identity(),
            information: diagonal(1e6, 1e6),
        });
    }
    let trusted = trusted(&problem);
    let gnc = Gnc::new(
        &problem,
        trusted,
        Settings::default(),
        GncSettings::default(),
    );
    let outcome = gnc.run(&mut problem).unwrap();
    assert!((0..problem.factors().len()).all(|factor| outcome.is_inlier(factor)));
    let ends = problem.poses()[0].between(&problem.poses()[2 * lap]);
    assert!(math::norm2(ends.x(), ends.y()) < 0.01, "{ends:?}");
}

#[test]
fn pairwise_consistent_loops_are_true() {
    for (share, seed) in [(0.1, 2), (0.5, 4), (1.0, 5)] {
        let (problem, last_true) = graph(share, seed);
        let member = consistent_set(&problem, &ConsistencySettings::default());
        let right = last_true - ROUNDS * 4 * CORNER;
        let kept = member[ROUNDS * 4 * CORNER..last_true]
            .iter()
            .filter(|m| **m)
            .count();
        assert!(member[..ROUNDS * 4 * CORNER].iter().all(|m| *m));
        assert!(10 * kept >= 8 * right, "{share}: {kept} of {right}");
        // False loops within the path's covariance, after a hundred metres of it, may remain.
        let wrong = member[last_true..].iter().filter(|m| **m).count();
        assert!(
            20 * wrong <= problem.factors().len() - last_true,
            "{share}: {wrong}"
        );
    }
}

#[test]
fn a_cycle_without_noise_closes_and_a_metre_off_does_not() {
    let information = Matrix3::identity() * 1e4;
    let mut problem = Problem::new();
    let step = SE2::new(1.0, 0.2, 0.3);
    let mut pose = SE2::identity();
    problem.add_fixed_pose(pose);
    let mut poses = vec![pose];
    let add = |problem: &mut Problem, from, to, measurement| {
        problem.add_factor(Between {
            from,
            to,
            measurement,
            information,
        });
    };
    for k in 0..12 {
        pose = pose * step;
        poses.push(pose);
        problem.add_pose(pose);
        // Every third one is measured backwards.
        if k % 3 == 0 {
            add(&mut problem, k + 1, k, step.inverse());
        } else {
            add(&mut problem, k, k + 1, step);
        }
    }
    let off = SE2::new(1.0, 0.0, 0.0);
    add(&mut problem, 0, 9, poses[0].between(&poses[9]));
    add(&mut problem, 11, 2, poses[11].between(&poses[2]));
    add(&mut problem, 1, 10, poses[1].between(&poses[10]) * off);
    add(&mut problem, 3, 12, poses[3].between(&poses[12]));
    let member = consistent_set(&problem, &ConsistencySettings::default());
    assert_eq!(member[12..], [true, true, false, true]);
}

/// A path through a grid of streets 4 m apart, with a loop to the first visit at every revisited pose, and false
/// loops between arbitrary poses. The measurements state seven times their actual noise, as those of many recorded
/// graphs do.
fn streets(count: usize, share: f64, seed: u64) -> (Problem, usize) {
    let mut numbers = Numbers(seed);
    let stated = Matrix3::identity() * 44.7;
    let noisy = |pose: &SE2, numbers: &mut Numbers| {
        let noise = Vector3::from_fn(|_, _| 0.02 * numbers.normal());
        pose.boxplus(&noise)
    };
    let mut problem = Problem::new();
    problem.add_fixed_pose(SE2::identity());
    let mut truth = vec![SE2::identity()];
    let mut loops = Vec::new();
    let add = |problem: &mut Problem, from, to, measurement| {
        problem.add_factor(Between {
            from,
            to,
            measurement,
            information: stated,
        });
    };
    while truth.len() < count {
        let last = truth[truth.len() - 1];
        let at_crossing = [last.x(), last.y()].map(|v| v.round() as i64 % 4) == [0, 0];
        let turn = match (at_crossing, (numbers.unit() * 3.0) as usize) {
            (true, 0) => core::f64::consts::FRAC_PI_2,
            (true, 1) => -core::f64::consts::FRAC_PI_2,
            _ => 0.0,
        };
        let step = SE2::new(0.0, 0.0, turn) * SE2::new(1.0, 0.0, 0.0);
        let next = last * step;
        // At the edge of the grid the robot turns on the spot first.
        let step = if next.x().abs() > 12.5 || next.y().abs() > 12.5 {
            SE2::new(0.0, 0.0, core::f64::consts::PI) * SE2::new(1.0, 0.0, 0.0)
        } else {
            step
        };
        let (from, to, next) = (truth.len() - 1, truth.len(), last * step);
        let place = |pose: &SE2| [pose.x(), pose.y()].map(|v| v.round() as i64);
        let visit = truth.iter().position(|pose| place(pose) == place(&next));
        if let Some(visit) = visit.filter(|visit| to - visit > 1) {
            loops.push((visit, to));
        }
        truth.push(next);
        let measurement = noisy(&step, &mut numbers);
        let pose = problem.poses()[from] * measurement;
        problem.add_pose(pose);
        add(&mut problem, from, to, measurement);
    }
    for &(from, to) in &loops {
        let between = noisy(&truth[from].between(&truth[to]), &mut numbers);
        add(&mut problem, from, to, between);
    }
    let last_true = problem.factors().len();
    let mut wrong = (share * loops.len() as f64).round() as usize;
    while wrong > 0 {
        let [from, to] = [0, 1].map(|_| (numbers.unit() * count as f64) as usize);
        let apart = truth[from].between(&truth[to]);
        if from.abs_diff(to) < 2 || math::norm2(apart.x(), apart.y()) < 2.0 {
            continue;
        }
        let claim = noisy(&SE2::identity(), &mut numbers);
        add(&mut problem, from.min(to), from.max(to), claim);
        wrong -= 1;
    }
    (problem, last_true)
}

fn exact() -> Settings {
    Settings {
        jacobians: crate::JacobianModel::Exact,
        ..Settings::default()
    }
}

fn selection(problem: &Problem) -> InlierSelection {
    select_inliers(problem, &trusted(problem), exact(), &GncSettings::default()).unwrap()
}

fn at(problem: &Problem, poses: &[SE2]) -> Problem {
    let mut moved = problem.clone();
    moved.poses_mut().copy_from_slice(poses);
    moved
}

#[test]
fn selection_along_the_path_is_right_where_gnc_alone_fails() {
    let mut failed = 0;
    for (share, seed) in [(0.0, 1), (0.1, 2), (0.3, 3), (0.5, 4)] {
        let clean = at(
            &streets(600, 0.0, seed).0,
            &selection(&streets(600, 0.0, seed).0).poses,
        );
        let (spoilt, last_true) = streets(600, share, seed);
        let inliers = selection(&spoilt);
        assert!(inliers.inliers[..last_true].iter().all(|b| *b), "{share}");
        assert!(inliers.inliers[last_true..].iter().all(|b| !*b), "{share}");
        let off_m = apart_m(&at(&spoilt, &inliers.poses), &clean);
        // 1e-4: both solves end if a step is below 1e-6.
        assert!(off_m < 1e-4, "{share}: {off_m}");
        let mut alone = spoilt.clone();
        Gnc::new(
            &spoilt,
            trusted(&spoilt),
            Settings::default(),
            GncSettings::default(),
        )
        .run(&mut alone)
        .unwrap();
        failed += usize::from(apart_m(&alone, &clean) > 0.1);
    }
    assert!(failed > 0, "the test is too easy");
}

#[test]
fn pairwise_consistent_loops_are_refined_by_all_others() {
    let settings = ConsistencySettings::default();
    let mut wrong_cliques = 0;
    for (share, seed) in [(0.1, 2), (0.3, 3), (0.5, 4)] {
        let (problem, last_true) = streets(600, share, seed);
        let is_right = |k: usize| k < last_true;
        let pairs = consistent_set(&problem, &settings);
        wrong_cliques += (0..pairs.len())
            .filter(|&k| pairs[k] != is_right(k))
            .count();
        let found = select_consistent(&problem, &trusted(&problem), exact(), &settings).unwrap();
        assert_eq!(found.start, InlierStart::PairwiseConsistency);
        let wrong = (0..pairs.len())
            .filter(|&k| found.inliers[k] != is_right(k))
            .count();
        assert_eq!(wrong, 0, "{share}");
    }
    assert!(wrong_cliques > 0, "the test is too easy");
}

#[test]
fn no_flip_of_a_loop_lowers_the_truncated_cost() {
    for (share, seed) in [(0.0, 1), (0.3, 3), (1.0, 5)] {
        let (problem, _) = graph(share, seed);
        let selection = selection(&problem);
        for k in (0..problem.factors().len()).filter(|&k| !is_sequential(&problem.factors()[k])) {
            let other = |factor: usize| selection.inliers[factor] != (factor == k);
            let mut flipped = with_factors(&at(&problem, &selection.poses), other);
            crate::Optimizer::new(Settings::default()).run(&mut flipped);
            let dropped = (0..problem.factors().len()).filter(|&f| !other(f)).count();
            let cost = flipped.chi2() + LOOP_CHI2 * dropped as f64;
            assert!(
                cost > selection.cost - 1e-6 * selection.cost,
                "{share}, loop {k}: {cost}"
            );
        }
    }
}

#[test]
fn a_path_followed_backwards_gives_the_same_inliers() {
    let (problem, _) = graph(0.5, 4);
    let mut turned = Problem::new();
    let last = problem.node_count() - 1;
    for pose in problem.poses().iter().rev() {
        turned.add_pose(*pose);
    }
    turned.fix(last);
    for factor in problem.factors() {
        turned.add_factor(Between {
            from: last - factor.from,
            to: last - factor.to,
            ..*factor
        });
    }
    assert_eq!(selection(&turned).inliers, selection(&problem).inliers);
}

#[test]
fn a_graph_with_an_interrupted_path_is_solved_by_gnc() {
    let (problem, last_true) = graph(0.3, 3);
    let torn = with_factors(&problem, |k| k != 60);
    let selection = selection(&torn);
    assert_eq!(selection.start, InlierStart::GraduatedNonConvexity);
    assert!(selection.inliers[last_true - 1..].iter().all(|b| !*b));
}

#[test]
fn loops_added_to_a_solved_graph_are_selected_from_its_poses() {
    for (share, seed) in [(0.0, 1), (0.3, 3), (0.5, 4)] {
        let (spoilt, last_true) = graph(share, seed);
        let mut grown = solved(&with_factors(&spoilt, |k| k < last_true));
        assert_eq!(grown.optimized_factors(), last_true);
        for factor in &spoilt.factors()[last_true..] {
            grown.add_factor(*factor);
        }
        let found = select_added(&grown, &trusted(&grown), exact(), LOOP_CHI2).unwrap();
        assert_eq!(found.start, InlierStart::PresentPoses);
        assert_eq!(found.inliers, selection(&spoilt).inliers, "{share}");
    }
}

#[test]
fn a_false_loop_of_a_solved_graph_goes_when_true_ones_are_added() {
    let (spoilt, last_true) = graph(0.03, 2);
    let (factors, steps) = (spoilt.factors(), spoilt.node_count() - 1);
    assert_eq!(factors.len(), last_true + 1, "one false loop");
    let mut grown = with_factors(&spoilt, |k| k < steps || k == last_true);
    grown = solved(&grown);
    assert!(
        apart_m(&grown, &spoilt) > 0.1,
        "the false loop bends nothing"
    );
    for factor in &factors[steps..last_true] {
        grown.add_factor(*factor);
    }
    let found = select_added(&grown, &trusted(&grown), exact(), LOOP_CHI2).unwrap();
    let dropped = (0..factors.len()).filter(|&k| !found.inliers[k]);
    assert_eq!(dropped.collect::<Vec<_>>(), [steps], "the only loop before");
}
