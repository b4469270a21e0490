//! Opens the widget as a desktop window.

#[cfg(not(target_arch = "wasm32"))]
fn main() -> Result<(), Box<dyn std::error::Error>> {
    Ok(kit::desktop::run(w16_5_pose_graph_toy::widget())?)
}

#[cfg(target_arch = "wasm32")]
fn main() {}
