//! Draggable things: the start, by its sensor, its turning handle or its mark.

use widget_kit::model::Handle;

use super::{WholeWindow, panel};
pub use crate::pose_handle::turn_handle;
use crate::pose_handle::{self, PLACE};

/// The start within reach.
pub fn grab(window: &WholeWindow, panel: &str, at: [f64; 2], reach: [f64; 2]) -> Option<Handle> {
    let guess = window.guess();
    match panel {
        panel::SWEEPS => pose_handle::grab(panel::SWEEPS, &guess, at, reach),
        panel::PLACES => {
            let spot = [guess.x(), guess.y()];
            Handle::within(panel::PLACES, PLACE, spot, at, reach)
        }
        _ => None,
    }
}

/// Moves or turns the start.
pub fn drag(window: &mut WholeWindow, handle: Handle, at: [f64; 2]) {
    if let Some(spot) = handle.spot(at) {
        let moved = pose_handle::dragged(&window.guess(), handle, spot);
        window.start_at(window.scene.start_of(&moved));
    }
}
