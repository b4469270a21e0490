//! egui's style from the palette, for the names of what the pointer is on.

use egui::{FontFamily, FontId, Stroke, Style, TextStyle, Visuals};

use crate::egui_surface::color;
use crate::palette::{Theme, mix, tone};
use crate::scene::Tone;
use crate::surface::TextSize;

/// The style of all widgets in a theme.
#[must_use]
pub fn style(theme: Theme) -> Style {
    let (paper, ink) = (tone(theme, Tone::Paper), tone(theme, Tone::Ink));
    let mut visuals = match theme {
        Theme::Light => Visuals::light(),
        Theme::Dark => Visuals::dark(),
    };
    visuals.override_text_color = Some(color(ink));
    visuals.window_fill = color(paper);
    visuals.window_stroke = Stroke::new(1.0, color(mix(paper, ink, 0.3)));
    let font = FontId::new(TextSize::Body.px(), FontFamily::Proportional);
    Style {
        visuals,
        text_styles: [(TextStyle::Body, font)].into(),
        ..Style::default()
    }
}
