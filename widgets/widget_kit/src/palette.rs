//! The colours of each meaning, in light and dark.

use crate::model::Assessment;
use crate::scene::{RasterCell, Tone};

/// An opaque colour, sRGB.
pub type Rgb = [u8; 3];

/// The palette to use.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub enum Theme {
    /// Dark on white.
    #[default]
    Light,
    /// Light on near black.
    Dark,
}

/// Every colour by its name, `[light, dark]`; the report of a run and the styles of the page and of the element use the
/// same file. It belongs to the one of them that is published alone.
const COLORS: &[u8] = include_bytes!("../../../crates/robots/robot_io/palette.json");

/// The two shades of a colour of the file, looked up at compile time: `"name": ["#rrggbb", "#rrggbb"]`.
const fn shades(name: &str) -> [Rgb; 2] {
    let name = name.as_bytes();
    let mut start = 0;
    // A missing name ends in an index out of range, which does not compile.
    while !is_at(name, start) {
        start += 1;
    }
    let light = start + name.len() + b"\"\": [\"#".len();
    [rgb_at(light), rgb_at(light + b"rrggbb\", \"#".len())]
}

/// Whether the quoted name is at that position.
const fn is_at(name: &[u8], start: usize) -> bool {
    let mut at = 0;
    while at < name.len() && COLORS[start + 1 + at] == name[at] {
        at += 1;
    }
    at == name.len() && COLORS[start] == b'"' && COLORS[start + 1 + at] == b'"'
}

const fn rgb_at(start: usize) -> Rgb {
    [byte_at(start), byte_at(start + 2), byte_at(start + 4)]
}

const fn byte_at(at: usize) -> u8 {
    const fn digit(of: u8) -> u8 {
        match of {
            b'0'..=b'9' => of - b'0',
            b'a'..=b'f' => of - b'a' + 10,
            _ => panic!("a colour is #rrggbb in small letters"),
        }
    }
    16 * digit(COLORS[at]) + digit(COLORS[at + 1])
}

/// What stands beside its like in one picture and is none of the meanings.
const SERIES: [[Rgb; 2]; 4] = [
    shades("series-1"),
    shades("series-2"),
    shades("series-3"),
    shades("series-4"),
];

/// Classes differ mainly in lightness, which keeps them distinct for every kind of colour vision. All but
/// the sixth are areas below marks: they differ from the colours of the meanings and from paper.
const CLASSES: [[Rgb; 2]; 7] = [
    shades("class-1"),
    shades("class-2"),
    shades("class-3"),
    shades("class-4"),
    shades("class-5"),
    shades("class-6"),
    shades("class-7"),
];

/// The shade of a meaning in a theme.
#[must_use]
pub fn tone(theme: Theme, tone: Tone) -> Rgb {
    let shades = match tone {
        Tone::Prior => const { shades("prior") },
        Tone::Prediction => const { shades("prediction") },
        Tone::Measurement => const { shades("measurement") },
        Tone::Outbound => const { shades("outbound") },
        Tone::Revisit => const { shades("revisit") },
        Tone::Strained => const { shades("strained") },
        Tone::Posterior => const { shades("posterior") },
        Tone::Truth => const { shades("truth") },
        Tone::Ink => const { shades("ink") },
        Tone::Faint => const { shades("faint") },
        Tone::Paper => const { shades("paper") },
        Tone::Unseen => {
            return mix(
                self::tone(theme, Tone::Paper),
                self::tone(theme, Tone::Faint),
                0.5,
            );
        }
        Tone::Class(class) => CLASSES[usize::from(class) % CLASSES.len()],
        Tone::Series(n) => SERIES[usize::from(n) % SERIES.len()],
        Tone::Level(level) => return level_color(f32::from(level) / 255.0),
    };
    shades[theme as usize]
}

/// The floor of a plan.
#[must_use]
pub fn floor(theme: Theme) -> Rgb {
    const SHADES: [Rgb; 2] = shades("floor");
    SHADES[theme as usize]
}

/// The walls of a plan.
#[must_use]
pub fn wall(theme: Theme) -> Rgb {
    const SHADES: [Rgb; 2] = shades("wall");
    SHADES[theme as usize]
}

/// The line around the walls of a plan.
#[must_use]
pub fn wall_edge(theme: Theme) -> Rgb {
    const SHADES: [Rgb; 2] = shades("wall-edge");
    SHADES[theme as usize]
}

/// The colour of a correspondence by its length, 0…1.
#[must_use]
pub fn thread(theme: Theme, share: f32) -> Rgb {
    const SHADES: [[Rgb; 2]; 5] = [
        shades("thread-1"),
        shades("thread-2"),
        shades("thread-3"),
        shades("thread-4"),
        shades("thread-5"),
    ];
    let last = SHADES.len() - 1;
    let place = share.clamp(0.0, 1.0) * last as f32;
    let below = (place as usize).min(last - 1);
    mix(
        SHADES[below][theme as usize],
        SHADES[below + 1][theme as usize],
        place - below as f32,
    )
}

/// The colour of interactive controls.
#[must_use]
pub fn accent(theme: Theme) -> Rgb {
    const SHADES: [Rgb; 2] = shades("accent");
    SHADES[theme as usize]
}

/// Largest share of white or black in the colour of a relief's slope.
const MAX_LIGHT: f32 = 0.55;

/// The colour of a raster's cell.
#[must_use]
pub fn cell(theme: Theme, cell: RasterCell) -> Rgb {
    match cell {
        RasterCell::Unknown => tone(theme, Tone::Unseen),
        RasterCell::Level(level) => level_color(level),
        RasterCell::Relief { level, light } => {
            let lit = if light > 0.0 { [255; 3] } else { [0; 3] };
            mix(level_color(level), lit, MAX_LIGHT * light.abs())
        }
        RasterCell::Class(class) => tone(theme, Tone::Class(class)),
        RasterCell::Occupancy(share) => {
            mix(tone(theme, Tone::Paper), tone(theme, Tone::Ink), share)
        }
    }
}

/// A perceptual colour map from dark blue over teal to pale yellow, with even steps of lightness.
///
/// Six anchors with CIE lightness 15, 30, 45, 60, 75, 92, interpolated linearly.
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

/// The colour of a verdict; a shape and a word always accompany it.
#[must_use]
pub fn standing(theme: Theme, standing: Assessment) -> Rgb {
    let shades = match standing {
        Assessment::Good => const { shades("good") },
        Assessment::Bad => const { shades("bad") },
        Assessment::Doubtful => const { shades("fair") },
        Assessment::Neutral => return tone(theme, Tone::Truth),
    };
    shades[theme as usize]
}

/// Black or white, whichever has more contrast on that colour.
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

/// One channel of sRGB in linear light, 0…1.
fn linear(channel: u8) -> f32 {
    let share = f32::from(channel) / 255.0;
    if share <= 0.040_45 {
        share / 12.92
    } else {
        ((share + 0.055) / 1.055).powf(2.4)
    }
}

/// Linear interpolation: `a` at 0, `b` at 1.
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
