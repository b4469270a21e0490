//! The chapter's system on submaps.

use crate::graph::EdgeKind;
use crate::loops::LoopCandidate;
use crate::metrics::position_error_m;
use crate::slam::test_room::{frame, truth};
use crate::slam::{Slam, SlamConfig};
use crate::submaps::{FinishedSubmap, FrontEndKind, SubmapConfig};

fn slam(scans: usize) -> Slam {
    let mut config = SlamConfig::for_robot(&frame(0).scan);
    config.start = truth(0);
    with_submaps(config, scans)
}

fn with_submaps(mut config: SlamConfig, scans: usize) -> Slam {
    let submaps = SubmapConfig {
        scans,
        ..SubmapConfig::of(&config)
    };
    config.robot = None;
    config.front_end = FrontEndKind::Submaps(submaps);
    Slam::new(config)
}

fn two_laps(scans: usize) -> Slam {
    let mut slam = slam(scans);
    for step in 0..=210 {
        slam.step(&frame(step)).unwrap();
    }
    slam
}

#[test]
fn a_submap_is_finished_by_its_last_scan_and_never_changes_again() {
    let mut slam = slam(20);
    let mut last: Option<FinishedSubmap> = None;
    for step in 0..=210 {
        slam.step(&frame(step)).unwrap();
        let finished = slam.submap_loops().unwrap().finished();
        assert!(finished.iter().all(|submap| submap.scans == 20));
        if let Some(last) = &last {
            assert!(finished.contains(last));
        }
        last = finished.first().cloned();
        let active = slam.front_end().submaps().unwrap().submaps();
        assert!((1..=2).contains(&active.len()));
        assert!(active.iter().all(|submap| submap.grid().scans() < 20));
    }
    let finished = slam.submap_loops().unwrap().finished();
    assert!(finished.len() >= 8, "{}", finished.len());
    // They overlap: the next one's anchor belongs to the one before.
    for pair in finished.windows(2) {
        assert!(pair[0].nodes.contains(&pair[1].anchor));
    }
}

#[test]
fn every_keyframe_is_tied_to_the_submaps_that_it_was_added_to() {
    let slam = two_laps(20);
    for submap in slam.submap_loops().unwrap().finished() {
        for &node in submap.nodes.iter().filter(|node| **node != submap.anchor) {
            let tied = slam.graph().edges().any(|view| {
                view.edge.kind == EdgeKind::Odometry
                    && (view.from.index(), view.to.index()) == (submap.anchor, node)
            });
            assert!(tied, "{node} to {}", submap.anchor);
        }
    }
}

#[test]
fn loops_tie_keyframes_to_finished_submaps_that_do_not_hold_them() {
    let slam = two_laps(20);
    let finished = slam.submap_loops().unwrap().finished();
    let loops: Vec<_> = slam
        .graph()
        .edges()
        .filter(|view| view.edge.kind == EdgeKind::Loop)
        .collect();
    assert!(loops.len() >= 2, "{}", loops.len());
    for view in &loops {
        let (anchor, node) = (view.from.index(), view.to.index());
        let submap = finished.iter().find(|submap| submap.anchor == anchor);
        assert!(!submap.unwrap().nodes.contains(&node));
        // Where it truly is in the submap's frame.
        let at = |node: usize| truth(slam.keyframes()[node].frame);
        let error = at(anchor)
            .between(&at(node))
            .between(&view.edge.measurement)
            .log();
        // A cell: half of it by the search's walls, as much by the anchor when it began.
        assert!(error.norm() < 0.065, "{anchor} to {node}: {error}");
    }
    let keyframes = slam.keyframes().iter().zip(slam.graph().poses());
    let worst_m = keyframes
        .map(|(keyframe, pose)| position_error_m(pose, &truth(keyframe.frame)))
        .fold(0.0, f64::max);
    // A cell and a half.
    assert!(worst_m < 0.1, "{worst_m} m");
}

#[test]
fn few_submaps_are_kept_ready_and_the_answer_does_not_depend_on_which() {
    let slam = two_laps(20);
    let node = slam.keyframes().len() - 1;
    let scan = std::sync::Arc::clone(&slam.keyframes()[node].scan);
    let poses = slam.graph().poses().to_vec();
    let loops = slam.config().loops;
    let information = crate::loops::path_information(node, &loops);
    let mut submaps = slam.submap_loops().unwrap().clone();
    let mut ask = |index: usize| {
        let anchor = submaps.finished()[index].anchor;
        let candidate = LoopCandidate {
            node: anchor,
            distance_m: 0.0,
            proposal: None,
        };
        let belief = poses[anchor].between(&poses[node]);
        let found = submaps.verify(
            index,
            (node, &scan),
            (candidate, belief),
            Ok(information),
            &loops,
        );
        assert!(submaps.ready_count() <= 4);
        found
    };
    let first = ask(0);
    (1..8).for_each(|index| {
        ask(index);
    });
    assert_eq!(ask(0), first);
}
