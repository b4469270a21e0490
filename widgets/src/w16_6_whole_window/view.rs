//! Layout of the panels: the sweeps beside the positions, the rest below.

use widget_kit::layout::PlotHeight;
use widget_kit::scene::Scene;
use widget_kit::view::{Arrangement, Row, SIDE_BY_SIDE, Slot, View};

use crate::w16_6_whole_window::model::panel;

/// The layout of the widget.
#[derive(Clone, Copy, Debug, Default)]
pub struct WindowView;

impl View for WindowView {
    fn arrange(&self, _scene: &Scene, width: f32) -> Arrangement {
        let slot = |panel, height| Slot { panel, height };
        let (sweeps_px, places_px, high) = if width >= SIDE_BY_SIDE {
            (420.0, 420.0, 150.0)
        } else {
            (260.0, 260.0, 100.0)
        };
        let natural = |panel, most| slot(panel, PlotHeight::Natural { most });
        let sweeps = natural(panel::SWEEPS, sweeps_px);
        let places = natural(panel::PLACES, places_px);
        let bounds = slot(panel::BOUNDS, PlotHeight::Fixed(high));
        let stage = if width >= SIDE_BY_SIDE {
            vec![Row::new(&[sweeps, places])]
        } else {
            vec![Row::new(&[sweeps]), Row::new(&[places])]
        };
        Arrangement {
            stage,
            below: vec![Row::new(&[bounds])],
        }
    }
}
