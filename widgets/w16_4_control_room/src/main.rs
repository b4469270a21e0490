//! Opens the widget as a desktop window.

use std::error::Error;

fn main() -> Result<(), Box<dyn Error>> {
    Ok(kit::desktop::run(w16_4_control_room::widget())?)
}
