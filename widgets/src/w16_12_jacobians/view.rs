//! Layout of the panels: the four graphs over each other, and below them the curves that More opens.

use widget_kit::scene::Scene;
use widget_kit::view::{Arrangement, Row, SIDE_BY_SIDE, Slot};

use crate::w16_12_jacobians::model::panel;

/// The layout of the widget.
#[must_use]
pub fn arrange(_scene: &Scene, width: f32) -> Arrangement {
    let is_wide = width >= SIDE_BY_SIDE;
    let [graphs, curve] = if is_wide {
        [440.0, 290.0]
    } else {
        [500.0, 240.0]
    };
    Arrangement {
        stage: Row::each(&[if is_wide {
            Slot::natural(panel::GRAPHS, graphs)
        } else {
            Slot::fixed(panel::GRAPHS, graphs)
        }]),
        below: Row::each(&[Slot::fixed(panel::CURVE, curve)]),
    }
}
