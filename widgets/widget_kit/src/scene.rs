//! A picture as plain data, in metres: what [`crate::model::Model::scene`] returns.
//!
//! A scene is a list of panels. A panel has two axes and layers, painted in order. Maps and plots are both
//! panels: a map has equal axes. Colours are named by meaning ([`Tone`]), marks by kind ([`Mark`]), and only
//! the drawing code handles pixels.

use std::sync::Arc;

/// Meaning of a colour; the palette gives each theme its shade.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Tone {
    /// Prior estimate: blue, ○.
    Prior,
    /// Motion prediction: orange, △.
    Prediction,
    /// Sensor measurement: green, ×.
    Measurement,
    /// Measurement on the way out: the darker green of the way out and the way back, in both themes.
    Outbound,
    /// Measurement of a second visit, as on the way back: the lighter green, ×.
    Revisit,
    /// Posterior estimate: purple, ■.
    Posterior,
    /// An edge strained past the gate: amber, wide.
    Strained,
    /// Ground truth: grey, dashed.
    Truth,
    /// Walls, axes and words.
    Ink,
    /// Grid lines and secondary elements.
    Faint,
    /// The background.
    Paper,
    /// Cells that were not observed.
    Unseen,
    /// Class n in a picture of classes: minima, cells. Each class also has a letter.
    Class(u8),
    /// One of several of a kind beside each other, such as methods, that is none of the above: n from 0.
    Series(u8),
    /// A value along a line, 0 … 255 in the perceptual colour map; it needs a line of ink below.
    Level(u8),
}

/// Shape of a point; each of the first four belongs to the tone of its name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Mark {
    /// ○, prior.
    Circle,
    /// △, prediction.
    Triangle,
    /// ×, measurement.
    Cross,
    /// ■, posterior.
    Square,
    /// A small filled disc: map points, plot samples.
    Dot,
    /// ＋, truth and chosen positions.
    Plus,
}

/// Line pattern.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Stroke {
    /// ———
    Solid,
    /// – – –, truth.
    Dashed,
    /// · · ·, thresholds and gates.
    Dotted,
}

/// Rectangle in the units of a panel's axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Smallest x and y.
    pub min: [f64; 2],
    /// Largest x and y.
    pub max: [f64; 2],
}

impl Bounds {
    /// Width and height.
    #[must_use]
    pub fn size(&self) -> [f64; 2] {
        [self.max[0] - self.min[0], self.max[1] - self.min[1]]
    }

    /// Middle.
    #[must_use]
    pub fn middle(&self) -> [f64; 2] {
        core::array::from_fn(|i| 0.5 * (self.min[i] + self.max[i]))
    }
}

/// One thing to paint. Coordinates are in the units of the panel's axes (metres in maps).
#[derive(Clone, Debug, PartialEq)]
pub enum Layer {
    /// Separate points.
    Points {
        /// Positions.
        points: Vec<[f64; 2]>,
        /// Shape.
        mark: Mark,
        /// Meaning.
        tone: Tone,
        /// Radius in pixels.
        radius_px: f32,
    },
    /// An open line through points; a point that is not finite interrupts it.
    Line {
        /// Vertices.
        points: Vec<[f64; 2]>,
        /// Pattern.
        stroke: Stroke,
        /// Meaning.
        tone: Tone,
        /// Width in pixels.
        width_px: f32,
    },
    /// Separate segments: correspondences, factors, walls.
    Segments {
        /// End points.
        segments: Vec<[[f64; 2]; 2]>,
        /// Pattern.
        stroke: Stroke,
        /// Meaning.
        tone: Tone,
        /// Width in pixels.
        width_px: f32,
    },
    /// What a panel asks before the run answers it, in place of everything else: see [`Panel::question`].
    Question(String),
    /// Walls of a plan by their middle lines, drawn with their thickness on a floor.
    Walls(Vec<[[f64; 2]; 2]>),
    /// What a sensor sees: the area between it and its returns.
    Seen {
        /// Position of the sensor.
        from: [f64; 2],
        /// The returns.
        points: Vec<[f64; 2]>,
        /// Meaning.
        tone: Tone,
    },
    /// Correspondences, coloured by their length.
    Threads {
        /// Pairs of points.
        threads: Vec<[[f64; 2]; 2]>,
        /// The length of the warmest colour.
        reach: f64,
    },
    /// A pose: a robot seen from above. That with a square is there, those with other marks are ghosts.
    Pose {
        /// `[x, y, θ]`, metres and radians.
        pose: [f64; 3],
        /// Shape.
        mark: Mark,
        /// Meaning.
        tone: Tone,
        /// Half of its smallest width, in pixels.
        radius_px: f32,
    },
    /// A draggable handle: drawn larger, with a ring.
    Handle {
        /// Position.
        at: [f64; 2],
        /// Meaning.
        tone: Tone,
        /// Its effect, for the host to show at the pointer: `turn the source`.
        label: &'static str,
    },
    /// The ellipse `center + A u`, |u| = 1, with the columns of A as half axes.
    Ellipse {
        /// Centre.
        center: [f64; 2],
        /// Half axes as vectors.
        half_axes: [[f64; 2]; 2],
        /// Pattern.
        stroke: Stroke,
        /// Meaning.
        tone: Tone,
    },
    /// Cells over a rectangle; row 0 is at the smallest y.
    Raster(Raster),
    /// Words at a point.
    Text {
        /// Anchor, the center of the text.
        at: [f64; 2],
        /// The words.
        text: String,
        /// Meaning.
        tone: Tone,
    },
    /// Text in ink near a point, placed where it overlaps no other text of the panel and no other labelled point is
    /// nearer, in the order of the layers, and left out if there is no such position.
    Label {
        /// The labelled point.
        at: [f64; 2],
        /// The words.
        text: String,
        /// Smallest distance from the point, in pixels; 0 allows an overlap.
        clear_px: f32,
    },
}

