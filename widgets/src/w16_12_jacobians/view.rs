//! Layout of the panels: the four graphs side by side, the curves below them.

use kit::layout::PlotHeight;
use kit::scene::Scene;
use kit::view::{Arrangement, Row, SIDE_BY_SIDE, Slot, View};

use crate::w16_12_jacobians::model::panel;

/// Width from which the four graphs are in one row.
const ONE_ROW: f32 = 800.0;

/// The layout of the widget.
#[derive(Clone, Copy, Debug, Default)]
pub struct JacobiansView;

impl View for JacobiansView {
    fn arrange(&self, _scene: &Scene, width: f32) -> Arrangement {
        let slot = |panel, height| Slot { panel, height };
        let [most, plot] = if width >= SIDE_BY_SIDE {
            [200.0, 200.0]
        } else {
            [130.0, 170.0]
        };
        let maps = panel::MAPS.map(|panel| slot(panel, PlotHeight::Natural { most }));
        let in_row = if width >= ONE_ROW { 4 } else { 2 };
        let mut stage: Vec<_> = maps.chunks(in_row).map(Row::new).collect();
        stage.push(Row::new(&[slot(panel::CURVE, PlotHeight::Fixed(plot))]));
        Arrangement {
            stage,
            below: Vec::new(),
        }
    }
}
