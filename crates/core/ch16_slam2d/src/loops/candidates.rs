//! Loop candidates: which old keyframes might show the same location.

use pr_geom::{SE2, math, order_by};
use serde::{Deserialize, Serialize};

use super::LoopConfig;

/// An old node that may show the same location as the new one.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct LoopCandidate {
    /// The old node.
    pub node: usize,
    /// Its distance from the new node in the graph, m.
    pub distance_m: f64,
    /// Pose of the new node in the old one's frame, by the detector; registration starts there. `None` starts at
    /// the graph's relative pose.
    pub proposal: Option<SE2>,
}

/// The nodes near `poses[node]` that are old enough, nearest first; of equals the older first.
///
/// `poses` are the graph's, `world_from_body`. The only criterion is the distance in the graph, so a
/// drift that exceeds the radius hides the loop that would correct it.
#[must_use]
pub fn detect_loop_candidates(
    poses: &[SE2],
    node: usize,
    config: &LoopConfig,
) -> Vec<LoopCandidate> {
    let candidates = nearby(poses, node, config.radius_m, config.min_gap_nodes);
    sorted_by(&candidates, &|candidate| candidate.distance_m)
}

/// [`detect_loop_candidates`] by index.
fn nearby(poses: &[SE2], node: usize, radius_m: f64, min_gap_nodes: usize) -> Vec<LoopCandidate> {
    let here = poses[node];
    let old_enough = (node + 1).saturating_sub(min_gap_nodes);
    poses[..old_enough.min(node)]
        .iter()
        .enumerate()
        .map(|(node, pose)| LoopCandidate {
            node,
            distance_m: math::norm2(pose.x() - here.x(), pose.y() - here.y()),
            proposal: None,
        })
        .filter(|candidate| candidate.distance_m <= radius_m)
        .collect()
}

/// The candidates by cost; of equal costs the older first.
fn sorted_by(
    candidates: &[LoopCandidate],
    cost: &dyn Fn(&LoopCandidate) -> f64,
) -> Vec<LoopCandidate> {
    let order = order_by(candidates.len(), &|at| cost(&candidates[at]));
    order.into_iter().map(|at| candidates[at]).collect()
}

/// A gap of this many nodes between two near ones ends a visit.
const VISIT_GAP_NODES: usize = 5;
/// Distance equivalent of a heading difference, m per radian.
const METRES_PER_RADIAN: f64 = 0.5;

/// The best node of every visit to the surroundings of `poses[node]`, nearest first.
///
/// A visit is a run of nodes within `radius_m` that are at least `min_gap_nodes` older. The best of it is the nearest; a radian of heading difference
/// counts as half a metre, because scans with similar headings overlap more.
#[must_use]
pub fn detect_visits(
    poses: &[SE2],
    node: usize,
    radius_m: f64,
    min_gap_nodes: usize,
) -> Vec<LoopCandidate> {
    let here = poses[node];
    let cost = |candidate: &LoopCandidate| {
        let turn_rad = here.between(&poses[candidate.node]).theta().abs();
        candidate.distance_m + METRES_PER_RADIAN * turn_rad
    };
    let mut visits: Vec<LoopCandidate> = Vec::new();
    let mut last_node = None;
    for candidate in nearby(poses, node, radius_m, min_gap_nodes) {
        let is_same = last_node.is_some_and(|last| candidate.node - last <= VISIT_GAP_NODES);
        last_node = Some(candidate.node);
        match visits.last_mut() {
            Some(best) if is_same => {
                if cost(&candidate) < cost(best) {
                    *best = candidate;
                }
            }
            _ => visits.push(candidate),
        }
    }
    sorted_by(&visits, &cost)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A path along x with nodes 0.5 m apart, and back again.
    fn there_and_back() -> Vec<SE2> {
        let pose = |x: f64| SE2::from_xy(x, 0.0);
        let out = (0..20).map(|k| pose(0.5 * f64::from(k)));
        let back = (0..20).rev().map(|k| pose(0.5 * f64::from(k) + 0.1));
        out.chain(back).collect()
    }

    #[test]
    fn candidates_are_near_and_old_and_the_nearest_comes_first() {
        let poses = there_and_back();
        let config = LoopConfig::default();
        // Node 32 is at x = 3.6 m; node 7 at 3.5 m is nearest, nodes up to 10 are old enough.
        let candidates = detect_loop_candidates(&poses, 32, &config);
        assert_eq!(candidates[0].node, 7);
        assert!((candidates[0].distance_m - 0.1).abs() < 1e-12);
        for pair in candidates.windows(2) {
            assert!(pair[0].distance_m <= pair[1].distance_m);
        }
        for candidate in &candidates {
            assert!(32 - candidate.node >= config.min_gap_nodes);
            assert!(candidate.distance_m <= config.radius_m);
        }
        assert_eq!(
            candidates.len(),
            7,
            "x from 1.6 m to 5.6 m, but node 10 is the last old one"
        );
    }

    #[test]
    fn young_graphs_and_a_radius_of_zero_have_no_candidates() {
        let poses = there_and_back();
        let config = LoopConfig::default();
        assert_eq!(detect_loop_candidates(&poses, 0, &config), []);
        assert_eq!(detect_loop_candidates(&poses, 21, &config), []);
        let off = LoopConfig {
            radius_m: 0.0,
            ..config
        };
        assert_eq!(detect_loop_candidates(&poses, 32, &off), []);
    }

    #[test]
    fn every_visit_has_one_candidate_and_similar_headings_come_first() {
        // Out, back with the opposite heading, and out again.
        let turned = |pose: &SE2| *pose * SE2::new(0.0, 0.0, core::f64::consts::PI);
        let mut poses = there_and_back();
        for pose in &mut poses[20..] {
            *pose = turned(pose);
        }
        poses.extend((0..20).map(|k| SE2::from_xy(0.5 * f64::from(k), 0.2)));
        // Node 50 is at x = 5 m: node 10 was there on the way out, node 29 on the way back.
        let visits = detect_visits(&poses, 50, 2.0, 5);
        let nodes: Vec<usize> = visits.iter().map(|visit| visit.node).collect();
        assert_eq!(nodes, [10, 29]);
    }
}
