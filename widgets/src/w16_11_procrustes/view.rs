//! Layout of the panels: the two maps beside each other, the points beside the trace below them.

use widget_kit::layout::PlotHeight;
use widget_kit::scene::Scene;
use widget_kit::view::{Arrangement, Row, SIDE_BY_SIDE, Slot, View};

use crate::w16_11_procrustes::model::panel;

/// The layout of the widget.
#[derive(Clone, Copy, Debug, Default)]
pub struct TraceView;

impl View for TraceView {
    fn arrange(&self, _scene: &Scene, width: f32) -> Arrangement {
        let slot = |panel, height| Slot { panel, height };
        let wide = width >= SIDE_BY_SIDE;
        let [most, plot, map] = if wide {
            // Maps and points are seen together on a low screen.
            [200.0, 180.0, 190.0]
        } else {
            [200.0, 140.0, 170.0]
        };
        let points = slot(panel::POINTS, PlotHeight::Natural { most });
        let trace = slot(panel::TRACE, PlotHeight::Fixed(plot));
        let maps = [panel::MAP_TURN, panel::MAP_UNCHECKED]
            .map(|panel| slot(panel, PlotHeight::Natural { most: map }));
        let mut stage = vec![Row::new(&maps)];
        if wide {
            stage.push(Row::new(&[points, trace]));
        } else {
            stage.extend([points, trace].map(|slot| Row::new(&[slot])));
        }
        Arrangement {
            stage,
            below: Vec::new(),
        }
    }
}
