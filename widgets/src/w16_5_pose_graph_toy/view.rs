//! Layout of the panels: the graph, on a phone with the bars of its springs; χ² over the steps below.

use widget_kit::scene::Scene;
use widget_kit::view::{Arrangement, Row, SIDE_BY_SIDE, Slot};

use crate::w16_5_pose_graph_toy::model::panel;

/// The layout of the widget.
#[must_use]
pub fn arrange(_scene: &Scene, width: f32) -> Arrangement {
    let [steps, bars] = [panel::STEPS, panel::BARS].map(|plot| Slot::fixed(plot, 150.0));
    if width >= SIDE_BY_SIDE {
        return Arrangement {
            stage: Row::each(&[Slot::natural(panel::GRAPH, 400.0)]),
            below: Row::each(&[bars, steps]),
        };
    }
    Arrangement {
        stage: Row::each(&[Slot::natural(panel::GRAPH, 330.0), bars]),
        below: Row::each(&[steps]),
    }
}
