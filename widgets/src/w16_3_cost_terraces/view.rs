//! Layout of the panels.

use widget_kit::layout::PlotHeight;
use widget_kit::scene::Scene;
use widget_kit::view::{Arrangement, Column, PANEL_GAP, Row, Slot, View};

/// Width from which the relief leaves space for the ground beside it.
const BESIDE: f32 = 440.0;

/// Width and height of the relief: its steps have to be seen.
const RELIEF_PX: f32 = 368.0;

/// Height of the ground beside the relief: with its axes it is as high.
const TALL_PX: f32 = 308.0;
const LOW_PX: f32 = 110.0;

/// The relief with the ground under its ball, the rest below.
#[derive(Clone, Copy, Debug, Default)]
pub struct TerracesView;

impl View for TerracesView {
    fn arrange(&self, _scene: &Scene, width: f32) -> Arrangement {
        let relief = slot("relief", PlotHeight::Natural { most: RELIEF_PX });
        let ground = |height| slot("path", PlotHeight::Fixed(height));
        let stage = if width < BESIDE {
            vec![Row::new(&[relief]), Row::new(&[ground(LOW_PX)])]
        } else {
            let column = |share, slot| Column {
                share,
                slots: vec![slot],
            };
            let map_px = RELIEF_PX.min(0.66 * width);
            vec![Row {
                columns: vec![
                    column(map_px, relief),
                    column(width - PANEL_GAP - map_px, ground(TALL_PX)),
                ],
            }]
        };
        // Room and corridor have different shapes; fixed heights keep what is below in place.
        let below = [
            ("sweep", 195.0),
            ("bells", 195.0),
            ("information", 300.0),
            ("rows", 190.0),
            ("slice-x", LOW_PX),
            ("slice-y", LOW_PX),
        ]
        .map(|(panel, px)| Row::new(&[slot(panel, PlotHeight::Fixed(px))]));
        Arrangement {
            stage,
            below: below.to_vec(),
        }
    }
}

fn slot(panel: &'static str, height: PlotHeight) -> Slot {
    Slot { panel, height }
}
