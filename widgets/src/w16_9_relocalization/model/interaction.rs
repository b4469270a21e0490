//! Draggable things: the robot's start, or its turning handle.

use pr_geom::{Point2, SE2, math};
use widget_kit::model::Handle;

use super::{Relocalization, panel};

/// Distance of the turning handle from the robot, m.
const TURN_ARM_M: f64 = 1.0;

/// Names of the draggable things.
mod thing {
    pub const PLACE: &str = "place";
    pub const TURN: &str = "turn";
}

/// Position of the handle that turns the robot.
pub fn turn_handle(start: &SE2) -> Point2<f64> {
    start.transform(Point2::new(TURN_ARM_M, 0.0))
}

/// The robot within reach.
pub fn grab(back: &Relocalization, panel: &str, at: [f64; 2], reach: [f64; 2]) -> Option<Handle> {
    if panel != panel::MAP {
        return None;
    }
    let start = back.start();
    let take = |id, spot: Point2<f64>| {
        let away = [at[0] - spot.x, at[1] - spot.y];
        let is_near = away[0].abs() <= reach[0] && away[1].abs() <= reach[1];
        is_near.then_some(Handle {
            panel: panel::MAP,
            id,
            offset: away,
            ..Handle::default()
        })
    };
    take(thing::TURN, turn_handle(&start)).or_else(|| take(thing::PLACE, start.position()))
}

/// Moves or turns the robot.
pub fn drag(back: &mut Relocalization, handle: Handle, at: [f64; 2]) {
    let spot = [at[0] - handle.offset[0], at[1] - handle.offset[1]];
    if !spot.iter().all(|value| value.is_finite()) {
        return;
    }
    let start = back.start();
    let moved = if handle.id == thing::TURN {
        let theta = math::atan2(spot[1] - start.y(), spot[0] - start.x());
        SE2::new(start.x(), start.y(), theta)
    } else {
        SE2::new(spot[0], spot[1], start.theta())
    };
    if moved != start {
        back.put(moved);
    }
}
