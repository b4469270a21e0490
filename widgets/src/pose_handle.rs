//! A pose that the reader moves, or turns by a handle ahead of it.

use pr_geom::{Point2, SE2, math};
use widget_kit::model::Handle;

/// Names of the draggable things: the pose, and the handle that turns it.
pub const PLACE: &str = "place";
pub const TURN: &str = "turn";

/// Distance of the turning handle from its pose, m.
const TURN_ARM_M: f64 = 1.0;

/// Position of the handle that turns a pose.
pub fn turn_handle(pose: &SE2) -> Point2<f64> {
    pose.transform(Point2::new(TURN_ARM_M, 0.0))
}

/// The turning handle or the pose within reach.
pub fn grab(panel: &'static str, pose: &SE2, at: [f64; 2], reach: [f64; 2]) -> Option<Handle> {
    let turn = turn_handle(pose);
    Handle::within(panel, TURN, [turn.x, turn.y], at, reach)
        .or_else(|| Handle::within(panel, PLACE, [pose.x(), pose.y()], at, reach))
}

/// The pose with the grabbed thing at a spot.
pub fn dragged(pose: &SE2, handle: Handle, [x, y]: [f64; 2]) -> SE2 {
    if handle.id == TURN {
        SE2::new(pose.x(), pose.y(), math::atan2(y - pose.y(), x - pose.x()))
    } else {
        SE2::new(x, y, pose.theta())
    }
}
