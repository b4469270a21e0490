//! Layout of the panels: points beside the trace, the two maps beside each other.

use kit::layout::PlotHeight;
use kit::scene::Scene;
use kit::view::{Arrangement, Row, SIDE_BY_SIDE, Slot, View};

use crate::w16_11_procrustes::model::panel;

/// The layout of the widget.
#[derive(Clone, Copy, Debug, Default)]
pub struct TraceView;

impl View for TraceView {
    fn arrange(&self, _scene: &Scene, width: f32) -> Arrangement {
        let slot = |panel, height| Slot { panel, height };
        let wide = width >= SIDE_BY_SIDE;
        let [most, plot, map] = if wide {
            [300.0, 240.0, 210.0]
        } else {
            [230.0, 150.0, 130.0]
        };
        let points = slot(panel::POINTS, PlotHeight::Natural { most });
        let trace = slot(panel::TRACE, PlotHeight::Fixed(plot));
        let maps = [panel::MAP_TURN, panel::MAP_UNCHECKED]
            .map(|panel| slot(panel, PlotHeight::Natural { most: map }));
        let mut stage = if wide {
            vec![Row::new(&[points, trace])]
        } else {
            vec![Row::new(&[points]), Row::new(&[trace])]
        };
        stage.push(Row::new(&maps));
        Arrangement {
            stage,
            below: Vec::new(),
        }
    }
}
