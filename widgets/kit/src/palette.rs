//! The colours of each meaning, in light and dark.

use crate::model::Standing;
use crate::scene::{Cell, Tone};

/// An opaque colour, sRGB.
pub type Rgb = [u8; 3];

/// Which palette.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub enum Theme {
    /// Dark on white.
    #[default]
    Light,
    /// Light on near black.
    Dark,
}

/// The shade of a meaning in a theme.
#[must_use]
pub fn tone(theme: Theme, tone: Tone) -> Rgb {
    match (theme, tone) {
        (_, Tone::Prior) => hex(0x3b82f6),
        (Theme::Light, Tone::Prediction) => hex(0xea580c),
        (Theme::Dark, Tone::Prediction) => hex(0xf97316),
        (Theme::Light, Tone::Measurement) => hex(0x166534),
        (Theme::Dark, Tone::Measurement) => hex(0x86efac),
        (Theme::Light, Tone::Revisit) => hex(0x3ca860),
        (Theme::Dark, Tone::Revisit) => hex(0x247848),
        (Theme::Light, Tone::Posterior) => hex(0x581c87),
        (Theme::Dark, Tone::Posterior) => hex(0xf0abfc),
        (Theme::Light, Tone::Truth) => hex(0x6b7280),
        (Theme::Dark, Tone::Truth) => hex(0x94a3b8),
        (Theme::Light, Tone::Ink) => hex(0x1f2937),
        (Theme::Dark, Tone::Ink) => hex(0xe5e7eb),
        (Theme::Light, Tone::Faint) => hex(0xd7dbe1),
        (Theme::Dark, Tone::Faint) => hex(0x374151),
        (Theme::Light, Tone::Paper) => hex(0xffffff),
        (Theme::Dark, Tone::Paper) => hex(0x14181f),
        (theme, Tone::Unseen) => mix(
            self::tone(theme, Tone::Paper),
            self::tone(theme, Tone::Faint),
            0.5,
        ),
        (theme, Tone::Class(class)) => class_color(theme, class),
        (_, Tone::Level(level)) => level_color(f32::from(level) / 255.0),
    }
}

/// Classes differ in lightness first, so that they stay apart for every kind of colour vision. The
/// first four are areas below marks: they are none of the meanings' colours, nor paper.
fn class_color(theme: Theme, class: u8) -> Rgb {
    const LIGHT: [u32; 6] = [0xd6e8fb, 0xf2d84b, 0x772a67, 0x889abf, 0x48a181, 0x1e293b];
    const DARK: [u32; 6] = [0x113460, 0xe8d84a, 0x9c4b55, 0x6c7aa8, 0x2a9d8f, 0xf8fafc];
    let table = match theme {
        Theme::Light => LIGHT,
        Theme::Dark => DARK,
    };
    hex(table[usize::from(class) % table.len()])
}

/// The colour of a raster's cell.
#[must_use]
pub fn cell(theme: Theme, cell: Cell) -> Rgb {
    match cell {
        Cell::Unknown => tone(theme, Tone::Unseen),
        Cell::Level(level) => level_color(level),
        Cell::Class(class) => class_color(theme, class),
        Cell::Occupancy(share) => mix(tone(theme, Tone::Paper), tone(theme, Tone::Ink), share),
    }
}

/// A perceptual map: lightness rises evenly from dark blue over teal to pale yellow.
///
/// Six anchors whose CIE lightness is 15, 30, 45, 60, 75, 92, mixed linearly in between.
#[must_use]
pub fn level_color(level: f32) -> Rgb {
    const ANCHORS: [u32; 6] = [0x1b1f5c, 0x254a86, 0x1c7691, 0x35a08c, 0x86c56f, 0xf4ec8a];
    if level.is_nan() {
        return hex(0x808080);
    }
    let place = level.clamp(0.0, 1.0) * (ANCHORS.len() - 1) as f32;
    let below = (place as usize).min(ANCHORS.len() - 2);
    mix(
        hex(ANCHORS[below]),
        hex(ANCHORS[below + 1]),
        place - below as f32,
    )
}

/// The colour of a verdict; a shape and a word always go with it.
#[must_use]
pub fn standing(theme: Theme, standing: Standing) -> Rgb {
    match (theme, standing) {
        (Theme::Light, Standing::Good) => hex(0x15803d),
        (Theme::Dark, Standing::Good) => hex(0x4ade80),
        (Theme::Light, Standing::Bad) => hex(0xb91c1c),
        (Theme::Dark, Standing::Bad) => hex(0xfca5a5),
        (theme, Standing::Neutral) => tone(theme, Tone::Truth),
    }
}

/// Black or white, whichever reads better on that colour.
#[must_use]
pub fn readable_on(back: Rgb) -> Rgb {
    const BLACK: Rgb = [0; 3];
    const WHITE: Rgb = [255; 3];
    if contrast(back, BLACK) >= contrast(back, WHITE) {
        BLACK
    } else {
        WHITE
    }
}

/// Contrast ratio of two colours, 1…21: `(L₁ + 0.05)/(L₂ + 0.05)` (WCAG 2.2).
#[must_use]
pub fn contrast(a: Rgb, b: Rgb) -> f32 {
    let (a, b) = (luminance(a) + 0.05, luminance(b) + 0.05);
    if a > b { a / b } else { b / a }
}

/// Relative luminance, 0…1 (WCAG 2.2).
fn luminance(color: Rgb) -> f32 {
    let [r, g, b] = color.map(linear);
    0.2126 * r + 0.7152 * g + 0.0722 * b
}

/// One channel of sRGB as light, 0…1.
fn linear(channel: u8) -> f32 {
    let share = f32::from(channel) / 255.0;
    if share <= 0.040_45 {
        share / 12.92
    } else {
        ((share + 0.055) / 1.055).powf(2.4)
    }
}

/// `a` at 0, `b` at 1.
#[must_use]
pub fn mix(a: Rgb, b: Rgb, share: f32) -> Rgb {
    let share = share.clamp(0.0, 1.0);
    core::array::from_fn(|i| {
        let (from, to) = (f32::from(a[i]), f32::from(b[i]));
        (from + (to - from) * share).round() as u8
    })
}

const fn hex(rgb: u32) -> Rgb {
    [(rgb >> 16) as u8, (rgb >> 8) as u8, rgb as u8]
}
