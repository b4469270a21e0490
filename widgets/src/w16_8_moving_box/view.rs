//! Layout of the panels: the room, the curves beside it or below it.

use widget_kit::layout::PlotHeight;
use widget_kit::scene::Scene;
use widget_kit::view::{Arrangement, Column, Row, SIDE_BY_SIDE, Slot, View};

use crate::w16_8_moving_box::model::panel;

/// The layout of the widget.
#[derive(Clone, Copy, Debug, Default)]
pub struct BoxView;

impl View for BoxView {
    fn arrange(&self, _scene: &Scene, width: f32) -> Arrangement {
        let slot = |panel, height| Slot { panel, height };
        let room = slot(panel::ROOM, PlotHeight::Natural { most: 430.0 });
        let bias = |height| slot(panel::BIAS, PlotHeight::Fixed(height));
        let stage = if width >= SIDE_BY_SIDE {
            let column = |share, slot| Column {
                share,
                slots: vec![slot],
            };
            vec![Row {
                columns: vec![column(1.5, room), column(1.0, bias(240.0))],
            }]
        } else {
            vec![Row::new(&[room]), Row::new(&[bias(110.0)])]
        };
        Arrangement {
            stage,
            below: Vec::new(),
        }
    }
}
