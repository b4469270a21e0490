//! Opens the widget as a desktop window.

#[cfg(not(target_arch = "wasm32"))]
fn main() -> Result<(), Box<dyn std::error::Error>> {
    Ok(kit::desktop::run(w16_9_come_back::widget())?)
}

#[cfg(target_arch = "wasm32")]
fn main() {}
