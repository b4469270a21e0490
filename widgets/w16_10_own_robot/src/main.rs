//! Opens the widget as a desktop window; its worker lives in a browser, so no log is read here.

#[cfg(not(target_arch = "wasm32"))]
fn main() -> Result<(), Box<dyn std::error::Error>> {
    Ok(kit::desktop::run(w16_10_own_robot::widget())?)
}

#[cfg(target_arch = "wasm32")]
fn main() {}