impl Layer {
    /// [`Layer::Points`].
    #[must_use]
    pub fn points(points: Vec<[f64; 2]>, mark: Mark, tone: Tone, radius_px: f32) -> Self {
        Self::Points {
            points,
            mark,
            tone,
            radius_px,
        }
    }

    /// A line through points.
    #[must_use]
    pub fn line(points: Vec<[f64; 2]>, stroke: Stroke, tone: Tone, width_px: f32) -> Self {
        Self::Line {
            points,
            stroke,
            tone,
            width_px,
        }
    }

    /// Lines between pairs of points.
    #[must_use]
    pub fn segments(
        segments: Vec<[[f64; 2]; 2]>,
        stroke: Stroke,
        tone: Tone,
        width_px: f32,
    ) -> Self {
        Self::Segments {
            segments,
            stroke,
            tone,
            width_px,
        }
    }

    /// [`Layer::Label`].
    #[must_use]
    pub fn label(at: [f64; 2], text: String, clear_px: f32) -> Self {
        Self::Label { at, text, clear_px }
    }

    /// [`Layer::Pose`].
    #[must_use]
    pub fn pose(pose: [f64; 3], mark: Mark, tone: Tone, radius_px: f32) -> Self {
        Self::Pose {
            pose,
            mark,
            tone,
            radius_px,
        }
    }
}

/// A raster of cells, ready to upload as a texture.
#[derive(Clone, Debug, PartialEq)]
pub struct Raster {
    /// Rectangle that it covers.
    pub bounds: Bounds,
    /// Cells along x.
    pub columns: usize,
    /// Cells along y.
    pub rows: usize,
    /// The cells row by row from the smallest y, `columns × rows`.
    pub cells: Arc<[RasterCell]>,
    /// A number that changes with `cells`, so that textures are uploaded only then.
    pub revision: u64,
}

impl Raster {
    /// Whether the colours run into one another between the centres of cells, as those of occupancies do: a cell's
    /// edge is no wall.
    #[must_use]
    pub fn is_smooth(&self) -> bool {
        let mut cells = self.cells.iter();
        cells.any(|cell| matches!(cell, RasterCell::Occupancy(_)))
    }
}

/// One cell of a raster.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RasterCell {
    /// Not yet computed: paper.
    Unknown,
    /// Position in the perceptual colour map, 0…1.
    Level(f32),
    /// The same on a relief that is lit from the upper left.
    Relief {
        /// Position in the colour map, 0…1.
        level: f32,
        /// From −1, turned away from the light, to 1, turned towards it.
        light: f32,
    },
    /// Class n, see [`Tone::Class`].
    Class(u8),
    /// Occupancy, 0 (free) … 1 (occupied): paper to ink.
    Occupancy(f32),
}

/// How an axis is divided.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// Name with unit: `Δx (m)`. An axis without a name has no ticks and takes no space.
    pub label: String,
    /// Smallest value shown.
    pub min: f64,
    /// Largest value shown.
    pub max: f64,
    /// What stands at 1, 2, … on an axis of names; an axis of numbers has none.
    pub names: Vec<String>,
}

