//! Layout of the panels: the flat beside the views, the distances, the matrix and the curves below.

use widget_kit::layout::PlotHeight;
use widget_kit::scene::Scene;
use widget_kit::view::{Arrangement, Column, Row, SIDE_BY_SIDE, Slot, View};

use crate::w16_7_place_recognition::model::panel;

/// The layout of the widget.
#[derive(Clone, Copy, Debug, Default)]
pub struct PlacesView;

impl View for PlacesView {
    fn arrange(&self, _scene: &Scene, width: f32) -> Arrangement {
        let slot = |panel, height| Slot { panel, height };
        let is_wide = width >= SIDE_BY_SIDE;
        let flat = slot(panel::FLAT, PlotHeight::Natural { most: 360.0 });
        let scores = slot(panel::SCORES, PlotHeight::Fixed(120.0));
        let looks = slot(
            panel::LOOKS,
            PlotHeight::Fixed(if is_wide { 280.0 } else { 100.0 }),
        );
        let matrix = slot(panel::MATRIX, PlotHeight::Natural { most: 290.0 });
        let curves = slot(panel::CURVES, PlotHeight::Fixed(130.0));
        if is_wide {
            let column = |share, slot| Column {
                share,
                slots: vec![slot],
            };
            let pair = Row {
                columns: vec![column(1.55, flat), column(1.0, looks)],
            };
            return Arrangement {
                stage: vec![pair, Row::new(&[scores])],
                below: vec![Row::new(&[matrix, curves])],
            };
        }
        // On a phone the flat, the threshold and the control fit one screen without the matrix.
        let rows = |slots: &[Slot]| slots.iter().map(|slot| Row::new(&[*slot])).collect();
        Arrangement {
            stage: rows(&[flat, scores, looks]),
            below: rows(&[matrix, curves]),
        }
    }
}
