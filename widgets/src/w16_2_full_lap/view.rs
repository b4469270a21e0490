//! Layout of the panels: the map, and below the controls the close-up of the loop and the plots over time.

use widget_kit::scene::Scene;
use widget_kit::view::{Arrangement, Row, SIDE_BY_SIDE, Slot};

/// Width from which the close-up and the plots are in three columns.
const THREE_COLUMNS: f32 = 860.0;

/// Largest height of the map, and its height on a phone, with room around the flat.
const MAP: Slot = Slot::natural("map", 640.0);
const MAP_NARROW: Slot = Slot::fixed("map", 580.0);
const LOOP: Slot = Slot::natural("loop", 280.0);
const ERRORS: Slot = plot("errors");
const DISAGREEMENT: Slot = plot("disagreement");
const GATE: Slot = plot("gate");
const STRAIN: Slot = plot("strain");

/// A plot over time.
const fn plot(panel: &'static str) -> Slot {
    Slot::fixed(panel, 130.0)
}

/// The layout of the widget: the map is the same with and without what More shows.
#[must_use]
pub fn arrange(scene: &Scene, width: f32) -> Arrangement {
    let is_wide = width >= SIDE_BY_SIDE;
    let map = if is_wide { MAP } else { MAP_NARROW };
    let below = if scene.panels.len() == 1 {
        Vec::new()
    } else if width >= THREE_COLUMNS {
        vec![Row::of_columns(&[
            (1.0, &[LOOP]),
            (1.0, &[ERRORS, DISAGREEMENT]),
            (1.0, &[GATE, STRAIN]),
        ])]
    } else if is_wide {
        vec![Row::of_columns(&[
            (1.0, &[LOOP, DISAGREEMENT]),
            (1.0, &[ERRORS, GATE, STRAIN]),
        ])]
    } else {
        Row::each(&[LOOP, ERRORS, DISAGREEMENT, GATE, STRAIN])
    };
    Arrangement {
        stage: Row::each(&[map]),
        below,
    }
}
