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
        let height = if is_empty {
            // The host's drop zone covers it.
            PlotHeight::Fixed(220.0)
        } else if width < SIDE_BY_SIDE {
            PlotHeight::Natural { most: 520.0 }
        } else {
            PlotHeight::Natural { most: 620.0 }
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
