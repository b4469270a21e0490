//! Layout of the panels: the map as large as possible, the plots of the keyframes below.

use widget_kit::scene::Scene;
use widget_kit::view::{Arrangement, Row, SIDE_BY_SIDE, Slot};

use crate::w16_10_own_robot::model::panel;

/// The layout of the widget.
#[must_use]
pub fn arrange(scene: &Scene, width: f32) -> Arrangement {
    let map = if scene.panels[0].layers.is_empty() {
        // The host's drop zone covers it.
        Slot::fixed(panel::MAP, 220.0)
    } else {
        let most = if width < SIDE_BY_SIDE { 520.0 } else { 620.0 };
        Slot::natural(panel::MAP, most)
    };
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
