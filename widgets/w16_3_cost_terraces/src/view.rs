//! Where the panels stand.

use kit::layout::PlotHeight;
use kit::scene::Scene;
use kit::view::{Arrangement, Row, SIDE_BY_SIDE, Slot, View};

/// Both maps side by side, with their slices below.
#[derive(Clone, Copy, Debug, Default)]
pub struct TerracesView;

impl View for TerracesView {
    fn arrange(&self, _scene: &Scene, width: f32) -> Arrangement {
        let maps = ["icp", "ndt"].map(|id| slot(id, PlotHeight::Natural { most: 480.0 }));
        let slices =
            ["icp-x", "ndt-x", "icp-y", "ndt-y"].map(|id| slot(id, PlotHeight::Fixed(130.0)));
        let places =
            ["sweep", "information"].map(|id| slot(id, PlotHeight::Natural { most: 240.0 }));
        // Side by side, every slice stands below its map.
        let beside = if width < SIDE_BY_SIDE { 1 } else { 2 };
        let rows = |slots: &[Slot]| slots.chunks(beside).map(Row::of).collect::<Vec<_>>();
        Arrangement {
            stage: rows(&maps),
            below: [rows(&slices), rows(&places)].concat(),
        }
    }
}

fn slot(panel: &'static str, height: PlotHeight) -> Slot {
    Slot { panel, height }
}
