//! What the values of the parameter list mean to the core.

use ch16_lab::basin::BasinStart;
use ch16_lab::whole_window::WindowConfig;
use kit::values::Values;

/// What is searched, and from where.
pub fn config(values: &Values) -> WindowConfig {
    WindowConfig {
        start: BasinStart {
            heading_deg: values.get("heading"),
            dx_m: values.get("dx"),
            dy_m: values.get("dy"),
        },
        half_width_m: values.get("window"),
        half_turn_deg: values.get("turn"),
        cell_m: values.get("cell"),
    }
}
