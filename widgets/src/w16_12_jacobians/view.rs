//! Layout of the panels: the four graphs over each other, the curves beside them.

use widget_kit::layout::PlotHeight;
use widget_kit::scene::Scene;
use widget_kit::view::{Arrangement, Column, Row, SIDE_BY_SIDE, Slot, View};

use crate::w16_12_jacobians::model::panel;

/// Width from which the graphs are as high as they may be.
const BESIDE: f32 = 860.0;

/// The layout of the widget.
#[derive(Clone, Copy, Debug, Default)]
pub struct JacobiansView;

impl View for JacobiansView {
    fn arrange(&self, _scene: &Scene, width: f32) -> Arrangement {
        let slot = |panel, height| Slot { panel, height };
        let graphs = slot(panel::GRAPHS, PlotHeight::Natural { most: 420.0 });
        let curve = slot(
            panel::CURVE,
            PlotHeight::Fixed(if width >= BESIDE { 380.0 } else { 290.0 }),
        );
        let stage = if width >= SIDE_BY_SIDE {
            let column = |share, slot| Column {
                share,
                slots: vec![slot],
            };
            vec![Row {
                columns: vec![column(1.2, graphs), column(1.0, curve)],
            }]
        } else {
            vec![Row::new(&[graphs]), Row::new(&[curve])]
        };
        Arrangement {
            stage,
            below: Vec::new(),
        }
    }
}
