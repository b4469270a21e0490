//! Layout of the panels: the sweeps beside the positions, the rest below.

use widget_kit::scene::Scene;
use widget_kit::view::{Arrangement, Row, SIDE_BY_SIDE, Slot};

use crate::w16_6_whole_window::model::panel;

/// The layout of the widget.
#[must_use]
pub fn arrange(_scene: &Scene, width: f32) -> Arrangement {
    let [sweeps, places] = [panel::SWEEPS, panel::PLACES];
    let (stage, bounds_px) = if width >= SIDE_BY_SIDE {
        let pair = [sweeps, places].map(|panel| Slot::natural(panel, 420.0));
        (vec![Row::new(&pair)], 150.0)
    } else {
        let each = [sweeps, places].map(|panel| Slot::natural(panel, 260.0));
        (Row::each(&each), 100.0)
    };
    Arrangement {
        stage,
        below: Row::each(&[Slot::fixed(panel::BOUNDS, bounds_px)]),
    }
}