impl Axis {
    /// An axis from `min` to `max`.
    #[must_use]
    pub fn new(label: &str, min: f64, max: f64) -> Self {
        Self {
            label: label.to_owned(),
            min,
            max,
            names: Vec::new(),
        }
    }

    /// An axis that is not drawn: of a picture that its marks explain.
    #[must_use]
    pub fn hidden(min: f64, max: f64) -> Self {
        Self::new("", min, max)
    }

    /// Whether the axis is drawn.
    #[must_use]
    pub fn is_drawn(&self) -> bool {
        !self.label.is_empty() || !self.names.is_empty()
    }

    /// An axis with these names at 1, 2, … in place of numbers.
    #[must_use]
    pub fn from_names(label: &str, names: impl IntoIterator<Item = String>) -> Self {
        let names: Vec<String> = names.into_iter().collect();
        let max = names.len() as f64 + 0.6;
        Self {
            names,
            ..Self::new(label, 0.4, max)
        }
    }
}

/// Whether both axes have the same scale.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Aspect {
    /// A metre is a metre in both directions: maps.
    Equal,
    /// Each axis fills the available space: plots.
    Free,
}

/// The importance of a panel in the layout.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Weight {
    /// The picture that the widget is about.
    Main,
    /// One of several equally important pictures side by side.
    Half,
    /// A small plot beside or below.
    Side,
}

/// One entry of a legend.
#[derive(Clone, Debug, PartialEq)]
pub struct LegendEntry {
    /// Words.
    pub label: String,
    /// Meaning.
    pub tone: Tone,
    /// Shape, if it stands for points.
    pub mark: Option<Mark>,
    /// Pattern, if it stands for a line.
    pub stroke: Option<Stroke>,
}

impl LegendEntry {
    /// Stands for points.
    #[must_use]
    pub fn mark(label: &str, tone: Tone, mark: Mark) -> Self {
        Self {
            label: label.to_owned(),
            tone,
            mark: Some(mark),
            stroke: None,
        }
    }

    /// Stands for a line.
    #[must_use]
    pub fn line(label: &str, tone: Tone, stroke: Stroke) -> Self {
        Self {
            label: label.to_owned(),
            tone,
            mark: None,
            stroke: Some(stroke),
        }
    }

    /// Stands for a line with marks on it.
    #[must_use]
    pub fn marked_line(label: &str, tone: Tone, mark: Mark, stroke: Stroke) -> Self {
        Self {
            stroke: Some(stroke),
            ..Self::mark(label, tone, mark)
        }
    }
}

/// Scale of a raster's colours.
#[derive(Clone, Debug, PartialEq)]
pub struct ColorBar {
    /// Name with unit: `cost (m²)`.
    pub label: String,
    /// Value at level 0.
    pub min: f64,
    /// Value at level 1.
    pub max: f64,
}

/// One map or plot.
#[derive(Clone, Debug, PartialEq)]
pub struct Panel {
    /// Name for pointer events: `map`.
    pub id: &'static str,
    /// Title on screen.
    pub title: String,
    /// Its importance in the layout.
    pub weight: Weight,
    /// Same scale on both axes, or not.
    pub aspect: Aspect,
    /// Horizontal axis.
    pub x: Axis,
    /// Vertical axis, upwards.
    pub y: Axis,
    /// The layers, in painting order.
    pub layers: Vec<Layer>,
    /// The meanings of colours and marks.
    pub legend: Vec<LegendEntry>,
    /// Scale of the raster's colours, if there is a raster.
    pub color_bar: Option<ColorBar>,
}

impl Panel {
    /// Whether it is a plan: it has walls, and no axes.
    #[must_use]
    pub fn is_plan(&self) -> bool {
        let mut layers = self.layers.iter();
        layers.any(|layer| matches!(layer, Layer::Walls(_))) && !self.x.is_drawn()
    }

    /// The question that it asks until the run answers it.
    #[must_use]
    pub fn question(&self) -> Option<&str> {
        match self.layers.as_slice() {
            [Layer::Question(words)] => Some(words),
            _ => None,
        }
    }

    /// The range of both axes.
    #[must_use]
    pub fn bounds(&self) -> Bounds {
        Bounds {
            min: [self.x.min, self.y.min],
            max: [self.x.max, self.y.max],
        }
    }
}

/// Everything a widget shows besides its controls.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Scene {
    /// The panels, main ones first.
    pub panels: Vec<Panel>,
}
