//! Helpers for the tests of the widget's model.

use widget_kit::model::Model;
use widget_kit::scene::{Layer, RasterCell};
use widgets::w16_1_basin_explorer::model::BasinExplorer;

use crate::support::panel_of;

pub fn with(values: &[(&str, f64)]) -> BasinExplorer {
    let mut model = BasinExplorer::default();
    for (id, value) in values {
        model.set(id, *value).expect("a value of the range");
    }
    model
}

/// Fills the maps, which "More" shows. Returns the pieces of work.
pub fn fill(model: &mut BasinExplorer) -> usize {
    model.set("more", 1.0).expect("a switch");
    let mut pieces = 1;
    while model.work().is_busy() {
        pieces += 1;
    }
    pieces
}

/// The class under a spot of a basin map.
pub fn class_at(model: &BasinExplorer, id: &str, at: [f64; 2]) -> RasterCell {
    let panel = panel_of(model, id);
    let raster = panel.layers.iter().find_map(|layer| match layer {
        Layer::Raster(raster) => Some(raster),
        _ => None,
    });
    let raster = raster.expect("a basin map has a raster");
    let size = raster.bounds.size();
    let cell =
        |i: usize, count: usize| ((at[i] - raster.bounds.min[i]) / size[i] * count as f64) as usize;
    raster.cells[cell(1, raster.rows) * raster.columns + cell(0, raster.columns)]
}
