//! Draggable things: a pose, and the tip of its heading.

use pr_geom::{Point2, SE2, math};
use widget_kit::model::{Handle, Model as _};

use super::{PoseGraphToy, panel};
use crate::pose_handle::{PLACE, TURN, dragged};
use crate::w16_5_pose_graph_toy::spec::{GAP, GRAPH, MOVED, REACH_M, STEPS};

/// Distance of the turning handle from its pose, m.
const TURN_ARM_M: f64 = 0.3;

/// Bow of the loop's spring at a stiffness of 1, and what a tenfold stiffness takes from it, m.
const BOW_M: f64 = 0.5;
const BOW_PER_DECADE_M: f64 = 0.25;

/// Position of the handle that turns a pose.
pub fn turn_handle(pose: &SE2) -> Point2<f64> {
    pose.transform(Point2::new(TURN_ARM_M, 0.0))
}

/// Distance of the middle of the loop's spring from the line between its poses, m: a stiff spring is tight.
pub fn bow_m(stiffness: f64) -> f64 {
    BOW_M - BOW_PER_DECADE_M * math::ln(stiffness) / core::f64::consts::LN_10
}

/// The nearest pose within reach, or the tip of a heading.
pub fn grab(toy: &PoseGraphToy, panel: &str, at: [f64; 2], reach: [f64; 2]) -> Option<Handle> {
    if panel != panel::GRAPH {
        return None;
    }
    let poses = toy.poses();
    let poses = poses.iter().enumerate();
    let things =
        poses.flat_map(|(k, pose)| [(PLACE, k, pose.position()), (TURN, k, turn_handle(pose))]);
    let things = things.map(|(id, k, spot)| (id, k, [spot.x, spot.y]));
    Handle::nearest(panel::GRAPH, things, at, reach)
}

/// Moves the grabbed thing; all current poses become the start.
pub fn drag(toy: &mut PoseGraphToy, handle: Handle, at: [f64; 2]) {
    let Some(spot) = handle.spot(at) else {
        return;
    };
    let mut poses = toy.poses();
    if let Some(pose) = poses.get_mut(handle.index) {
        *pose = dragged(pose, handle, spot);
    }
    put(toy, &poses);
}

/// Sets the start, rounded, which keeps links short.
fn put(toy: &mut PoseGraphToy, poses: &[SE2]) {
    let rounded = |value: f64, per_unit: f64| (value * per_unit).round() / per_unit;
    let driven = toy.values.get(&GRAPH).driven(toy.values.get(&GAP));
    toy.playback.pause();
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
    toy.follow(None);
}
