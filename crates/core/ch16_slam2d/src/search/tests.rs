//! Branch and bound against exhaustive search.

use core::f64::consts::{FRAC_PI_2, PI};
use std::sync::Arc;

use pr_geom::{Point2, SE2};

use super::*;
use crate::cloud::PointCloud;

/// Pseudo-random numbers: Knuth's multiplier and increment for 64 bits, the upper half.
struct Numbers(u64);

impl Numbers {
    fn unit(&mut self) -> f64 {
        let next = self.0.wrapping_mul(6_364_136_223_846_793_005);
        self.0 = next.wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 40) as f64 / (1_u64 << 24) as f64
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    fn below(&mut self, count: usize) -> usize {
        (self.unit() * count as f64) as usize
    }
}

/// A cloud of one to twelve points: random, on a lattice so that many poses have equal scores, or symmetric
/// under a quarter turn.
fn cloud(numbers: &mut Numbers) -> PointCloud {
    let count = 1 + numbers.below(12);
    let kind = numbers.below(3);
    let mut points = Vec::new();
    for _ in 0..count {
        let mut coordinate = || numbers.between(-1.0, 1.0);
        let (x, y) = (coordinate(), coordinate());
        match kind {
            0 => points.push(Point2::new(x, y)),
            1 => points.push(Point2::new(
                (5.0 * x).round() / 5.0,
                (5.0 * y).round() / 5.0,
            )),
            _ => {
                points.extend([(x, y), (-y, x), (-x, -y), (y, -x)].map(|(x, y)| Point2::new(x, y)))
            }
        }
    }
    points.into_iter().collect()
}

fn case(numbers: &mut Numbers) -> ScanSearch {
    let config = LikelihoodConfig {
        cell_m: numbers.between(0.05, 0.2),
        sigma_m: numbers.between(0.02, 0.3),
    };
    let map = cloud(numbers);
    let scan = match numbers.below(2) {
        0 => cloud(numbers),
        _ => map.transformed(&SE2::new(
            numbers.between(-0.3, 0.3),
            0.1,
            numbers.between(-PI, PI),
        )),
    };
    let window = SearchWindow {
        center: SE2::new(
            numbers.between(-0.5, 0.5),
            numbers.between(-0.5, 0.5),
            numbers.between(-PI, PI),
        ),
        half_x_m: numbers.between(0.0, 1.0),
        half_y_m: numbers.between(0.0, 1.0),
        half_turn_rad: [0.0, 0.4, 2.0, PI][numbers.below(4)],
    };
    let neighborhood = SearchNeighborhood {
        reach_m: numbers.between(0.0, 0.8),
        turn_rad: numbers.between(0.0, 1.0),
    };
    let map = Arc::new(SearchMap::build(&map, config).unwrap());
    ScanSearch::new(map, &scan, &window, &neighborhood).unwrap()
}

/// Whether another pose of the window has exactly the best score.
fn is_tied(search: &ScanSearch, best: &ScoredPose) -> bool {
    let mut scores = Vec::new();
    let mut equals = 0;
    for heading in 0..search.headings() {
        search.scores_at(heading, &mut scores);
        equals += scores.iter().filter(|score| **score == best.score).count();
    }
    equals > 1
}

#[test]
fn the_rows_of_a_heading_are_its_slice_and_lie_within_the_extent() {
    let search = case(&mut Numbers(5));
    let [rows, columns] = search.places();
    let mut scores = Vec::new();
    search.scores_at(0, &mut scores);
    let by_row: Vec<f64> = (0..rows)
        .flat_map(|row| search.row_scores(0, row))
        .collect();
    assert_eq!((by_row.len(), by_row), (rows * columns, scores));
    let [low, high] = search.extent_m();
    let best = search.exhaustive().best.pose;
    assert!((low[0]..high[0]).contains(&best.x()) && (low[1]..high[1]).contains(&best.y()));
}

