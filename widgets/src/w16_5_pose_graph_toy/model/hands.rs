//! Draggable things: a pose, or the tip of its heading.

use kit::model::Handle;
use pr_geom::{Point2, SE2, math};

use super::{PoseGraphToy, panel};
use crate::w16_5_pose_graph_toy::spec::GRAPH;
use crate::w16_5_pose_graph_toy::spec::{MOST_POSES, MOVED, REACH_M, STEPS};

/// Distance of the turning handle from its pose, m.
const TURN_ARM_M: f64 = 0.3;

/// Names of the draggable things: each pose, and each heading.
const POSES: [&str; MOST_POSES] = ["pose1", "pose2", "pose3", "pose4", "pose5", "pose6"];
const HEADINGS: [&str; MOST_POSES] = ["turn1", "turn2", "turn3", "turn4", "turn5", "turn6"];

/// Position of the handle that turns a pose.
pub fn turn_handle(pose: &SE2) -> Point2<f64> {
    pose.transform(Point2::new(TURN_ARM_M, 0.0))
}

/// The nearest pose within reach, or the tip of a heading.
pub fn grab(toy: &PoseGraphToy, panel: &str, at: [f64; 2], reach: [f64; 2]) -> Option<Handle> {
    if panel != panel::GRAPH {
        return None;
    }
    let poses = &toy.shown().poses;
    let places = poses
        .iter()
        .zip(POSES)
        .map(|(pose, id)| (pose.position(), id));
    let tips = poses
        .iter()
        .zip(HEADINGS)
        .map(|(pose, id)| (turn_handle(pose), id));
    let share = |spot: &Point2<f64>| {
        let away = [at[0] - spot.x, at[1] - spot.y];
        (away[0] / reach[0]).abs().max((away[1] / reach[1]).abs())
    };
    let (spot, id) = places
        .chain(tips)
        .filter(|(spot, _)| share(spot) <= 1.0)
        .min_by(|(a, _), (b, _)| share(a).total_cmp(&share(b)))?;
    Some(Handle {
        panel: panel::GRAPH,
        id,
        offset: [at[0] - spot.x, at[1] - spot.y],
    })
}

/// Moves the grabbed thing; all current poses become the start.
pub fn drag(toy: &mut PoseGraphToy, handle: Handle, at: [f64; 2]) {
    let spot = [at[0] - handle.offset[0], at[1] - handle.offset[1]];
    if !spot.iter().all(|value| value.is_finite()) {
        return;
    }
    let mut poses = toy.shown().poses.clone();
    let of = |ids: [&str; MOST_POSES]| ids.iter().position(|id| *id == handle.id);
    if let Some(k) = of(POSES) {
        poses[k] = SE2::new(spot[0], spot[1], poses[k].theta());
    } else if let Some(k) = of(HEADINGS) {
        let arm = [spot[0] - poses[k].x(), spot[1] - poses[k].y()];
        poses[k] = SE2::new(poses[k].x(), poses[k].y(), math::atan2(arm[1], arm[0]));
    }
    put(toy, &poses);
}

/// Sets the start, rounded, which keeps links short.
fn put(toy: &mut PoseGraphToy, poses: &[SE2]) {
    let rounded = |value: f64, per_unit: f64| (value * per_unit).round() / per_unit;
    let driven = toy.values.get(&GRAPH).driven();
    toy.played.pause();
    for ((pose, home), [x, y, turn]) in poses.iter().zip(&driven).zip(&MOVED) {
        let along = |value: f64| rounded(value, 100.0).clamp(-REACH_M, REACH_M);
        let turned = SE2::new(0.0, 0.0, pose.theta() - home.theta()).theta();
        toy.values.put(x, along(pose.x() - home.x()));
        toy.values.put(y, along(pose.y() - home.y()));
        toy.values.put(
            turn,
            rounded(turned.to_degrees(), 10.0).clamp(-180.0, 180.0),
        );
    }
    toy.values.put(&STEPS, 0.0);
    toy.solve();
}
