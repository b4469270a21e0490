//! Map pruning for lifelong mapping: map size is bounded by the mapped area, and removed objects disappear.
//!
//! At every keyframe, once it is linked to the map, two things are pruned. Points of older scans that newer ones
//! observed as free space are dropped. Keyframes whose view is covered by enough newer ones
//! nearby are marginalized ([`PoseGraph::marginalize`](crate::graph::PoseGraph::marginalize)).
//! The oldest keyframes of a location stay as anchors: new ones are linked to them, so the map does not drift from
//! lap to lap.

use core::f64::consts::{PI, TAU};
use pr_geom::{Point2, SE2, math, sort_pairs};

use super::loop_closer::LoopCloser;
use super::mapper::Mapper;
use crate::cloud::PointCloud;
use crate::metrics::position_error_m;

/// Criteria for a replaced keyframe and for a point that is gone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MapPruningConfig {
    /// Keyframes within this distance are at the same location, m.
    pub place_m: f64,
    /// Number of newest keyframes of a location that stay.
    pub kept: usize,
    /// Number of oldest keyframes of a location that stay.
    pub anchors: usize,
    /// Others are removed if this share of their scan is in the newer ones, 0 to 1.
    pub covered: f64,
    /// Keyframes within this distance of a new one are checked, m.
    pub reach_m: f64,
    /// Points of two scans closer than this are the same, m.
    pub same_m: f64,
    /// A scan has observed a point as free if its range there is larger by this, m.
    pub through_m: f64,
    /// Number of newer scans that must have observed a point as free, while none has seen it.
    pub looks_through: usize,
    /// Largest angle between adjacent beams, rad; in wider gaps the visibility is unknown.
    pub beam_gap_rad: f64,
    /// No keyframe is removed if the last loop is more keyframes ago than this.
    pub loop_ago_nodes: usize,
}

impl Default for MapPruningConfig {
    fn default() -> Self {
        Self {
            place_m: 1.0,
            kept: 4,
            anchors: 4,
            covered: 0.9,
            reach_m: 4.0,
            same_m: 0.2,
            through_m: 0.4,
            looks_through: 2,
            beam_gap_rad: 0.06,
            loop_ago_nodes: 12,
        }
    }
}

/// Result of pruning at one keyframe.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct MapPruning {
    /// The removed keyframes, by their previous indices, the oldest first.
    pub removed: Vec<usize>,
    /// Information lost by the graph, nats: the sum of the Kullback–Leibler divergences.
    pub divergence: f64,
    /// Number of dropped points.
    pub points_gone: usize,
}

/// A scan sorted by bearing, for visibility queries.
struct ScanView {
    world_from_body: SE2,
    /// Bearing (rad) and range (m), by bearing.
    seen: Vec<(f64, f64)>,
    points: PointCloud,
}

/// Visibility of a point in a scan.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Visibility {
    Seen,
    LookedThrough,
    Unknown,
}

impl ScanView {
    fn new(scan: &PointCloud, world_from_body: SE2) -> Self {
        let mut seen: Vec<(f64, f64)> = scan
            .iter()
            .map(|point| (math::atan2(point.y, point.x), math::norm2(point.x, point.y)))
            .collect();
        sort_pairs(&mut seen);
        Self {
            world_from_body,
            seen,
            points: scan.clone(),
        }
    }

    fn visibility(&self, world: Point2<f64>, config: &MapPruningConfig) -> Visibility {
        let point = self.world_from_body.inverse().transform(world);
        let near =
            |seen: Point2<f64>| (seen - point).norm_squared() < config.same_m * config.same_m;
        if self.points.iter().any(near) {
            return Visibility::Seen;
        }
        if self.seen.len() < 2 {
            return Visibility::Unknown;
        }
        let bearing = math::atan2(point.y, point.x);
        let range_m = math::norm2(point.x, point.y);
        let after = self.seen.partition_point(|seen| seen.0 < bearing) % self.seen.len();
        let before = (after + self.seen.len() - 1) % self.seen.len();
        let both = [self.seen[before], self.seen[after]];
        let is_through = both.iter().all(|(at, seen_m)| {
            let turn = (at - bearing).abs();
            let turn = if turn > PI { TAU - turn } else { turn };
            turn <= config.beam_gap_rad && *seen_m > range_m + config.through_m
        });
        if is_through {
            Visibility::LookedThrough
        } else {
            Visibility::Unknown
        }
    }
}

