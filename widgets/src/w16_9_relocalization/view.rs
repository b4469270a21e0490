//! Layout of the panels: the map, and the scores below it or beside it.

use widget_kit::scene::Scene;
use widget_kit::view::{Arrangement, Row, SIDE_BY_SIDE, Slot};

use crate::w16_9_relocalization::model::panel;

/// The layout of the widget.
#[must_use]
pub fn arrange(_scene: &Scene, width: f32) -> Arrangement {
    let scores = |px| Slot::fixed(panel::SCORES, px);
    let stage = if width < SIDE_BY_SIDE {
        Row::each(&[Slot::natural(panel::MAP, 300.0), scores(150.0)])
    } else {
        let map = Slot::natural(panel::MAP, 400.0);
        vec![Row::of_columns(&[(2.4, &[map]), (1.0, &[scores(300.0)])])]
    };
    Arrangement {
        stage,
        below: Vec::new(),
    }
}
