//! Layout of the panels: the graph beside χ² over its steps, the bars of the springs below.

use widget_kit::layout::PlotHeight;
use widget_kit::scene::Scene;
use widget_kit::view::{Arrangement, Column, Row, SIDE_BY_SIDE, Slot, View};

use crate::w16_5_pose_graph_toy::model::panel;

/// The layout of the widget.
#[derive(Clone, Copy, Debug, Default)]
pub struct ToyView;

impl View for ToyView {
    fn arrange(&self, _scene: &Scene, width: f32) -> Arrangement {
        let slot = |panel, height| Slot { panel, height };
        let is_wide = width >= SIDE_BY_SIDE;
        let most = if is_wide { 420.0 } else { 330.0 };
        let graph = slot(panel::GRAPH, PlotHeight::Natural { most });
        let bars = slot(panel::BARS, PlotHeight::Fixed(150.0));
        let steps = slot(
            panel::STEPS,
            PlotHeight::Fixed(if is_wide { 330.0 } else { 150.0 }),
        );
        let stage = if is_wide {
            let column = |share, slot| Column {
                share,
                slots: vec![slot],
            };
            let row = Row {
                columns: vec![column(1.8, graph), column(1.0, steps)],
            };
            vec![row]
        } else {
            vec![Row::new(&[graph]), Row::new(&[steps])]
        };
        Arrangement {
            stage,
            below: vec![Row::new(&[bars])],
        }
    }
}
