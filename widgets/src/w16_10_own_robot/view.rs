//! Layout of the panels: the map as large as possible, the plots of the keyframes below.

use widget_kit::layout::PlotHeight;
use widget_kit::scene::Scene;
use widget_kit::view::{Arrangement, Row, SIDE_BY_SIDE, Slot, View};

use crate::w16_10_own_robot::model::panel;

/// The layout of the widget.
#[derive(Clone, Copy, Debug, Default)]
pub struct RobotView;

impl View for RobotView {
    fn arrange(&self, scene: &Scene, width: f32) -> Arrangement {
        let slot = |panel, height| Slot { panel, height };
        let is_empty = scene.panels[0].layers.is_empty();
        let height = match (width < SIDE_BY_SIDE, is_empty) {
            // The host's picture covers it.
            (true, true) => PlotHeight::Fixed(440.0),
            (true, false) => PlotHeight::Natural { most: 520.0 },
            (false, _) => PlotHeight::Natural { most: 620.0 },
        };
        let map = slot(panel::MAP, height);
        let plots = [panel::FIT, panel::SURE].map(|id| slot(id, PlotHeight::Fixed(130.0)));
        let below = if width < SIDE_BY_SIDE {
            plots.iter().map(|plot| Row::new(&[*plot])).collect()
        } else {
            vec![Row::new(&plots)]
        };
        Arrangement {
            stage: vec![Row::new(&[map])],
            below,
        }
    }
}
