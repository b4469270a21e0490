//! Layout of the panels: the room, the curves beside it or below it.

use widget_kit::scene::Scene;
use widget_kit::view::{Arrangement, Row, SIDE_BY_SIDE, Slot};

use crate::w16_8_moving_box::model::panel;

/// The layout of the widget.
#[must_use]
pub fn arrange(_scene: &Scene, width: f32) -> Arrangement {
    let room = Slot::natural(panel::ROOM, 430.0);
    let bias = |px| Slot::fixed(panel::BIAS, px);
    let stage = if width >= SIDE_BY_SIDE {
        vec![Row::of_columns(&[(1.5, &[room]), (1.0, &[bias(240.0)])])]
    } else {
        Row::each(&[room, bias(110.0)])
    };
    Arrangement {
        stage,
        below: Vec::new(),
    }
}