#[test]
fn the_best_pose_and_the_runner_up_are_those_of_the_exhaustive_search_in_1000_cases() {
    let mut numbers = Numbers(16);
    let (mut ties, mut lonely) = (0, 0);
    for number in 0..1000 {
        let search = case(&mut numbers);
        let every_pose = search.exhaustive();
        if number % 10 == 0 && is_tied(&search, &every_pose.best) {
            ties += 1;
        }
        let found = search.run().unwrap();
        assert_eq!(found.best, every_pose.best, "case {number}");
        assert_eq!(found.runner_up, every_pose.runner_up, "case {number}");
        lonely += usize::from(found.runner_up.is_none());
    }
    assert!(ties >= 10, "{ties} of 100 cases had equals to choose from");
    assert!(
        (1..200).contains(&lonely),
        "{lonely} windows were one place"
    );
}

#[test]
fn of_equal_poses_the_first_heading_then_the_lowest_y_then_the_lowest_x_wins() {
    // A single point at the sensor fits every heading equally, and every cell of its own size.
    let point: PointCloud = [Point2::new(0.025, 0.025)].into_iter().collect();
    let config = LikelihoodConfig {
        cell_m: 0.05,
        sigma_m: 0.08,
    };
    let map = Arc::new(SearchMap::build(&point, config).unwrap());
    let scan = [Point2::origin()].into_iter().collect();
    let center = SE2::new(0.025, 0.025, 0.0);
    let window = SearchWindow::around(center, 0.3, PI);
    let search = ScanSearch::new(map, &scan, &window, &SearchNeighborhood::default()).unwrap();
    let first_heading = search.heading_rad(0);
    let found = search.run().unwrap();
    assert_eq!(found.best.score, 1.0);
    assert_eq!(found.best.pose, SE2::new(0.025, 0.025, first_heading));

    // Two points a cell apart match a scan of one point at two poses.
    let pair: PointCloud = [0.025, 0.225]
        .map(|x| Point2::new(x, 0.025))
        .into_iter()
        .collect();
    let map = Arc::new(SearchMap::build(&pair, config).unwrap());
    let none = SearchNeighborhood {
        reach_m: 0.0,
        turn_rad: 0.0,
    };
    let window = SearchWindow::around(center, 0.3, 0.0);
    let found = ScanSearch::new(map, &scan, &window, &none)
        .unwrap()
        .run()
        .unwrap();
    let runner_up = found.runner_up.unwrap();
    assert_eq!((found.best.score, runner_up.score), (1.0, 1.0));
    assert!(found.best.pose.x() < runner_up.pose.x());
}

#[test]
fn steps_report_every_box_and_end_at_the_same_result() {
    let mut numbers = Numbers(7);
    for _ in 0..20 {
        let search = case(&mut numbers);
        let whole = search.clone().run();
        let mut stepped = search;
        let mut parts = stepped.open_boxes().len();
        let mut last_goal = SearchGoal::Best;
        let mut best_bound = 0.0;
        while let Some(report) = stepped.step() {
            assert!(report.goal == last_goal || last_goal == SearchGoal::Best);
            last_goal = report.goal;
            match report.fate {
                BoxFate::Split { parts: more } => {
                    assert!(!report.taken.is_pose && more > 0);
                    parts += more;
                }
                BoxFate::Best if report.goal == SearchGoal::Best => {
                    assert!(report.taken.is_pose && report.taken.bound >= best_bound);
                    best_bound = report.taken.bound;
                }
                BoxFate::Best | BoxFate::Pruned | BoxFate::SamePlace => {}
            }
        }
        assert_eq!(stepped.result(), whole);
        assert_eq!(stepped.counts().scored(), parts as u64);
        assert_eq!(stepped.open_boxes().len(), 0);
    }
}

