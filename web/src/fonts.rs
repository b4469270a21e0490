//! One small font in place of egui's default set, which weighs more than all widgets together.
//!
//! What the font lacks is drawn by the browser's own fonts. `web/fonts/README.md` says how the
//! subset was made.

use std::sync::Arc;

use egui::{FontData, FontDefinitions, FontFamily};

const NAME: &str = "DejaVu Sans Condensed (subset)";

/// Makes the subset the font of every text.
pub fn install(ctx: &egui::Context) {
    let data = FontData::from_static(include_bytes!("../fonts/dejavu-sans-condensed-subset.ttf"));
    let mut fonts = FontDefinitions::empty();
    fonts.font_data.insert(NAME.to_owned(), Arc::new(data));
    for family in [FontFamily::Proportional, FontFamily::Monospace] {
        fonts.families.insert(family, vec![NAME.to_owned()]);
    }
    ctx.set_fonts(fonts);
}
