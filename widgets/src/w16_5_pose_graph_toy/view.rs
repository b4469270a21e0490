//! Layout of the panels: the graph beside χ² over its steps, the bars of the springs below.

use kit::layout::PlotHeight;
use kit::scene::Scene;
use kit::view::{Arrangement, Column, Row, SIDE_BY_SIDE, Slot, View};

use crate::w16_5_pose_graph_toy::model::panel;

const STEPS: Slot = Slot {
    panel: panel::STEPS,
    height: PlotHeight::Fixed(120.0),
};

/// The layout of the widget.
#[derive(Clone, Copy, Debug, Default)]
pub struct ToyView;

impl View for ToyView {
    fn arrange(&self, _scene: &Scene, width: f32) -> Arrangement {
        let slot = |panel, height| Slot { panel, height };
        let graph = slot(panel::GRAPH, PlotHeight::Natural { most: 420.0 });
        let bars = slot(panel::BARS, PlotHeight::Fixed(150.0));
        let stage = if width >= SIDE_BY_SIDE {
            let column = |share, slot| Column {
                share,
                slots: vec![slot],
            };
            vec![Row {
                columns: vec![column(1.8, graph), column(1.0, STEPS)],
            }]
        } else {
            vec![Row::new(&[graph])]
        };
        Arrangement {
            stage,
            below: vec![Row::new(&[bars])],
        }
    }

    fn under_control(&self, width: f32) -> Vec<Row> {
        if width >= SIDE_BY_SIDE {
            return Vec::new();
        }
        vec![Row::new(&[STEPS])]
    }
}
