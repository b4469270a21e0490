//! Layout of the panels: the graph; below it χ² over the steps, and the bars of the springs.

use widget_kit::scene::Scene;
use widget_kit::view::{Arrangement, Row, SIDE_BY_SIDE, Slot};

use crate::w16_5_pose_graph_toy::model::panel;

/// The layout of the widget.
#[must_use]
pub fn arrange(_scene: &Scene, width: f32) -> Arrangement {
    let graph_px = if width >= SIDE_BY_SIDE { 400.0 } else { 330.0 };
    let below = [
        Slot::fixed(panel::STEPS, 150.0),
        Slot::fixed(panel::BARS, 150.0),
    ];
    Arrangement {
        stage: Row::each(&[Slot::natural(panel::GRAPH, graph_px)]),
        below: Row::each(&below),
    }
}
