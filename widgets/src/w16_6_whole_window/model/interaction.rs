//! Draggable things: the start, by its sensor, its turning handle or its mark.

use ch16_lab::basin::BasinStart;
use pr_geom::{Point2, SE2, math};
use widget_kit::model::Handle;

use super::{WholeWindow, panel};

/// Distance of the turning handle from the sensor, m.
const TURN_ARM_M: f64 = 1.0;

/// Names of the draggable things.
mod thing {
    pub const PLACE: &str = "place";
    pub const TURN: &str = "turn";
}

/// Position of the handle that turns the start.
pub fn turn_handle(guess: &SE2) -> Point2<f64> {
    guess.transform(Point2::new(TURN_ARM_M, 0.0))
}

/// The start within reach.
pub fn grab(window: &WholeWindow, panel: &str, at: [f64; 2], reach: [f64; 2]) -> Option<Handle> {
    let maps = [panel::SWEEPS, panel::PLACES];
    let panel = maps.into_iter().find(|id| *id == panel)?;
    let guess = window.guess();
    let take = |id, spot: Point2<f64>| {
        let away = [at[0] - spot.x, at[1] - spot.y];
        let is_near = away[0].abs() <= reach[0] && away[1].abs() <= reach[1];
        is_near.then_some(Handle {
            panel,
            id,
            offset: away,
            ..Handle::default()
        })
    };
    let turn = (panel == panel::SWEEPS).then(|| take(thing::TURN, turn_handle(&guess)));
    turn.flatten()
        .or_else(|| take(thing::PLACE, guess.position()))
}

/// Moves or turns the start.
pub fn drag(window: &mut WholeWindow, handle: Handle, at: [f64; 2]) {
    let spot = [at[0] - handle.offset[0], at[1] - handle.offset[1]];
    if !spot.iter().all(|value| value.is_finite()) {
        return;
    }
    let guess = window.guess();
    let moved = if handle.id == thing::TURN {
        let theta = math::atan2(spot[1] - guess.y(), spot[0] - guess.x());
        SE2::new(guess.x(), guess.y(), theta)
    } else {
        SE2::new(spot[0], spot[1], guess.theta())
    };
    let start: BasinStart = window.scene.start_of(&moved);
    window.start_at(start);
}
