//! Layout of the panels: the map beside the registration, or on a phone above it; the lanes over the whole width below
//! the map.

use widget_kit::layout::PlotHeight;
use widget_kit::scene::Scene;
use widget_kit::view::{Arrangement, Column, Row, SIDE_BY_SIDE, Slot, View};

/// The layout of [`crate::w16_4_control_room::model::ControlRoom`].
#[derive(Clone, Copy, Debug, Default)]
pub struct ControlRoomView;

impl View for ControlRoomView {
    fn arrange(&self, _scene: &Scene, width: f32) -> Arrangement {
        let lanes = Slot {
            panel: "lanes",
            // On a phone the map, the lanes and Play fit one screen.
            height: PlotHeight::Fixed(if width < SIDE_BY_SIDE { 150.0 } else { 220.0 }),
        };
        let natural = |panel| Slot {
            panel,
            height: PlotHeight::Natural { most: 480.0 },
        };
        let plot = |panel| Slot {
            panel,
            height: PlotHeight::Fixed(130.0),
        };
        if width < SIDE_BY_SIDE {
            let rows = |slots: &[Slot]| slots.iter().map(|slot| Row::new(&[*slot])).collect();
            return Arrangement {
                stage: rows(&[natural("map"), lanes, natural("registration")]),
                below: rows(&[plot("tau"), plot("errors")]),
            };
        }
        let column = |panel| Column {
            share: 1.0,
            slots: vec![natural(panel)],
        };
        Arrangement {
            stage: vec![
                Row {
                    columns: ["map", "registration"].map(column).to_vec(),
                },
                Row::new(&[lanes]),
            ],
            below: vec![Row::new(&[plot("tau"), plot("errors")])],
        }
    }
}
