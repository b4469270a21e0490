//! Layout of the panels: the map beside or above the lanes, the registration and the plots below.

use widget_kit::layout::PlotHeight;
use widget_kit::scene::Scene;
use widget_kit::view::{Arrangement, Row, SIDE_BY_SIDE, Slot, View};

/// Width from which the lanes are beside the map.
const BESIDE_THE_MAP: f32 = 860.0;

/// The layout of [`crate::w16_4_control_room::model::ControlRoom`].
#[derive(Clone, Copy, Debug, Default)]
pub struct ControlRoomView;

impl View for ControlRoomView {
    fn arrange(&self, _scene: &Scene, width: f32) -> Arrangement {
        let slot = |panel, height| Row::new(&[Slot { panel, height }]);
        let map = Slot {
            panel: "map",
            height: PlotHeight::Natural { most: 440.0 },
        };
        let stage = if width >= BESIDE_THE_MAP {
            let lanes = PlotHeight::Fixed(320.0);
            vec![Row::new(&[
                map,
                Slot {
                    panel: "lanes",
                    height: lanes,
                },
            ])]
        } else {
            // On a phone the map, the lanes and Play fit one screen.
            let lanes_px = if width < SIDE_BY_SIDE { 150.0 } else { 170.0 };
            vec![Row::new(&[map]), slot("lanes", PlotHeight::Fixed(lanes_px))]
        };
        Arrangement {
            stage,
            below: vec![
                slot("registration", PlotHeight::Natural { most: 380.0 }),
                slot("tau", PlotHeight::Fixed(130.0)),
                slot("errors", PlotHeight::Fixed(130.0)),
            ],
        }
    }
}
