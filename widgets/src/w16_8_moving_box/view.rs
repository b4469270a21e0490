//! Layout of the panels: the three registrations side by side, the curves below them.

use kit::layout::PlotHeight;
use kit::scene::Scene;
use kit::view::{Arrangement, Row, SIDE_BY_SIDE, Slot, View};

use crate::w16_8_moving_box::model::panel;

/// The layout of the widget.
#[derive(Clone, Copy, Debug, Default)]
pub struct BoxView;

impl View for BoxView {
    fn arrange(&self, _scene: &Scene, width: f32) -> Arrangement {
        let slot = |panel, height| Slot { panel, height };
        // Four panels below each other have to fit two screens of a phone.
        let [most, plot] = if width >= SIDE_BY_SIDE {
            [270.0, 170.0]
        } else {
            [190.0, 130.0]
        };
        let sweeps = panel::SWEEPS.map(|panel| slot(panel, PlotHeight::Natural { most }));
        let bias = slot(panel::BIAS, PlotHeight::Fixed(plot));
        let mut stage = if width >= SIDE_BY_SIDE {
            vec![Row::new(&sweeps)]
        } else {
            sweeps.iter().map(|slot| Row::new(&[*slot])).collect()
        };
        stage.push(Row::new(&[bias]));
        Arrangement {
            stage,
            below: Vec::new(),
        }
    }
}
