//! Layout of the panels: the map above the lanes, the registration and the plots below.

use widget_kit::layout::PlotHeight;
use widget_kit::scene::Scene;
use widget_kit::view::{Arrangement, Row, SIDE_BY_SIDE, Slot, View};

/// The layout of [`crate::w16_4_control_room::model::ControlRoom`].
#[derive(Clone, Copy, Debug, Default)]
pub struct ControlRoomView;

impl View for ControlRoomView {
    fn arrange(&self, _scene: &Scene, width: f32) -> Arrangement {
        let slot = |panel, height| Row::new(&[Slot { panel, height }]);
        // On a phone the map, the lanes and Play fit one screen.
        let lanes_px = if width < SIDE_BY_SIDE { 150.0 } else { 170.0 };
        Arrangement {
            stage: vec![
                slot("map", PlotHeight::Natural { most: 440.0 }),
                slot("lanes", PlotHeight::Fixed(lanes_px)),
            ],
            below: vec![
                slot("registration", PlotHeight::Natural { most: 380.0 }),
                slot("tau", PlotHeight::Fixed(130.0)),
                slot("errors", PlotHeight::Fixed(130.0)),
            ],
        }
    }
}
