//! Layout of the panels: the plan, and below the controls the positions and the bounds.

use widget_kit::scene::Scene;
use widget_kit::view::{Arrangement, Row, SIDE_BY_SIDE, Slot};

use crate::w16_6_whole_window::model::panel;

/// The layout of the widget: the plan is the same with and without what More shows.
#[must_use]
pub fn arrange(_scene: &Scene, width: f32) -> Arrangement {
    let (plan, places_px, bounds_px) = if width >= SIDE_BY_SIDE {
        (Slot::natural(panel::SWEEPS, 560.0), 420.0, 150.0)
    } else {
        (Slot::fixed(panel::SWEEPS, 465.0), 260.0, 100.0)
    };
    let places = Slot::natural(panel::PLACES, places_px);
    Arrangement {
        stage: Row::each(&[plan]),
        below: Row::each(&[places, Slot::fixed(panel::BOUNDS, bounds_px)]),
    }
}
