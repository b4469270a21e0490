//! Layout of the panels: the sweeps beside the two basin maps, or above them on a phone; the curve below.

use widget_kit::layout::PlotHeight;
use widget_kit::scene::Scene;
use widget_kit::view::{Arrangement, Column, Row, SIDE_BY_SIDE, Slot, View};

use crate::w16_1_basin_explorer::model::panel;

/// Height of a map beside the sweeps: both maps together are as high as the sweeps alone, so nothing jumps as they
/// enter.
const BESIDE_PX: f32 = 140.0;
/// Height of the sweeps on a phone.
const PHONE_PX: f32 = 415.0;
/// Height of a map below the sweeps of a phone.
const BELOW_PX: f32 = 150.0;

/// The layout of the widget.
#[derive(Clone, Copy, Debug, Default)]
pub struct BasinView;

impl View for BasinView {
    fn arrange(&self, _scene: &Scene, width: f32) -> Arrangement {
        let sweeps = if width >= SIDE_BY_SIDE {
            slot(panel::SWEEPS, PlotHeight::Natural { most: 470.0 })
        } else {
            slot(panel::SWEEPS, PlotHeight::Fixed(PHONE_PX))
        };
        let mut columns = vec![Column {
            share: 1.5,
            slots: vec![sweeps],
        }];
        let mut rows = Vec::new();
        if width >= SIDE_BY_SIDE {
            columns.push(Column {
                share: 1.0,
                slots: maps(BESIDE_PX).to_vec(),
            });
        } else {
            rows.extend(maps(BELOW_PX).map(|map| Row::new(&[map])));
        }
        let curve = slot(panel::CURVE, PlotHeight::Fixed(120.0));
        Arrangement {
            stage: [vec![Row { columns }], rows].concat(),
            below: vec![Row::new(&[curve])],
        }
    }
}

fn slot(panel: &'static str, height: PlotHeight) -> Slot {
    Slot { panel, height }
}

fn maps(height: f32) -> [Slot; 2] {
    [panel::POINT, panel::PLANE].map(|id| slot(id, PlotHeight::Fixed(height)))
}
