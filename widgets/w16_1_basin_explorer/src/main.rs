//! Opens the basin explorer as a desktop window.

#[cfg(not(target_arch = "wasm32"))]
fn main() -> eframe::Result {
    kit::desktop::run(w16_1_basin_explorer::widget())
}

#[cfg(target_arch = "wasm32")]
fn main() {}