/// Drops points that are gone and marginalizes replaced keyframes around the newest keyframe.
///
/// `normal_radius_m` is that of the scans: the normals of a scan that loses points are estimated again.
pub(super) fn prune_map(
    mapper: &mut Mapper,
    loop_closer: &mut LoopCloser,
    config: &MapPruningConfig,
    normal_radius_m: f64,
) -> MapPruning {
    let mut pruned = MapPruning::default();
    let Some(newest) = mapper.newest() else {
        return pruned;
    };
    if newest - mapper.last_loop_node() > config.loop_ago_nodes {
        return pruned;
    }
    let poses = mapper.poses();
    let here = poses[newest];
    let near: Vec<usize> = (0..=newest)
        .filter(|&node| position_error_m(&poses[node], &here) <= config.reach_m)
        .collect();
    let views: Vec<ScanView> = near
        .iter()
        .map(|&node| ScanView::new(mapper.scan(node), poses[node]))
        .collect();
    for (k, &node) in near.iter().enumerate() {
        let newer = &views[k + 1..];
        pruned.points_gone += drop_removed_points(mapper, node, newer, config, normal_radius_m);
    }
    let replaced: Vec<usize> = near
        .iter()
        .enumerate()
        .filter(|&(k, &node)| {
            let (older, newer) = (&views[..k], &views[k + 1..]);
            is_replaced(mapper, node, older, newer, config)
        })
        .map(|(_, &node)| node)
        .collect();
    for node in replaced.into_iter().rev() {
        if let Ok(done) = mapper.marginalize(node) {
            pruned.divergence += done.divergence;
            pruned.removed.push(node);
            loop_closer.remove_keyframe(node, &mapper.path_lengths_m());
        }
    }
    pruned.removed.reverse();
    pruned
}

/// Drops the points of a keyframe that newer scans observed as free; returns their number.
fn drop_removed_points(
    mapper: &mut Mapper,
    node: usize,
    newer: &[ScanView],
    config: &MapPruningConfig,
    normal_radius_m: f64,
) -> usize {
    if newer.len() < config.looks_through {
        return 0;
    }
    let (scan, pose) = (mapper.scan(node), mapper.poses()[node]);
    let is_gone = |point: Point2<f64>| {
        let world = pose.transform(point);
        let mut through = 0;
        for view in newer {
            match view.visibility(world, config) {
                Visibility::Seen => return false,
                Visibility::LookedThrough => through += 1,
                Visibility::Unknown => {}
            }
        }
        through >= config.looks_through
    };
    let left: Vec<Point2<f64>> = scan.iter().filter(|&point| !is_gone(point)).collect();
    let gone = scan.len() - left.len();
    if gone > 0 {
        let mut scan = PointCloud::new(left, scan.stamp_s());
        scan.estimate_normals(normal_radius_m);
        mapper.set_scan(node, scan);
    }
    gone
}

