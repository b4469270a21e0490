//! Layout of the panels.

use widget_kit::scene::Scene;
use widget_kit::view::{Arrangement, PANEL_GAP, Row, Slot};

/// Width from which the relief leaves space for the ground beside it.
const BESIDE: f32 = 440.0;

/// Width and height of the relief: its steps have to be seen.
const RELIEF_PX: f32 = 368.0;

/// Height of the ground beside the relief: with its axes it is as high.
const TALL_PX: f32 = 308.0;
const LOW_PX: f32 = 110.0;

/// The layout of the widget.
#[must_use]
pub fn arrange(_scene: &Scene, width: f32) -> Arrangement {
    let relief = Slot::natural("relief", RELIEF_PX);
    let ground = |px| Slot::fixed("path", px);
    let stage = if width < BESIDE {
        Row::each(&[relief, ground(LOW_PX)])
    } else {
        let map_px = RELIEF_PX.min(0.66 * width);
        let ground_px = width - PANEL_GAP - map_px;
        let columns: [(f32, &[Slot]); 2] = [(map_px, &[relief]), (ground_px, &[ground(TALL_PX)])];
        vec![Row::of_columns(&columns)]
    };
    // Room and corridor have different shapes; fixed heights keep what is below in place.
    let below = [
        ("sweep", 195.0),
        ("bells", 195.0),
        ("information", 300.0),
        ("rows", 190.0),
        ("slice-x", LOW_PX),
        ("slice-y", LOW_PX),
    ];
    Arrangement {
        stage,
        below: Row::each(&below.map(|(panel, px)| Slot::fixed(panel, px))),
    }
}
