//! A small font instead of egui's default set, which is larger than all widgets together.
//!
//! The browser's own fonts draw missing characters. `web/fonts/README.md` documents the subset.

use std::sync::Arc;

use egui::{FontData, FontDefinitions, FontFamily};

const NAME: &str = "DejaVu Sans Condensed (subset)";

/// Sets the subset as the font of all texts.
pub fn install(ctx: &egui::Context) {
    let data = FontData::from_static(include_bytes!("../fonts/dejavu-sans-condensed-subset.ttf"));
    let mut fonts = FontDefinitions::empty();
    fonts.font_data.insert(NAME.to_owned(), Arc::new(data));
    for family in [FontFamily::Proportional, FontFamily::Monospace] {
        fonts.families.insert(family, vec![NAME.to_owned()]);
    }
    ctx.set_fonts(fonts);
}
