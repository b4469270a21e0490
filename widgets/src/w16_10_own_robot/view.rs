//! Layout of the panels: the map as large as possible, the plots of the keyframes below.

use widget_kit::scene::Scene;
use widget_kit::view::{Arrangement, Row, SIDE_BY_SIDE, Slot};

use crate::w16_10_own_robot::model::panel;

/// The layout of the widget.
#[must_use]
pub fn arrange(_: &Scene, width: f32) -> Arrangement {
    let most_px = if width < SIDE_BY_SIDE { 520.0 } else { 620.0 };
    let map = Slot::natural(panel::MAP, most_px);
    let plots = [panel::FIT, panel::SURE].map(|id| Slot::fixed(id, 130.0));
    let below = if width < SIDE_BY_SIDE {
        Row::each(&plots)
    } else {
        vec![Row::new(&plots)]
    };
    Arrangement {
        stage: Row::each(&[map]),
        below,
    }
}
