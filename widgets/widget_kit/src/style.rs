//! egui's style from the palette: readable text, targets of 24 pixels and more.

use egui::{CornerRadius, FontFamily, FontId, Stroke, Style, TextStyle, Visuals, vec2};

use crate::egui_surface::color;
use crate::palette::{Theme, accent, mix, readable_on, tone};
use crate::scene::Tone;
use crate::surface::TextSize;

/// Smallest height of a control (WCAG 2.2, 2.5.8 requires 24).
pub const TARGET: f32 = 26.0;

/// The style of all widgets in a theme.
#[must_use]
pub fn style(theme: Theme) -> Style {
    let mut style = Style {
        visuals: visuals(theme),
        ..Style::default()
    };
    let font = |size: TextSize| FontId::new(size.px(), FontFamily::Proportional);
    style.text_styles = [
        (TextStyle::Small, font(TextSize::Small)),
        (TextStyle::Body, font(TextSize::Body)),
        (TextStyle::Button, font(TextSize::Body)),
        (TextStyle::Heading, font(TextSize::Title)),
        (TextStyle::Monospace, font(TextSize::Small)),
    ]
    .into();
    style.drag_value_text_style = TextStyle::Body;
    style.spacing.item_spacing = vec2(8.0, 6.0);
    style.spacing.button_padding = vec2(9.0, 4.0);
    style.spacing.interact_size = vec2(36.0, TARGET);
    style.spacing.icon_width = 18.0;
    style.spacing.icon_width_inner = 10.0;
    style.interaction.selectable_labels = false;
    style
}

fn visuals(theme: Theme) -> Visuals {
    let paper = tone(theme, Tone::Paper);
    let ink = tone(theme, Tone::Ink);
    let accent = accent(theme);
    let shade = |share: f32| color(mix(paper, ink, share));
    let mut visuals = match theme {
        Theme::Light => Visuals::light(),
        Theme::Dark => Visuals::dark(),
    };
    visuals.override_text_color = None;
    visuals.panel_fill = color(paper);
    visuals.window_fill = color(paper);
    visuals.window_stroke = Stroke::new(1.0, shade(0.3));
    visuals.extreme_bg_color = shade(0.04);
    visuals.faint_bg_color = shade(0.03);
    visuals.weak_text_color = Some(shade(0.75));
    visuals.hyperlink_color = color(accent);
    visuals.slider_trailing_fill = true;
    visuals.selection.bg_fill = color(accent);
    visuals.selection.stroke = Stroke::new(1.0, color(readable_on(accent)));

    let corner = CornerRadius::same(5);
    let widgets = &mut visuals.widgets;
    // Controls have a border with a contrast of 3:1 against paper (WCAG 2.2, 1.4.11).
    for (state, fill, border, width) in [
        (&mut widgets.noninteractive, 0.0, 0.18, 1.0),
        (&mut widgets.inactive, 0.07, 0.62, 1.0),
        (&mut widgets.hovered, 0.12, 0.8, 1.5),
        (&mut widgets.active, 0.2, 1.0, 1.5),
        (&mut widgets.open, 0.12, 0.8, 1.0),
    ] {
        // Rails and boxes use this fill, buttons the weak fill.
        state.bg_fill = shade(fill + 0.12);
        state.weak_bg_fill = shade(fill);
        state.bg_stroke = Stroke::new(width, shade(border));
        state.fg_stroke = Stroke::new(width.max(1.25), color(ink));
        state.corner_radius = corner;
        state.expansion = 0.0;
    }
    visuals
}

/// Colour of the focus ring.
#[must_use]
pub fn focus_color(theme: Theme) -> egui::Color32 {
    color(match theme {
        Theme::Light => [0x1d, 0x4e, 0xd8],
        Theme::Dark => [0xfd, 0xe0, 0x47],
    })
}
