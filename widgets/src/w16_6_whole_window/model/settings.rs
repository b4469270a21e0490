//! Converts the values of the parameters to the types of the core.

use ch16_lab::basin::BasinStart;
use ch16_lab::whole_window::WindowConfig;
use widget_kit::values::Values;

use crate::w16_6_whole_window::spec::{CELL, DX, DY, HEADING, TURN, WINDOW};

/// What is searched, and from where.
pub fn config(values: &Values) -> WindowConfig {
    WindowConfig {
        start: BasinStart {
            heading_deg: values.get(&HEADING),
            dx_m: values.get(&DX),
            dy_m: values.get(&DY),
        },
        half_width_m: values.get(&WINDOW),
        half_turn_deg: values.get(&TURN),
        cell_m: values.get(&CELL),
    }
}
