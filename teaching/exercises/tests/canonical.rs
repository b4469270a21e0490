//! The chapter's lap, seed 0xC0FFEE, in the types of the listings, and the comparison of two poses.

use ch16_lab::lap::{LapConfig, LapRecord, LapRunner};
use ch16_listings::{PointCloud, PoseGraph, SE2};
use ch16_slam2d::cloud;

/// The lap as the core drives it.
pub fn lap() -> LapRecord {
    LapRunner::new().run(&LapConfig::default())
}

/// The sweep of every keyframe in its own frame.
pub fn sweeps(record: &LapRecord) -> Vec<PointCloud> {
    let keyframes = record.lap.keyframes.iter();
    keyframes
        .map(|keyframe| listing(&record.drive.sweep(keyframe.tick).cloud))
        .collect()
}

/// A cloud of the core as a cloud of the listings.
pub fn listing(cloud: &cloud::PointCloud) -> PointCloud {
    PointCloud {
        points: cloud.iter().collect(),
        stamp: cloud.stamp_s(),
    }
}

/// The nodes of the graph just before the loop that was closed in `tick`; the tests of a loop need no edges.
pub fn nodes_before_loop(record: &LapRecord, tick: usize) -> PoseGraph {
    let (poses, _) = record.lap.loop_motion(tick).expect("a loop was closed");
    let mut graph = PoseGraph::new();
    graph.add_fixed_node(poses[0].into());
    for pose in &poses[1..] {
        graph.add_node((*pose).into());
    }
    graph
}

/// Fails if two poses are farther apart than `tolerance`, m and rad added.
#[track_caller]
pub fn assert_same_pose(found: SE2, expected: SE2, tolerance: f64) {
    let apart = (expected.inverse() * found).step_size();
    assert!(
        apart < tolerance,
        "{found:?} is {apart:.2e} from {expected:?}"
    );
}
