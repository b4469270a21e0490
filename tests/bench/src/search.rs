//! The workload of a search: a scan of the return path in a whole window around an earlier pose.

use core::f64::consts::PI;
use std::sync::Arc;

use ch16_lab::lap::{Lap, LapConfig};
use ch16_slam2d::cloud::PointCloud;
use ch16_slam2d::metrics::position_error_m;
use ch16_slam2d::search::{
    LikelihoodConfig, ScanSearch, ScoredPose, SearchMap, SearchNeighborhood, SearchResult,
    SearchWindow,
};
use pr_geom::SE2;

use crate::{Run, prepared};

/// Keyframes on either side of the center of a submap.
const HALF_WIDTH: usize = 3;

/// A scan of the Apartment's return path on the submap of the nearest keyframe of the outward path.
struct Search {
    map: Arc<SearchMap>,
    scan: PointCloud,
    window: SearchWindow,
    found: Option<SearchResult>,
}

/// ±3 m and every heading, cells of 5 cm: the search, on a prepared submap.
pub(crate) fn search() -> Box<dyn Run> {
    prepared(
        back_on_the_way_out(),
        |search| {
            let neighborhood = SearchNeighborhood::default();
            let map = Arc::clone(&search.map);
            let begun = ScanSearch::new(map, &search.scan, &search.window, &neighborhood);
            search.found = begun.ok().and_then(ScanSearch::run);
        },
        |search, digest| {
            let Some(found) = &search.found else {
                return;
            };
            let mut add = |scored: &ScoredPose| {
                digest.add_pose(&scored.pose);
                digest.add_all(&[scored.score]);
            };
            add(&found.best);
            found.runner_up.iter().for_each(add);
            digest.add_bits(found.counts.scored());
        },
    )
}

/// The middle one of the return path's keyframes within a metre of the outward path.
fn back_on_the_way_out() -> Search {
    let mut lap = Lap::new(LapConfig::default());
    lap.run();
    let truths: Vec<SE2> = lap.keyframes().map(|keyframe| keyframe.truth).collect();
    let keyframes = lap.slam().keyframes();
    let turn = lap.turn_node().expect("the lap turns");
    let apart_m = |old: usize, node: usize| position_error_m(&truths[old], &truths[node]);
    let pairs: Vec<(usize, usize)> = (turn + 1..keyframes.len())
        .filter_map(|node| {
            let ways_out = HALF_WIDTH..turn;
            let old = ways_out.min_by(|a, b| apart_m(*a, node).total_cmp(&apart_m(*b, node)))?;
            (apart_m(old, node) <= 1.0).then_some((old, node))
        })
        .collect();
    let (old, node) = pairs[pairs.len() / 2];
    let mut submap = PointCloud::default();
    for near in old - HALF_WIDTH..=old + HALF_WIDTH {
        submap.extend_transformed(&keyframes[near].scan, &truths[old].between(&truths[near]));
    }
    let map = SearchMap::build(&submap, LikelihoodConfig::default());
    Search {
        map: Arc::new(map.expect("the submap has points")),
        scan: PointCloud::clone(&keyframes[node].scan),
        window: SearchWindow::around(SE2::identity(), 3.0, PI),
        found: None,
    }
}
