//! Layout of the panels.

use kit::layout::PlotHeight;
use kit::scene::Scene;
use kit::view::{Arrangement, Column, Row, Slot, View};

/// Width from which a map leaves space beside it, also if the controls are beside the stage.
const BESIDE: f32 = 440.0;

/// Share of its row that the map takes; the target of the match gets the rest.
const MAP_SHARE: f32 = 5.0;
const MATCHED_SHARE: f32 = 4.0;

/// Each map beside the target of the match, the slices below.
#[derive(Clone, Copy, Debug, Default)]
pub struct TerracesView;

impl View for TerracesView {
    fn arrange(&self, _scene: &Scene, width: f32) -> Arrangement {
        let narrow = width < BESIDE;
        // Four panels below each other have to fit two screens of a phone.
        let most = if narrow { 205.0 } else { 235.0 };
        let map = |id| slot(id, PlotHeight::Natural { most });
        // Room and corridor have different shapes; fixed heights keep what is below in place.
        let matched = |id| slot(id, PlotHeight::Fixed(if narrow { 120.0 } else { 190.0 }));
        let cut = |id| slot(id, PlotHeight::Fixed(130.0));
        let stage = [
            [map("icp"), matched("sweep")],
            [map("ndt"), matched("bells")],
        ];
        let slices = [["icp-x", "icp-y"], ["ndt-x", "ndt-y"]].map(|pair| pair.map(cut));
        let rests = slot("information", PlotHeight::Fixed(300.0));
        let side_by_side = |slots: [Slot; 2], shares: [f32; 2]| Row {
            columns: (slots.into_iter().zip(shares))
                .map(|(slot, share)| Column {
                    share,
                    slots: vec![slot],
                })
                .collect(),
        };
        let rows = |pairs: [[Slot; 2]; 2], shares: [f32; 2]| -> Vec<Row> {
            if narrow {
                pairs
                    .iter()
                    .flatten()
                    .map(|slot| Row::new(&[*slot]))
                    .collect()
            } else {
                let pairs = pairs.into_iter();
                pairs.map(|pair| side_by_side(pair, shares)).collect()
            }
        };
        let rows_of_h = slot("rows", PlotHeight::Fixed(190.0));
        let mut below = vec![Row::new(&[rests]), Row::new(&[rows_of_h])];
        below.extend(rows(slices, [1.0, 1.0]));
        Arrangement {
            stage: rows(stage, [MAP_SHARE, MATCHED_SHARE]),
            below,
        }
    }
}

fn slot(panel: &'static str, height: PlotHeight) -> Slot {
    Slot { panel, height }
}
