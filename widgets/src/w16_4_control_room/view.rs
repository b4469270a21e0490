//! Layout of the panels: the map above its parts, the registration and the plots below.

use widget_kit::scene::Scene;
use widget_kit::view::{Arrangement, Row, Slot};

/// The layout of the widget.
#[must_use]
pub fn arrange(_scene: &Scene, _width: f32) -> Arrangement {
    Arrangement {
        stage: Row::each(&[Slot::natural("map", 440.0), Slot::fixed("parts", 110.0)]),
        below: Row::each(&[
            Slot::natural("registration", 380.0),
            Slot::fixed("tau", 130.0),
            Slot::fixed("errors", 130.0),
        ]),
    }
}
