//! Layout of the panels: the graph beside χ² over its steps, the bars of the springs below.

use widget_kit::scene::Scene;
use widget_kit::view::{Arrangement, Row, SIDE_BY_SIDE, Slot};

use crate::w16_5_pose_graph_toy::model::panel;

/// The layout of the widget.
#[must_use]
pub fn arrange(_scene: &Scene, width: f32) -> Arrangement {
    let bars = Slot::fixed(panel::BARS, 150.0);
    let stage = if width >= SIDE_BY_SIDE {
        let graph = Slot::natural(panel::GRAPH, 420.0);
        let steps = Slot::fixed(panel::STEPS, 330.0);
        vec![Row::of_columns(&[(1.8, &[graph]), (1.0, &[steps])])]
    } else {
        let graph = Slot::natural(panel::GRAPH, 330.0);
        Row::each(&[graph, Slot::fixed(panel::STEPS, 150.0)])
    };
    Arrangement {
        stage,
        below: Row::each(&[bars]),
    }
}
