//! Layout of the panels: the points, and below them what More opens: the trace, and a map under both results.

use widget_kit::scene::Scene;
use widget_kit::view::{Arrangement, Row, SIDE_BY_SIDE, Slot};

use crate::w16_11_procrustes::model::panel;

/// The layout of the widget.
#[must_use]
pub fn arrange(_scene: &Scene, width: f32) -> Arrangement {
    let is_wide = width >= SIDE_BY_SIDE;
    let [points, trace, map] = if is_wide {
        [440.0, 180.0, 260.0]
    } else {
        [520.0, 140.0, 170.0]
    };
    let maps = [panel::MAP_TURN, panel::MAP_UNCHECKED].map(|panel| Slot::natural(panel, map));
    Arrangement {
        stage: Row::each(&[if is_wide {
            Slot::natural(panel::POINTS, points)
        } else {
            Slot::fixed(panel::POINTS, points)
        }]),
        below: vec![
            Row::new(&[Slot::fixed(panel::TRACE, trace)]),
            Row::new(&maps),
        ],
    }
}
