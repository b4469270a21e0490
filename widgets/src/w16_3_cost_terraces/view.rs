//! Layout of the panels.

use widget_kit::layout::PlotHeight;
use widget_kit::scene::Scene;
use widget_kit::view::{Arrangement, Column, PANEL_GAP, Row, Slot, View};

/// Width from which a relief leaves space beside it, also if the controls are beside the stage.
const BESIDE: f32 = 640.0;

/// Width from which two reliefs are beside each other.
const PAIRED: f32 = 440.0;

/// Width and height of a relief: its steps have to be seen.
const MAP_PX: f32 = 350.0;
const PHONE_MAP_PX: f32 = 322.0;

/// Heights of a profile and of the sweep on a phone.
const PHONE_CUT_PX: f32 = 64.0;
const PHONE_MATCH_PX: f32 = 110.0;

/// Height of the sweep beside the profiles: with its legend it is as high as they are.
const LOW_MATCH_PX: f32 = 88.0;

/// Each relief beside the ground under its ball and the target of the match, the slices below.
#[derive(Clone, Copy, Debug, Default)]
pub struct TerracesView;

impl View for TerracesView {
    fn arrange(&self, _scene: &Scene, width: f32) -> Arrangement {
        let narrow = width < BESIDE;
        let px = |wide, phone| if narrow { phone } else { wide };
        let cut_px = match width {
            ..PAIRED => PHONE_CUT_PX,
            ..BESIDE => 90.0,
            _ => 110.0,
        };
        let most = px(MAP_PX, PHONE_MAP_PX);
        let map = |id| slot(id, PlotHeight::Natural { most });
        // Room and corridor have different shapes; fixed heights keep what is below in place.
        let matched = |id| slot(id, PlotHeight::Fixed(px(195.0, PHONE_MATCH_PX)));
        let cut = |id| slot(id, PlotHeight::Fixed(cut_px));
        let beside_icp = [cut("icp-path"), matched("sweep")];
        let beside_ndt = [cut("ndt-path"), matched("bells")];
        let below_each_other = |slots: &[Slot]| -> Vec<Row> {
            let rows = slots.iter().map(|slot| Row::new(&[*slot]));
            rows.collect()
        };
        let rest = [
            slot("information", PlotHeight::Fixed(300.0)),
            slot("rows", PlotHeight::Fixed(190.0)),
        ];
        let slices = [["icp-x", "icp-y"], ["ndt-x", "ndt-y"]].map(|pair| pair.map(cut));
        if (PAIRED..BESIDE).contains(&width) {
            // Beside the text a widget is low: both reliefs share a row, and the sweep stands beside the profiles.
            let stage = vec![
                Row::new(&[map("icp"), map("ndt")]),
                Row {
                    columns: vec![
                        column(0.35, vec![cut("icp-path")]),
                        column(0.35, vec![cut("ndt-path")]),
                        column(0.30, vec![slot("sweep", PlotHeight::Fixed(LOW_MATCH_PX))]),
                    ],
                },
            ];
            let below = [&[matched("bells")], &rest[..], slices.as_flattened()].concat();
            return Arrangement {
                stage,
                below: below_each_other(&below),
            };
        }
        if narrow {
            // NDT's profile and bells stand with the rest: two screens of a phone hold everything else.
            let below = [&beside_ndt[..], &rest, slices.as_flattened()].concat();
            return Arrangement {
                stage: below_each_other(&[
                    map("icp"),
                    cut("icp-path"),
                    matched("sweep"),
                    map("ndt"),
                ]),
                below: below_each_other(&below),
            };
        }
        let beside = |map: Slot, slots: [Slot; 2]| Row {
            columns: vec![
                column(MAP_PX, vec![map]),
                column(width - PANEL_GAP - MAP_PX, slots.to_vec()),
            ],
        };
        let stage = vec![
            beside(map("icp"), beside_icp),
            beside(map("ndt"), beside_ndt),
        ];
        let mut below = below_each_other(&rest);
        below.extend(slices.map(|pair| Row::new(&pair)));
        Arrangement { stage, below }
    }
}

fn column(share: f32, slots: Vec<Slot>) -> Column {
    Column { share, slots }
}

fn slot(panel: &'static str, height: PlotHeight) -> Slot {
    Slot { panel, height }
}
