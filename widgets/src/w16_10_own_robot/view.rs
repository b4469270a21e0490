//! Layout of the panels: the map as large as possible, the plots of the keyframes below.

use widget_kit::scene::{Layer, Scene};
use widget_kit::view::{Arrangement, Row, SIDE_BY_SIDE, Slot};

use crate::w16_10_own_robot::model::panel;

/// The layout of the widget.
#[must_use]
pub fn arrange(scene: &Scene, width: f32) -> Arrangement {
    let mut layers = scene.panels.iter().flat_map(|shown| &shown.layers);
    let is_mapped = layers.any(|layer| matches!(layer, Layer::Raster(_)));
    let map = match (width < SIDE_BY_SIDE, is_mapped) {
        (true, false) => Slot::fixed(panel::MAP, 440.0),
        (true, true) => Slot::natural(panel::MAP, 520.0),
        (false, _) => Slot::natural(panel::MAP, 620.0),
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
