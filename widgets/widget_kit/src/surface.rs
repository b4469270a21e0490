//! The interface for drawing: egui, SVG, print.
//!
//! Coordinates are logical pixels with y downwards. [`crate::draw`] uses only this trait, so the live and the
//! static picture share their code.

use crate::palette::Rgb;
use crate::scene::{Raster, Stroke};

/// A point in logical pixels, y downwards.
pub type Px = [f32; 2];

/// A rectangle in logical pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PxRect {
    /// Left edge.
    pub left: f32,
    /// Top edge.
    pub top: f32,
    /// Width.
    pub width: f32,
    /// Height.
    pub height: f32,
}

impl PxRect {
    /// The rectangle with that corner and size.
    #[must_use]
    pub fn new(left: f32, top: f32, width: f32, height: f32) -> Self {
        Self {
            left,
            top,
            width,
            height,
        }
    }

    /// Right edge.
    #[must_use]
    pub fn right(&self) -> f32 {
        self.left + self.width
    }

    /// Bottom edge.
    #[must_use]
    pub fn bottom(&self) -> f32 {
        self.top + self.height
    }

    /// Middle.
    #[must_use]
    pub fn center(&self) -> Px {
        [self.left + self.width / 2.0, self.top + self.height / 2.0]
    }

    /// The rectangle, larger by `by` on every side, or smaller if `by` is negative.
    #[must_use]
    pub fn grown(&self, by: f32) -> Self {
        let (width, height) = (self.width + 2.0 * by, self.height + 2.0 * by);
        Self::new(self.left - by, self.top - by, width, height)
    }

    /// Whether a point is inside or on the edge.
    #[must_use]
    pub fn contains(&self, at: Px) -> bool {
        (self.left..=self.right()).contains(&at[0]) && (self.top..=self.bottom()).contains(&at[1])
    }

    /// The rectangle at another position.
    #[must_use]
    pub fn moved(&self, by: Px) -> Self {
        Self::new(self.left + by[0], self.top + by[1], self.width, self.height)
    }
}

/// Horizontal alignment of a text to its anchor; vertically the anchor is always the middle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Align {
    /// The text runs to the right of the anchor.
    Left,
    /// The anchor is the middle.
    Center,
    /// The text ends at the anchor.
    Right,
}

/// Size of a text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TextSize {
    /// Tick labels and legends.
    Small,
    /// Titles of panels.
    Body,
}

impl TextSize {
    /// Height of the font in logical pixels.
    #[must_use]
    pub fn px(self) -> f32 {
        match self {
            TextSize::Small => 14.0,
            TextSize::Body => 15.0,
        }
    }
}

/// A line's colour, width and pattern.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pen {
    /// Colour.
    pub color: Rgb,
    /// Width in pixels.
    pub width: f32,
    /// Pattern.
    pub stroke: Stroke,
}

impl Pen {
    /// An unbroken line.
    #[must_use]
    pub fn solid(color: Rgb, width: f32) -> Self {
        Self {
            color,
            width,
            stroke: Stroke::Solid,
        }
    }

    /// Dash and gap in pixels; `None` for a solid line.
    #[must_use]
    pub fn dashes(&self) -> Option<(f32, f32)> {
        match self.stroke {
            Stroke::Solid => None,
            Stroke::Dashed => Some((6.0, 4.0)),
            Stroke::Dotted => Some((self.width.max(1.5), 3.5)),
        }
    }
}

/// Width of a text's halo beyond its letters, in pixels.
pub const HALO_WIDTH: f32 = 1.5;
/// Offsets of the copies of a text that form its halo.
const HALO: [[f32; 2]; 8] = [
    [1.0, 0.0],
    [0.7, 0.7],
    [0.0, 1.0],
    [-0.7, 0.7],
    [-1.0, 0.0],
    [-0.7, -0.7],
    [0.0, -1.0],
    [0.7, -0.7],
];

/// The colours of a text over data.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Haloed {
    /// Colour of the letters.
    pub ink: Rgb,
    /// Colour of the halo.
    pub halo: Rgb,
}

/// Measures text; separate from drawing, because layout comes first.
pub trait Measure {
    /// Width of a text on one line.
    fn text_width(&mut self, text: &str, size: TextSize) -> f32;
}

/// A drawing surface.
pub trait Surface: Measure {
    /// Clips what follows to that rectangle; `None` ends the clipping.
    fn clip(&mut self, rect: Option<PxRect>);

    /// An open line.
    fn line(&mut self, points: &[Px], pen: Pen);

    /// A filled convex polygon.
    fn polygon(&mut self, points: &[Px], fill: Rgb);

    /// The triangles between a point and a line around it, with the opacity of the fill at the point and at the line.
    fn fan(&mut self, from: Px, rim: &[Px], fill: Rgb, opacity: [f32; 2]);

    /// A disc, a ring, or both.
    fn circle(&mut self, center: Px, radius: f32, fill: Option<Rgb>, ring: Option<Pen>);

    /// A filled rectangle.
    fn rect(&mut self, rect: PxRect, fill: Rgb);

    /// A raster without smoothing; `key` identifies it among the rasters of the surface.
    fn raster(&mut self, rect: PxRect, raster: &Raster, key: &str);

    /// A text on one line.
    fn text(&mut self, at: Px, align: Align, text: &str, size: TextSize, color: Rgb);

    /// A text over data, with a halo for contrast.
    fn haloed_text(&mut self, at: Px, align: Align, text: &str, size: TextSize, colors: Haloed) {
        for [x, y] in HALO {
            let beside = [at[0] + HALO_WIDTH * x, at[1] + HALO_WIDTH * y];
            self.text(beside, align, text, size, colors.halo);
        }
        self.text(at, align, text, size, colors.ink);
    }

    /// The nearest coordinate at which a thin line is sharp.
    fn snap(&self, coordinate: f32) -> f32;
}
