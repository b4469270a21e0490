//! Layout of the panels: the sweeps beside the two basin maps, or above them on a phone; the curve below.

use widget_kit::scene::Scene;
use widget_kit::view::{Arrangement, Row, SIDE_BY_SIDE, Slot};

use crate::w16_1_basin_explorer::model::panel;

/// Height of a map beside the sweeps: both maps together are as high as the sweeps alone, so nothing jumps as they
/// enter.
const BESIDE_PX: f32 = 140.0;
/// Height of the sweeps on a phone.
const PHONE_PX: f32 = 415.0;
/// Height of a map below the sweeps of a phone.
const BELOW_PX: f32 = 150.0;

/// The layout of the widget.
#[must_use]
pub fn arrange(_scene: &Scene, width: f32) -> Arrangement {
    let maps = |px| [panel::POINT, panel::PLANE].map(|id| Slot::fixed(id, px));
    let stage = if width >= SIDE_BY_SIDE {
        let sweeps = Slot::natural(panel::SWEEPS, 470.0);
        vec![Row::of_columns(&[
            (1.5, &[sweeps]),
            (1.0, &maps(BESIDE_PX)),
        ])]
    } else {
        let [point, plane] = maps(BELOW_PX);
        Row::each(&[Slot::fixed(panel::SWEEPS, PHONE_PX), point, plane])
    };
    Arrangement {
        stage,
        below: Row::each(&[Slot::fixed(panel::CURVE, 120.0)]),
    }
}
