//! Layout of the panels: the large map, the close-up of the loop and the errors beside or below it.

use widget_kit::layout::PlotHeight;
use widget_kit::scene::Scene;
use widget_kit::view::{Arrangement, Column, Row, SIDE_BY_SIDE, Slot, View};

/// Width from which the close-up is beside the map.
const BESIDE_THE_MAP: f32 = 860.0;

/// Largest height of the map while the flat is drawn on it, and its height on a phone, with room around the flat.
const DRAWN: f32 = 640.0;
const DRAWN_NARROW: f32 = 580.0;

/// Height of a plot over time.
const PLOT: PlotHeight = PlotHeight::Fixed(130.0);

const MAP: Slot = Slot {
    panel: "map",
    height: PlotHeight::Natural { most: 450.0 },
};

const LOOP: Slot = Slot {
    panel: "loop",
    height: PlotHeight::Natural { most: 280.0 },
};

const ERRORS: Slot = plot("errors");
const DISAGREEMENT: Slot = plot("disagreement");
const GATE: Slot = plot("gate");
const STRAIN: Slot = plot("strain");

const fn plot(panel: &'static str) -> Slot {
    Slot {
        panel,
        height: PLOT,
    }
}

/// The arrangement of w16.2.
#[derive(Clone, Copy, Debug, Default)]
pub struct FullLapView;

impl View for FullLapView {
    fn arrange(&self, scene: &Scene, width: f32) -> Arrangement {
        if let [map] = &scene.panels[..] {
            let height = if width >= SIDE_BY_SIDE {
                PlotHeight::Natural { most: DRAWN }
            } else {
                PlotHeight::Fixed(DRAWN_NARROW)
            };
            let panel = map.id;
            return Arrangement {
                stage: vec![Row::new(&[Slot { panel, height }])],
                ..Arrangement::default()
            };
        }
        if width >= BESIDE_THE_MAP {
            Arrangement {
                stage: vec![Row {
                    columns: vec![column(2.0, &[MAP]), column(1.0, &[LOOP, ERRORS])],
                }],
                below: vec![Row::new(&[DISAGREEMENT, GATE, STRAIN])],
            }
        } else if width >= SIDE_BY_SIDE {
            Arrangement {
                stage: vec![Row::new(&[MAP])],
                below: vec![Row {
                    columns: vec![
                        column(1.0, &[LOOP, DISAGREEMENT]),
                        column(1.0, &[ERRORS, GATE, STRAIN]),
                    ],
                }],
            }
        } else {
            // On a phone the flat is low: the close-up takes the rest of the screen.
            let below = [ERRORS, DISAGREEMENT, GATE, STRAIN];
            Arrangement {
                stage: vec![Row::new(&[MAP]), Row::new(&[LOOP])],
                below: below.iter().map(|slot| Row::new(&[*slot])).collect(),
            }
        }
    }
}

fn column(share: f32, slots: &[Slot]) -> Column {
    Column {
        share,
        slots: slots.to_vec(),
    }
}
