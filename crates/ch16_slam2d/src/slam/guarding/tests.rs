use nalgebra::Vector3;

use super::*;
use crate::graph::{EdgeView, PoseGraph, PoseNode};
use crate::loops::LoopCandidate;
use crate::slam::test_room::{frame, truth};
use crate::slam::{LoopClosure, SlamConfig};

/// Two laps without a loop, each step known to 5 cm and 2°.
fn two_laps() -> Slam {
    let mut config = SlamConfig::for_robot(&frame(0).scan);
    config.start = truth(0);
    config.loop_closure = LoopClosure::Off;
    let mut slam = Slam::new(config.with_referee());
    for step in 0..=210 {
        slam.step(&frame(step)).unwrap();
    }
    let nodes: Vec<PoseNode> = slam.graph.nodes().map(|(_, node)| node).collect();
    let mut edges: Vec<EdgeView> = slam.graph.edges().collect();
    for view in &mut edges {
        view.edge.information = Matrix3::from_diagonal(&Vector3::new(400.0, 400.0, 820.0));
    }
    slam.graph = PoseGraph::of(&nodes, &edges);
    slam
}

/// Closes a loop whose new node is found `off_m` beside where it is.
fn close(slam: &mut Slam, old: usize, off_m: f64) {
    let at = |node: usize| truth(slam.keyframes[node].frame);
    let new = old + slam.keyframes.len() / 2;
    let measured = at(old).between(&(SE2::translation(off_m, 0.0) * at(new)));
    let trust = Matrix3::identity() * 1e4;
    slam.graph
        .add_edge(old, new, measured, trust, EdgeKind::Loop);
    slam.graph.optimize(30, 1e-9);
    slam.take_back_refuted();
}

fn closed(slam: &Slam) -> Vec<usize> {
    let loops = slam
        .graph
        .edges()
        .filter(|view| view.edge.kind == EdgeKind::Loop);
    loops.map(|view| view.from.index()).collect()
}

#[test]
fn false_loops_that_agree_are_taken_back_once_right_ones_contradict_them() {
    let mut slam = two_laps();
    for old in 0..3 {
        close(&mut slam, old, 1.5);
    }
    assert_eq!(closed(&slam), [0, 1, 2]);
    for old in 8..13 {
        close(&mut slam, old, 0.0);
    }
    assert_eq!(closed(&slam), [8, 9, 10, 11, 12]);
    // Nor does a false one take right ones back.
    close(&mut slam, 5, 1.5);
    assert_eq!(closed(&slam), [8, 9, 10, 11, 12, 5]);
}
#[test]
fn beside_a_loop_that_waits_another_says_nothing_new() {
    let mut slam = two_laps();
    let guard = slam.config.loops.guard.unwrap();
    let found = |slam: &Slam, node: usize| {
        let loops = &slam.config.loops;
        let old = node - slam.keyframes.len() / 2;
        let candidate = LoopCandidate {
            node: old,
            distance_m: 0.0,
            proposal: None,
        };
        let view = KeyframeView {
            poses: slam.graph.poses(),
            keyframes: &slam.keyframes,
        };
        let mut workspace = LoopWorkspace::new(loops.matcher.build(&loops.submap));
        let (known, frame) = (Ok(Matrix3::identity()), slam.config.information_frame);
        verify_loop(view, node, candidate, known, frame, loops, &mut workspace)
    };
    let node = slam.keyframes.len() - 8;
    let held = |slam: &Slam, node: usize| slam.as_held(found(slam, node));
    let (first, beside, apart) = (
        held(&slam, node),
        held(&slam, node + 1),
        held(&slam, node + 3),
    );
    assert!(!first.is_apart(&beside, &guard) && beside.is_apart(&apart, &guard));
    assert_eq!(slam.says_nothing_new(&beside, &guard), None, "none waits");
    slam.held.push(first);
    let (agreeing, needed) = (1, 2);
    let waiting = LoopRejection::Waiting { agreeing, needed };
    assert_eq!(slam.says_nothing_new(&beside, &guard), Some(waiting));
    assert_eq!(slam.says_nothing_new(&apart, &guard), None, "it counts");
    let mut other = beside;
    other.verification.registered = SE2::translation(0.0, 3.0) * beside.verification.registered;
    let says = slam.says_nothing_new(&other, &guard);
    assert_eq!(says, None, "it contradicts the one that waits");
    slam.held.push(apart);
    let says = slam.says_nothing_new(&beside, &guard);
    assert_eq!(says, None, "with another it closes the loop");
}
