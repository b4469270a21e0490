//! Layout of the panels: the map, and the scores below it or beside it.

use widget_kit::scene::{Layer, Scene};
use widget_kit::view::{Arrangement, Row, SIDE_BY_SIDE, Slot};

use crate::w16_9_relocalization::model::panel;

/// The layout of the widget.
#[must_use]
pub fn arrange(scene: &Scene, width: f32) -> Arrangement {
    let scores = |px| Slot::fixed(panel::SCORES, px);
    let stage = if width < SIDE_BY_SIDE {
        Row::each(&[Slot::natural(panel::MAP, 300.0), scores(150.0)])
    } else {
        let map = Slot::natural(panel::MAP, 400.0);
        if has_scores(scene) {
            vec![Row::of_columns(&[(2.4, &[map]), (1.0, &[scores(300.0)])])]
        } else {
            Row::each(&[map])
        }
    };
    Arrangement {
        stage,
        below: Vec::new(),
    }
}

/// Whether a score is known: beside the map its plot appears with the first one.
fn has_scores(scene: &Scene) -> bool {
    let scores = scene
        .panels
        .iter()
        .filter(|panel| panel.id == panel::SCORES);
    let mut layers = scores.flat_map(|panel| &panel.layers);
    layers.any(|layer| matches!(layer, Layer::Points { points, .. } if !points.is_empty()))
}
