//! Layout of the panels: all pairs beside the selected one, the curves below.

use kit::layout::PlotHeight;
use kit::scene::Scene;
use kit::view::{Arrangement, Column, Row, SIDE_BY_SIDE, Slot, View};

use crate::w16_7_been_here::model::panel;

/// The layout of the widget.
#[derive(Clone, Copy, Debug, Default)]
pub struct PlacesView;

impl View for PlacesView {
    fn arrange(&self, _scene: &Scene, width: f32) -> Arrangement {
        let slot = |panel, height| Slot { panel, height };
        // Four panels below each other have to fit two screens of a phone.
        let [most, most_scans, plot] = if width >= SIDE_BY_SIDE {
            [300.0, 300.0, 130.0]
        } else {
            [210.0, 140.0, 90.0]
        };
        let matrix = slot(panel::MATRIX, PlotHeight::Natural { most });
        let scans = slot(panel::SCANS, PlotHeight::Natural { most: most_scans });
        let looks = slot(panel::LOOKS, PlotHeight::Fixed(plot));
        let curves = slot(panel::CURVES, PlotHeight::Fixed(plot));
        let map = slot(panel::MAP, PlotHeight::Natural { most: 260.0 });
        let stage = if width >= SIDE_BY_SIDE {
            let column = |slot| Column {
                share: 1.0,
                slots: vec![slot],
            };
            let row = |a, b| Row {
                columns: vec![column(a), column(b)],
            };
            vec![row(matrix, scans), row(curves, looks)]
        } else {
            [matrix, scans, looks, curves]
                .iter()
                .map(|slot| Row::new(&[*slot]))
                .collect()
        };
        Arrangement {
            stage,
            below: vec![Row::new(&[map])],
        }
    }
}