/// Whether there are enough older and newer keyframes at the location of this one, and the newer ones cover
/// its view.
fn is_replaced(
    mapper: &Mapper,
    node: usize,
    older: &[ScanView],
    newer: &[ScanView],
    config: &MapPruningConfig,
) -> bool {
    let pose = mapper.poses()[node];
    let is_here =
        |view: &&ScanView| position_error_m(&view.world_from_body, &pose) <= config.place_m;
    let here: Vec<&ScanView> = newer.iter().filter(is_here).collect();
    if here.len() < config.kept || older.iter().filter(is_here).count() < config.anchors {
        return false;
    }
    let scan = mapper.scan(node);
    let is_seen = |point: &Point2<f64>| {
        let world = pose.transform(*point);
        here.iter()
            .any(|view| view.visibility(world, config) == Visibility::Seen)
    };
    let seen = scan.iter().filter(is_seen).count();
    seen as f64 >= config.covered * scan.len() as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::slam::test_room::{doubting, frame, truth};
    use crate::slam::{Slam, SlamConfig};

    /// Laps of a circle in a room; in the first two there is an obstacle in it.
    fn laps(laps: usize, is_pruned: bool) -> (Slam, Vec<usize>) {
        let mut config = SlamConfig::for_robot(&frame(0).scan);
        config.start = truth(0);
        let mut slam = Slam::new(config);
        let mut nodes = Vec::new();
        for step in 0..105 * laps {
            let mut frame = frame(step);
            if step < 210 {
                add_obstacle(&mut frame.scan, &truth(step));
            }
            let report = slam.step(&frame).unwrap();
            if is_pruned && report.new_keyframe.is_some() {
                slam.prune_map(&MapPruningConfig::default());
            }
            if step % 105 == 104 {
                nodes.push(slam.keyframes().len());
            }
        }
        (slam, nodes)
    }

    /// A round post of 0.3 m in the middle of the circle.
    fn add_obstacle(scan: &mut crate::scan::LaserScan, pose: &SE2) {
        let post = pose.inverse().transform(POST);
        let (at, away_m) = (math::atan2(post.y, post.x), math::norm2(post.x, post.y));
        let bearings: Vec<f64> = (0..scan.ranges_m.len())
            .map(|beam| scan.bearing_rad(beam))
            .collect();
        for (range_m, bearing) in scan.ranges_m.iter_mut().zip(bearings) {
            let turn = pr_geom::wrap_angle(bearing - at);
            let side_m = away_m * math::sin(turn);
            if turn.abs() < 1.0 && side_m.abs() < 0.3 {
                let front_m = away_m * math::cos(turn) - math::sqrt(0.09 - side_m * side_m);
                *range_m = math::min(*range_m, front_m);
            }
        }
    }

    const POST: Point2<f64> = Point2::new(4.0, 3.0);

    fn points_of_the_post(slam: &Slam) -> usize {
        let keyframes = slam.keyframes().iter().zip(slam.graph().poses());
        keyframes
            .map(|(keyframe, pose)| {
                let world = keyframe.scan.iter().map(|point| pose.transform(point));
                world.filter(|point| (point - POST).norm() < 0.5).count()
            })
            .sum()
    }

    #[test]
    fn repeated_laps_keep_map_size_and_accuracy() {
        let (slam, nodes) = laps(8, true);
        assert!(nodes[7] as f64 <= 1.5 * nodes[2] as f64, "{nodes:?}");
        let (_, growing) = laps(3, false);
        assert!(growing[2] > 2 * growing[0], "{growing:?}");
        let keyframes = slam.keyframes().iter().zip(slam.graph().poses());
        for (keyframe, pose) in keyframes {
            let error_m = position_error_m(pose, &truth(keyframe.frame));
            // 0.1: eight laps with odometry that overestimates each turn.
            assert!(error_m < 0.1, "{}: {error_m}", keyframe.frame);
        }
        assert!(slam.graph().edge_count() < 4 * slam.graph().node_count());
    }

    #[test]
    fn pending_loops_follow_their_keyframes() {
        let mut slam = Slam::new(doubting());
        (0..140).for_each(|step| drop(slam.step(&frame(step)).unwrap()));
        let ends = |slam: &Slam| -> Vec<(usize, usize)> {
            let frame = |node: usize| slam.keyframes()[node].frame;
            let pending = slam.loop_closer().pending().iter();
            let found = pending.map(|waiting| &waiting.verification);
            found
                .map(|found| (frame(found.from_node), frame(found.candidate.node)))
                .collect()
        };
        let mut expected = ends(&slam);
        assert!(!expected.is_empty());
        // The first node is fixed: it cannot be marginalized.
        let pending = slam.loop_closer().pending().iter();
        let olds = pending.map(|waiting| waiting.verification.candidate.node);
        let old = olds.max().unwrap();
        assert!(old > 0);
        // A keyframe with successors, and then the end of a loop.
        for node in [old + 2, old] {
            let gone = slam.keyframes()[node].frame;
            slam.mapper.marginalize(node).unwrap();
            let lengths_m = slam.mapper.path_lengths_m();
            slam.loop_closer.remove_keyframe(node, &lengths_m);
            expected.retain(|&(new, old)| new != gone && old != gone);
            assert_eq!(ends(&slam), expected);
        }
    }

    #[test]
    fn removed_objects_disappear_from_the_map() {
        let (before, _) = laps(2, true);
        assert!(points_of_the_post(&before) > 100);
        let (after, _) = laps(4, true);
        assert_eq!(points_of_the_post(&after), 0);
        let (never, _) = laps(4, false);
        assert!(points_of_the_post(&never) > 100);
    }
}