#[test]
fn a_square_room_is_ambiguous_and_has_a_small_margin() {
    let wall = || (0..40).map(|k| 0.1 * f64::from(k) - 1.95);
    let walls = |x: f64| [(x, 1.95), (-1.95, x), (-x, -1.95), (1.95, -x)];
    let room: PointCloud = wall()
        .flat_map(walls)
        .map(|(x, y)| Point2::new(x, y))
        .collect();
    let map = Arc::new(SearchMap::build(&room, LikelihoodConfig::default()).unwrap());
    let window = SearchWindow::around(SE2::identity(), 0.5, PI);
    let search = |scan: &PointCloud| {
        ScanSearch::new(
            Arc::clone(&map),
            scan,
            &window,
            &SearchNeighborhood::default(),
        )
        .unwrap()
        .run()
        .unwrap()
    };
    let alike = search(&room);
    let turns = alike
        .best
        .pose
        .between(&alike.runner_up.unwrap().pose)
        .theta()
        / FRAC_PI_2;
    // 0.03 of a quarter turn is less than three steps of the heading.
    assert!(
        (turns - turns.round()).abs() < 0.03 && turns.round() != 0.0,
        "{turns}"
    );
    assert!(alike.margin().unwrap() < 0.02);

    let mut furnished = room.clone();
    (0..20).for_each(|k| furnished.push(Point2::new(0.4 + 0.05 * f64::from(k), 1.2)));
    let map = Arc::new(SearchMap::build(&furnished, LikelihoodConfig::default()).unwrap());
    let found = ScanSearch::new(map, &furnished, &window, &SearchNeighborhood::default())
        .unwrap()
        .run()
        .unwrap();
    // The 20 points of the wardrobe are a ninth of the scan, and fit only at the true pose.
    assert!(found.margin().unwrap() > 0.08, "{:?}", found.margin());
}

#[test]
fn a_search_for_an_unmatched_scan_ends_early() {
    let mut numbers = Numbers(3);
    let strewn = |numbers: &mut Numbers| -> PointCloud {
        let mut coordinate = || numbers.between(-1.5, 1.5);
        (0..60)
            .map(|_| Point2::new(coordinate(), coordinate()))
            .collect()
    };
    let (map, scan) = (strewn(&mut numbers), strewn(&mut numbers));
    let map = Arc::new(SearchMap::build(&map, LikelihoodConfig::default()).unwrap());
    let window = SearchWindow::around(SE2::identity(), 1.0, 1.0);
    let search = ScanSearch::new(map, &scan, &window, &SearchNeighborhood::default()).unwrap();
    let best = search.exhaustive().best.score;
    // With a minimum at the best score the result is the same; above it there is none.
    let at_best = search.clone().with_min_score(best).run();
    assert_eq!(at_best.unwrap().best.score, best);
    let mut above = search.clone().with_min_score(best + 0.2);
    while above.step().is_some() {}
    assert_eq!(above.result(), None);
    let whole = search.run().unwrap();
    assert!(3 * above.counts().scored() < whole.counts.scored());
}

#[test]
fn a_runner_up_beyond_the_margin_is_left_out_and_others_are_unchanged() {
    let mut numbers = Numbers(40);
    let (mut kept, mut left_out) = (0, 0);
    for number in 0..300 {
        let search = case(&mut numbers);
        let all = search.clone().run().unwrap();
        let near = search.with_margin(0.1).run().unwrap();
        assert_eq!(near.best, all.best, "case {number}");
        assert!(near.counts.scored() <= all.counts.scored(), "case {number}");
        // 0.005: scores are integers, 255 for each of a few points.
        match all.margin() {
            Some(margin) if margin < 0.095 => {
                kept += 1;
                assert_eq!(near.runner_up, all.runner_up, "case {number}");
            }
            Some(margin) if margin > 0.105 => {
                left_out += 1;
                assert_eq!(near.runner_up, None, "case {number}");
            }
            _ => {}
        }
    }
    assert!(kept > 30 && left_out > 30, "{kept} {left_out}");
}
