//! What a picture is drawn on: egui, SVG, print.
//!
//! Coordinates are logical pixels with y downwards. [`crate::draw`] speaks only to this trait, so
//! the live picture and the static one come from the same code.

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

    /// The rectangle that reaches `by` farther on every side, or less far where that is negative.
    #[must_use]
    pub fn grown(&self, by: f32) -> Self {
        let (width, height) = (self.width + 2.0 * by, self.height + 2.0 * by);
        Self::new(self.left - by, self.top - by, width, height)
    }

    /// Whether a point lies in it, edges included.
    #[must_use]
    pub fn contains(&self, at: Px) -> bool {
        (self.left..=self.right()).contains(&at[0]) && (self.top..=self.bottom()).contains(&at[1])
    }

    /// The same rectangle elsewhere.
    #[must_use]
    pub fn moved(&self, by: Px) -> Self {
        Self::new(self.left + by[0], self.top + by[1], self.width, self.height)
    }
}

/// Which side of a text lies at its anchor; vertically the anchor is always the middle.
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
    /// Titles of widgets.
    Title,
}

impl TextSize {
    /// Height of the font in logical pixels.
    #[must_use]
    pub fn px(self) -> f32 {
        match self {
            TextSize::Small => 12.0,
            TextSize::Body => 14.0,
            TextSize::Title => 20.0,
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

    /// Dash and gap in pixels, where the line is broken.
    #[must_use]
    pub fn dashes(&self) -> Option<(f32, f32)> {
        match self.stroke {
            Stroke::Solid => None,
            Stroke::Dashed => Some((6.0, 4.0)),
            Stroke::Dotted => Some((self.width.max(1.5), 3.5)),
        }
    }
}

/// Reach of a text's halo beyond its letters, in pixels.
pub const HALO_WIDTH: f32 = 1.5;
/// Where copies of a text stand that together make its halo.
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
    /// Of the letters.
    pub ink: Rgb,
    /// Around them.
    pub halo: Rgb,
}

/// Measures text; apart from drawing, because layout comes first.
pub trait Measure {
    /// Width of a text on one line.
    fn text_width(&mut self, text: &str, size: TextSize) -> f32;
}

/// Something to draw on.
pub trait Surface: Measure {
    /// What follows is cut to that rectangle; `None` lifts the cut.
    fn clip(&mut self, rect: Option<PxRect>);

    /// An open line.
    fn line(&mut self, points: &[Px], pen: Pen);

    /// A filled convex polygon.
    fn polygon(&mut self, points: &[Px], fill: Rgb);

    /// A disc, a ring, or both.
    fn circle(&mut self, center: Px, radius: f32, fill: Option<Rgb>, ring: Option<Pen>);

    /// A filled rectangle.
    fn rect(&mut self, rect: PxRect, fill: Rgb);

    /// A picture of cells, unsmoothed; `key` names it among all pictures of the surface.
    fn raster(&mut self, rect: PxRect, raster: &Raster, key: &str);

    /// A text on one line.
    fn text(&mut self, at: Px, align: Align, text: &str, size: TextSize, color: Rgb);

    /// A text over data: a halo keeps it readable on whatever lies below.
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
