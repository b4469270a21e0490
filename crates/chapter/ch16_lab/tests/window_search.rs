//! Global search of a whole window in the Apartment: its result and the number of scored poses.

use core::f64::consts::{FRAC_PI_2, PI};
use std::sync::Arc;

use ch16_lab::lap::{BuiltInWorld, Lap, LapConfig, LapMatcher, LoopMatcher};
use ch16_lab::samples;
use ch16_slam2d::cloud::PointCloud;
use ch16_slam2d::search::{
    LikelihoodConfig, ScanSearch, SearchMap, SearchNeighborhood, SearchResult, SearchWindow,
};
use pr_geom::SE2;
use pr_sim::{Lidar, LidarConfig, Rng, World};

/// Smallest ratio of the poses in the window to the scored ones.
const SPARED: u64 = 200;

fn search(map: &Arc<SearchMap>, scan: &PointCloud, window: &SearchWindow) -> SearchResult {
    ScanSearch::new(
        Arc::clone(map),
        scan,
        window,
        &SearchNeighborhood::default(),
    )
    .expect("the scan has points")
    .run()
    .expect("a window has a pose")
}

fn map_of(cloud: &PointCloud) -> Arc<SearchMap> {
    Arc::new(SearchMap::build(cloud, LikelihoodConfig::default()).expect("the map has points"))
}

/// The scan of the lap's robot from a pose, thinned as on the lap.
fn scan_from(world_from_body: &SE2, seed: u32) -> PointCloud {
    let mut lidar = Lidar::new(LidarConfig::default());
    let ranges_m = lidar.sense(&World::apartment(), world_from_body, &mut Rng::new(seed));
    let cloud: PointCloud = lidar.project(&ranges_m).collect();
    cloud.downsample(0.12)
}

/// Distance (m) and turn (rad) from one pose to another.
fn apart(a: &SE2, b: &SE2) -> (f64, f64) {
    let error = a.between(b);
    (error.x().hypot(error.y()), error.theta().abs())
}

#[test]
fn three_metres_and_every_heading_around_a_submap_cost_a_two_hundredth_of_all_poses() {
    // The return path along the corridor, each scan on the submap of the nearest keyframe of the outward
    // path.
    let mut lap = Lap::new(LapConfig::default());
    lap.run();
    let truths: Vec<SE2> = lap.keyframes().map(|keyframe| keyframe.truth).collect();
    let keyframes = lap.slam().keyframes();
    let turn = lap.turn_node().expect("the lap turns");
    let window = SearchWindow::around(SE2::identity(), 3.0, PI);
    let (mut tried, mut found_home, mut scored, mut poses) = (0, 0, 0, 0);
    for node in turn + 1..keyframes.len() {
        let distance = |old: &usize| apart(&truths[*old], &truths[node]).0;
        let old = (3..turn).min_by(|a, b| distance(a).total_cmp(&distance(b)));
        let old = old.expect("there is a way out");
        if distance(&old) > 1.0 {
            continue;
        }
        let mut submap = PointCloud::default();
        for near in old - 3..=old + 3 {
            let old_from_near = truths[old].between(&truths[near]);
            submap.extend_transformed(&keyframes[near].scan, &old_from_near);
        }
        let found = search(&map_of(&submap), &keyframes[node].scan, &window);
        scored += found.counts.scored();
        poses += found.counts.window;
        tried += 1;
        // 0.15 m and 3°: three cells; half of the thinned points lie a cell beside their wall.
        let (off_m, off_rad) = apart(&truths[old].between(&truths[node]), &found.best.pose);
        found_home += usize::from(off_m < 0.15 && off_rad < 3_f64.to_radians());
    }
    assert!(tried >= 8, "{tried}");
    assert_eq!(found_home, tried);
    assert!(SPARED * scored <= poses, "{scored} of {poses}");
}

#[test]
fn a_lost_robot_is_found_in_the_apartment_or_reported_as_ambiguous() {
    let map = map_of(&samples::apartment_map());
    let everywhere = SearchWindow::whole(map.grid());
    let mut found_home = 0;
    let places = [
        (2.0, 1.9, 0.3),
        (2.6, 2.4, -2.8),
        (6.0, 1.7, 1.2),
        (10.0, 2.0, 2.9),
        (3.0, 7.0, -1.0),
        (9.5, 6.8, 0.1),
    ];
    for (seed, (x, y, theta)) in (1..).zip(places) {
        let truth = SE2::new(x, y, theta);
        let found = search(&map, &scan_from(&truth, seed), &everywhere);
        let (off_m, off_rad) = apart(&truth, &found.best.pose);
        let is_home = off_m < 0.2 && off_rad < 4_f64.to_radians();
        found_home += usize::from(is_home);
        let margin = found
            .margin()
            .expect("the Apartment is more than one place");
        // Rooms A, B and C have equal walls and no furniture: the search returns one of three equal poses.
        assert!(
            margin < 0.01 || (is_home && margin > 0.1),
            "{truth:?}: {found:?}"
        );
    }
    assert!((3..6).contains(&found_home), "{found_home} of 6");
}

#[test]
fn room_a_turned_by_a_half_scores_more_than_turned_by_a_quarter() {
    let home = SE2::new(2.0, 1.9, 0.0);
    let map = map_of(&scan_from(&home, 1).transformed(&home));
    let scan = scan_from(&home, 2);
    let found = search(&map, &scan, &SearchWindow::around(home, 1.0, PI));
    let (off_m, off_rad) = apart(&home, &found.best.pose);
    assert!(off_m < 0.1 && off_rad < 2_f64.to_radians(), "{found:?}");
    let runner_up = found.runner_up.expect("the window holds other headings");
    let half = home.between(&runner_up.pose).theta().abs() / PI;
    // 9°: the room is a little longer than wide.
    assert!((half - 1.0).abs() < 0.05, "{runner_up:?}");
    let quarter = home * SE2::new(0.0, 0.0, FRAC_PI_2);
    let quarter = search(&map, &scan, &SearchWindow::around(quarter, 1.0, 0.35));
    assert!(found.best.score - runner_up.score > 0.05);
    assert!(runner_up.score - quarter.best.score > 0.02);
}

#[test]
fn loops_that_are_searched_close_on_the_lap_and_on_the_ring() {
    for world in BuiltInWorld::GRADED {
        let config = LapConfig::in_world(world, 3, 1.0).with_matcher(LapMatcher::Ndt);
        let rms_m = |lap: &Lap| {
            let squares: Vec<f64> = lap.keyframe_errors_m().map(|error| error * error).collect();
            (squares.iter().sum::<f64>() / squares.len() as f64).sqrt()
        };
        let mut open = Lap::new(config.clone().without_loops());
        open.run();
        let mut searched = Lap::new(config.with_loop_matcher(LoopMatcher::Search));
        let reports = searched.run();
        let accepted = reports
            .iter()
            .filter_map(|report| report.loop_attempt.as_ref())
            .filter(|attempt| attempt.accepted());
        let margins: Vec<_> = accepted.map(|loop_| loop_.verification.margin).collect();
        assert!(!margins.is_empty(), "{world:?}");
        assert!(margins.iter().all(Option::is_some));
        assert!(rms_m(&searched) < rms_m(&open), "{world:?}");
    }
}
