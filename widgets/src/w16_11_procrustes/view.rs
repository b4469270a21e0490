//! Layout of the panels: the two maps beside each other, the points beside the trace below them.

use widget_kit::scene::Scene;
use widget_kit::view::{Arrangement, Row, SIDE_BY_SIDE, Slot};

use crate::w16_11_procrustes::model::panel;

/// The layout of the widget.
#[must_use]
pub fn arrange(_scene: &Scene, width: f32) -> Arrangement {
    let wide = width >= SIDE_BY_SIDE;
    // Beside each other, maps and points are seen together on a low screen.
    let [plot_px, map_px] = if wide { [180.0, 190.0] } else { [140.0, 170.0] };
    let maps = [panel::MAP_TURN, panel::MAP_UNCHECKED].map(|panel| Slot::natural(panel, map_px));
    let plots = [
        Slot::natural(panel::POINTS, 200.0),
        Slot::fixed(panel::TRACE, plot_px),
    ];
    let mut stage = vec![Row::new(&maps)];
    if wide {
        stage.push(Row::new(&plots));
    } else {
        stage.extend(Row::each(&plots));
    }
    Arrangement {
        stage,
        below: Vec::new(),
    }
}
