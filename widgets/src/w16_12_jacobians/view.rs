//! Layout of the panels: the four graphs over each other, the curves beside them.

use widget_kit::scene::Scene;
use widget_kit::view::{Arrangement, Row, SIDE_BY_SIDE, Slot};

use crate::w16_12_jacobians::model::panel;

/// Width from which the graphs are as high as they may be.
const BESIDE: f32 = 860.0;

/// The layout of the widget.
#[must_use]
pub fn arrange(_scene: &Scene, width: f32) -> Arrangement {
    let graphs = Slot::natural(panel::GRAPHS, 420.0);
    let curve = Slot::fixed(panel::CURVE, if width >= BESIDE { 380.0 } else { 290.0 });
    let stage = if width >= SIDE_BY_SIDE {
        vec![Row::of_columns(&[(1.2, &[graphs]), (1.0, &[curve])])]
    } else {
        Row::each(&[graphs, curve])
    };
    Arrangement {
        stage,
        below: Vec::new(),
    }
}
