//! Layout of the panels: the sweeps beside the two basin maps, or above them on a phone; the curve below.

use widget_kit::scene::Scene;
use widget_kit::view::{Arrangement, Row, SIDE_BY_SIDE, Slot};

use crate::w16_1_basin_explorer::model::panel;

/// Height of a map beside the sweeps: both maps together are as high as the sweeps alone, so nothing jumps as they
/// enter. The first is for a picture below [`NARROW_PX`], where their keys take a row more.
const BESIDE_PX: [f32; 2] = [76.5, 95.0];
const NARROW_PX: f32 = 600.0;
/// Height of the sweeps on a phone, alone and above a map: both are equally high with it.
const PHONE_PX: [f32; 2] = [500.0, 214.0];
/// Height of a map on a phone.
const BELOW_PX: f32 = 112.0;

/// The layout of the widget.
#[must_use]
pub fn arrange(scene: &Scene, width: f32) -> Arrangement {
    let curve = Slot::fixed(panel::CURVE, 120.0);
    if width >= SIDE_BY_SIDE {
        let sweeps = Slot::natural(panel::SWEEPS, 515.0);
        let beside_px = BESIDE_PX[usize::from(width >= NARROW_PX)];
        let maps = [panel::POINT, panel::PLANE].map(|id| Slot::fixed(id, beside_px));
        return Arrangement {
            stage: vec![Row::of_columns(&[(1.5, &[sweeps]), (1.0, &maps)])],
            below: Row::each(&[curve]),
        };
    }
    let has_sweeps = scene.panels.iter().any(|panel| panel.id == panel::SWEEPS);
    // One screen holds the sweeps, the map of the chosen variant and the controls.
    let is_map = |id: &&str| [panel::POINT, panel::PLANE].contains(id);
    let maps = scene.panels.iter().map(|panel| panel.id).filter(is_map);
    let mut stage: Vec<_> = maps.map(|id| Slot::fixed(id, BELOW_PX)).collect();
    let high = PHONE_PX[usize::from(!stage.is_empty())];
    let mut below = stage.split_off(stage.len().min(2 - usize::from(has_sweeps)));
    below.push(curve);
    stage.insert(0, Slot::fixed(panel::SWEEPS, high));
    Arrangement {
        stage: Row::each(&stage),
        below: Row::each(&below),
    }
}
