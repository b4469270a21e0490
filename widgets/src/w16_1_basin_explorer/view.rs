//! Layout of the panels: the sweeps beside the two basin maps, or above them on a phone; the curve below.

use widget_kit::layout::PlotHeight;
use widget_kit::scene::Scene;
use widget_kit::view::{Arrangement, Column, Row, SIDE_BY_SIDE, Slot, View};

use crate::w16_1_basin_explorer::model::panel;

/// Height of a map beside the sweeps: both maps together are as high as the sweeps alone, so nothing jumps as they
/// enter.
const BESIDE_PX: f32 = 115.0;
/// Height of the sweeps on a phone, alone and above a map: both are equally high with it.
const PHONE_PX: [f32; 2] = [440.0, 166.0];
/// Height of a map on a phone.
const BELOW_PX: f32 = 112.0;

/// The layout of the widget.
#[derive(Clone, Copy, Debug, Default)]
pub struct BasinView;

impl View for BasinView {
    fn arrange(&self, scene: &Scene, width: f32) -> Arrangement {
        let curve = Row::new(&[slot(panel::CURVE, PlotHeight::Fixed(120.0))]);
        if width >= SIDE_BY_SIDE {
            let column = |share, slots: &[Slot]| Column {
                share,
                slots: slots.to_vec(),
            };
            let sweeps = slot(panel::SWEEPS, PlotHeight::Natural { most: 470.0 });
            let maps =
                [panel::POINT, panel::PLANE].map(|id| slot(id, PlotHeight::Fixed(BESIDE_PX)));
            return Arrangement {
                stage: vec![Row {
                    columns: vec![column(1.5, &[sweeps]), column(1.0, &maps)],
                }],
                below: vec![curve],
            };
        }
        let has_sweeps = scene.panels.iter().any(|panel| panel.id == panel::SWEEPS);
        // One screen holds the sweeps, the map of the chosen variant and the controls.
        let is_map = |id: &&str| [panel::POINT, panel::PLANE].contains(id);
        let maps = scene.panels.iter().map(|panel| panel.id).filter(is_map);
        let maps = maps.map(|id| Row::new(&[slot(id, PlotHeight::Fixed(BELOW_PX))]));
        let mut maps: Vec<_> = maps.collect();
        let high = PHONE_PX[usize::from(!maps.is_empty())];
        let mut below = maps.split_off(maps.len().min(2 - usize::from(has_sweeps)));
        below.push(curve);
        let sweeps = Row::new(&[slot(panel::SWEEPS, PlotHeight::Fixed(high))]);
        Arrangement {
            stage: core::iter::once(sweeps).chain(maps).collect(),
            below,
        }
    }
}

fn slot(panel: &'static str, height: PlotHeight) -> Slot {
    Slot { panel, height }
}
