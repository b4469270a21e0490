//! Layout of the panels: the large map, the close-up of the loop and the errors beside or below it.

use widget_kit::scene::Scene;
use widget_kit::view::{Arrangement, Row, SIDE_BY_SIDE, Slot};

/// Width from which the close-up is beside the map.
const BESIDE_THE_MAP: f32 = 860.0;

/// Largest height of the map while the flat is drawn on it, and its height on a phone, with room around the flat.
const DRAWN: f32 = 640.0;
const DRAWN_NARROW: f32 = 580.0;

const MAP: Slot = Slot::natural("map", 450.0);
const LOOP: Slot = Slot::natural("loop", 280.0);
const ERRORS: Slot = plot("errors");
const DISAGREEMENT: Slot = plot("disagreement");
const GATE: Slot = plot("gate");
const STRAIN: Slot = plot("strain");

/// A plot over time.
const fn plot(panel: &'static str) -> Slot {
    Slot::fixed(panel, 130.0)
}

/// The layout of the widget.
#[must_use]
pub fn arrange(scene: &Scene, width: f32) -> Arrangement {
    if let [map] = &scene.panels[..] {
        let map = if width >= SIDE_BY_SIDE {
            Slot::natural(map.id, DRAWN)
        } else {
            Slot::fixed(map.id, DRAWN_NARROW)
        };
        return Arrangement {
            stage: Row::each(&[map]),
            below: Vec::new(),
        };
    }
    if width >= BESIDE_THE_MAP {
        Arrangement {
            stage: vec![Row::of_columns(&[(2.0, &[MAP]), (1.0, &[LOOP, ERRORS])])],
            below: vec![Row::new(&[DISAGREEMENT, GATE, STRAIN])],
        }
    } else if width >= SIDE_BY_SIDE {
        let columns: [(f32, &[Slot]); 2] =
            [(1.0, &[LOOP, DISAGREEMENT]), (1.0, &[ERRORS, GATE, STRAIN])];
        Arrangement {
            stage: Row::each(&[MAP]),
            below: vec![Row::of_columns(&columns)],
        }
    } else {
        // On a phone the flat is low: the close-up takes the rest of the screen.
        Arrangement {
            stage: Row::each(&[MAP, LOOP]),
            below: Row::each(&[ERRORS, DISAGREEMENT, GATE, STRAIN]),
        }
    }
}
