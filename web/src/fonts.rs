//! Two small fonts instead of egui's default set, which is larger than all widgets together.
//!
//! The browser's own fonts draw missing characters. `web/fonts/README.md` documents the subset.

use std::sync::Arc;

use egui::{FontData, FontDefinitions, FontFamily};

/// The faces by preference: the page's typeface for labels, and one with the symbols that it lacks.
const FACES: [(&str, &[u8]); 2] = [
    (
        "Public Sans",
        include_bytes!("../fonts/public-sans/subset.ttf"),
    ),
    (
        "DejaVu Sans Condensed",
        include_bytes!("../fonts/dejavu/subset.ttf"),
    ),
];

/// Sets the subsets as the font of all texts.
pub fn install(ctx: &egui::Context) {
    let mut fonts = FontDefinitions::empty();
    for (name, data) in FACES {
        let data = Arc::new(FontData::from_static(data));
        fonts.font_data.insert(name.to_owned(), data);
    }
    let names = FACES.map(|(name, _)| name.to_owned());
    for family in [FontFamily::Proportional, FontFamily::Monospace] {
        fonts.families.insert(family, names.to_vec());
    }
    ctx.set_fonts(fonts);
}
