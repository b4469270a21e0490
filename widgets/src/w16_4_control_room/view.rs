//! Layout of the panels: the map beside or above the lanes, the registration and the plots below.

use widget_kit::scene::Scene;
use widget_kit::view::{Arrangement, Row, SIDE_BY_SIDE, Slot};

/// Width from which the lanes are beside the map.
const BESIDE_THE_MAP: f32 = 860.0;

/// The layout of the widget.
#[must_use]
pub fn arrange(_scene: &Scene, width: f32) -> Arrangement {
    let map = Slot::natural("map", 440.0);
    let lanes = |px| Slot::fixed("lanes", px);
    let stage = if width >= BESIDE_THE_MAP {
        vec![Row::new(&[map, lanes(320.0)])]
    } else {
        // On a phone the map, the lanes and Play fit one screen.
        let lanes_px = if width < SIDE_BY_SIDE { 150.0 } else { 170.0 };
        Row::each(&[map, lanes(lanes_px)])
    };
    Arrangement {
        stage,
        below: Row::each(&[
            Slot::natural("registration", 380.0),
            Slot::fixed("tau", 130.0),
            Slot::fixed("errors", 130.0),
        ]),
    }
}
