//! Draggable things: the robot's start, or its turning handle.

use widget_kit::model::Handle;

use super::{Relocalization, panel};
use crate::pose_handle;
pub use crate::pose_handle::turn_handle;

/// The robot within reach.
pub fn grab(back: &Relocalization, panel: &str, at: [f64; 2], reach: [f64; 2]) -> Option<Handle> {
    let grabbed = || pose_handle::grab(panel::MAP, &back.start(), at, reach);
    (panel == panel::MAP).then(grabbed).flatten()
}

/// Moves or turns the robot.
pub fn drag(back: &mut Relocalization, handle: Handle, at: [f64; 2]) {
    let start = back.start();
    let moved = handle
        .spot(at)
        .map(|spot| pose_handle::dragged(&start, handle, spot));
    if let Some(moved) = moved.filter(|moved| *moved != start) {
        back.put(moved);
    }
}
