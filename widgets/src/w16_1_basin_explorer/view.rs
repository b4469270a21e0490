//! Layout of the panels: the sweeps beside the two basin maps, the curve below.

use kit::layout::PlotHeight;
use kit::scene::Scene;
use kit::view::{Arrangement, Column, Row, SIDE_BY_SIDE, Slot, View};

use crate::w16_1_basin_explorer::model::panel;

/// The layout of the widget.
#[derive(Clone, Copy, Debug, Default)]
pub struct BasinView;

impl View for BasinView {
    fn arrange(&self, _scene: &Scene, width: f32) -> Arrangement {
        let slot = |panel, height| Slot { panel, height };
        let sweeps = slot(panel::SWEEPS, PlotHeight::Natural { most: 470.0 });
        let basins = [panel::POINT, panel::PLANE].map(|id| slot(id, PlotHeight::Fixed(150.0)));
        let stage = if width >= SIDE_BY_SIDE {
            let columns = vec![
                Column {
                    share: 1.5,
                    slots: vec![sweeps],
                },
                Column {
                    share: 1.0,
                    slots: basins.to_vec(),
                },
            ];
            vec![Row { columns }]
        } else {
            let rows = core::iter::once(sweeps).chain(basins);
            rows.map(|slot| Row::new(&[slot])).collect()
        };
        let curve = slot(panel::CURVE, PlotHeight::Fixed(120.0));
        Arrangement {
            stage,
            below: vec![Row::new(&[curve])],
        }
    }
}
