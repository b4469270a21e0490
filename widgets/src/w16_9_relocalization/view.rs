//! Layout of the panels: the map, and the scores below it or beside it.

use widget_kit::layout::PlotHeight;
use widget_kit::scene::{Layer, Scene};
use widget_kit::view::{Arrangement, Column, Row, SIDE_BY_SIDE, Slot, View};

use crate::w16_9_relocalization::model::panel;

/// The layout of the widget.
#[derive(Clone, Copy, Debug, Default)]
pub struct RelocalizationView;

impl View for RelocalizationView {
    fn arrange(&self, scene: &Scene, width: f32) -> Arrangement {
        let slot = |panel, height| Slot { panel, height };
        let is_wide = width >= SIDE_BY_SIDE;
        let most = if is_wide { 400.0 } else { 300.0 };
        let map = slot(panel::MAP, PlotHeight::Natural { most });
        let scores = |height| slot(panel::SCORES, PlotHeight::Fixed(height));
        let stage = if is_wide && !has_scores(scene) {
            vec![Row::new(&[map])]
        } else if is_wide {
            let column = |share, slot| Column {
                share,
                slots: vec![slot],
            };
            vec![Row {
                columns: vec![column(2.4, map), column(1.0, scores(300.0))],
            }]
        } else {
            vec![Row::new(&[map]), Row::new(&[scores(150.0)])]
        };
        Arrangement {
            stage,
            below: Vec::new(),
        }
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
