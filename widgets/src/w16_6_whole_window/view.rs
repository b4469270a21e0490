//! Layout of the panels: the sweeps beside the positions and the bounds, the rest below.

use kit::layout::PlotHeight;
use kit::scene::Scene;
use kit::view::{Arrangement, Column, Row, SIDE_BY_SIDE, Slot, View};

use crate::w16_6_whole_window::model::panel;

/// The layout of the widget.
#[derive(Clone, Copy, Debug, Default)]
pub struct WindowView;

impl View for WindowView {
    fn arrange(&self, _scene: &Scene, width: f32) -> Arrangement {
        let slot = |panel, height| Slot { panel, height };
        // On a phone the sweeps, the bounds and the control fit one screen without the positions.
        let (most, high) = if width >= SIDE_BY_SIDE {
            (330.0, 150.0)
        } else {
            (220.0, 100.0)
        };
        let sweeps = slot(panel::SWEEPS, PlotHeight::Natural { most });
        let places = slot(panel::PLACES, PlotHeight::Natural { most });
        let bounds = slot(panel::BOUNDS, PlotHeight::Fixed(high));
        let gap = slot(panel::GAP, PlotHeight::Fixed(120.0));
        let stage = if width >= SIDE_BY_SIDE {
            let column = |slot| Column {
                share: 1.0,
                slots: vec![slot],
            };
            vec![
                Row {
                    columns: vec![column(sweeps), column(places)],
                },
                Row::new(&[bounds]),
            ]
        } else {
            vec![Row::new(&[sweeps]), Row::new(&[bounds])]
        };
        let below = vec![Row::new(&[gap])];
        Arrangement { stage, below }
    }

    fn under_control(&self, width: f32) -> Vec<Row> {
        if width >= SIDE_BY_SIDE {
            return Vec::new();
        }
        vec![Row::new(&[Slot {
            panel: panel::PLACES,
            height: PlotHeight::Natural { most: 240.0 },
        }])]
    }
}
