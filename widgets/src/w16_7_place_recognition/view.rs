//! Layout of the panels: the flat beside the views, the distances, the matrix and the curves below.

use widget_kit::scene::Scene;
use widget_kit::view::{Arrangement, Row, SIDE_BY_SIDE, Slot};

use crate::w16_7_place_recognition::model::panel;

/// The layout of the widget.
#[must_use]
pub fn arrange(_scene: &Scene, width: f32) -> Arrangement {
    let flat = Slot::natural(panel::FLAT, 360.0);
    let scores = Slot::fixed(panel::SCORES, 120.0);
    let looks = |px| Slot::fixed(panel::LOOKS, px);
    let matrix = Slot::natural(panel::MATRIX, 290.0);
    let curves = Slot::fixed(panel::CURVES, 130.0);
    if width >= SIDE_BY_SIDE {
        let pair = Row::of_columns(&[(1.55, &[flat]), (1.0, &[looks(280.0)])]);
        return Arrangement {
            stage: vec![pair, Row::new(&[scores])],
            below: vec![Row::new(&[matrix, curves])],
        };
    }
    // On a phone the flat, the threshold and the control fit one screen without the matrix.
    Arrangement {
        stage: Row::each(&[flat, scores, looks(100.0)]),
        below: Row::each(&[matrix, curves]),
    }
}
