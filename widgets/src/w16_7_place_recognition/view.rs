//! Layout of the panels: the flat over the distances; the views by bearing, the matrix and the curves below.

use widget_kit::scene::Scene;
use widget_kit::view::{Arrangement, Row, SIDE_BY_SIDE, Slot};

use crate::w16_7_place_recognition::model::panel;

/// The layout of the widget.
#[must_use]
pub fn arrange(_scene: &Scene, width: f32) -> Arrangement {
    let stage = Row::each(&[
        Slot::natural(panel::FLAT, 360.0),
        Slot::fixed(panel::SCORES, 120.0),
    ]);
    let looks = Slot::fixed(panel::LOOKS, 130.0);
    let matrix = Slot::natural(panel::MATRIX, 290.0);
    let curves = Slot::fixed(panel::CURVES, 130.0);
    let below = if width >= SIDE_BY_SIDE {
        vec![Row::new(&[matrix, curves]), Row::new(&[looks])]
    } else {
        Row::each(&[looks, matrix, curves])
    };
    Arrangement { stage, below }
}
