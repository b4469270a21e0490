//! Occupancy maps as an image with a YAML file, as Nav2's map_server reads them.
//!
//! | mode | a cell is | pixel |
//! |---|---|---|
//! | trinary | occupied, free, unknown | 0, 254, 205 |
//! | scale | occupied with probability p; unknown | 254 · (1 − p), opaque; transparent |
//!
//! The first row of the image is the one with the highest y, and `origin` is the lower left corner.
//! Scale needs transparency, so it is written as PNG; PGM has none.
//! Source: Nav2, `nav2_map_server/src/map_io.cpp`, and "map_server", wiki.ros.org/map_server.

mod builder;

use std::convert::Infallible;
use std::io::{self, Write};

use pr_geom::{SE2, math};
use pr_grid::{Cell, TiledGrid, TooManyCells};
use thiserror::Error;

use crate::json_log::FrameLine;
use crate::log::LogFrame;
use crate::session::Session;

pub use builder::MapBuilder;

/// A cell with a higher probability is occupied.
const OCCUPIED: f64 = 0.65;
/// A cell with a lower probability is free: one ray through it is enough.
const FREE: f64 = 0.4;
/// A map server takes pixels above this as free; 205 of 255 is 0.1961, which keeps unknown cells unknown.
const FREE_PIXEL: f64 = 0.196;

/// Meaning of a pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum MapMode {
    /// Occupied, free or unknown.
    #[default]
    Trinary,
    /// Probability.
    Scale,
}

impl MapMode {
    /// Name in the YAML file.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Trinary => "trinary",
            Self::Scale => "scale",
        }
    }
}

/// Why there is no map.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum MapError {
    /// The seen area needs too many cells.
    #[error(transparent)]
    TooLarge(#[from] TooManyCells),
    /// The rectangle around the seen area has too many pixels for an image.
    #[error("the image would have {columns} × {rows} cells of {cell_m} m, more than {MAX_PIXELS}")]
    TooWide {
        /// Columns.
        columns: u64,
        /// Rows.
        rows: u64,
        /// Side of a cell, m.
        cell_m: f64,
    },
    /// No scan has a point.
    #[error("no scan has a point, so the map is empty")]
    Nothing,
}

impl MapError {
    /// Whether larger cells help.
    fn is_too_fine(self) -> bool {
        !matches!(self, Self::Nothing)
    }
}

/// Most pixels of an image: 2 km × 1 km at 5 cm.
const MAX_PIXELS: u64 = 1 << 30;
/// Coarsest cells that are tried, as a multiple of those asked for.
const COARSEST: f64 = 1024.0;

/// Builds the map with the finest cells that fit: those asked for, or twice, four times … as large.
///
/// # Errors
/// If no scan has a point, or no such cells fit.
pub fn finest_map(
    cell_m: f64,
    build: impl Fn(f64) -> Result<MapImage, MapError>,
) -> Result<MapImage, MapError> {
    let mut factor = 1.0;
    loop {
        match build(factor * cell_m) {
            Err(error) if error.is_too_fine() && factor < COARSEST => factor *= 2.0,
            other => return other,
        }
    }
}

/// What the map says along a beam without a return, up to the sensor's limit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum NoReturn {
    /// Nothing: many sensors cannot tell far from unseen.
    #[default]
    Unknown,
    /// Free space, as REP 117 defines it.
    Free,
}

impl NoReturn {
    /// That of an option which asks for free space.
    #[must_use]
    pub fn free_if(is_asked: bool) -> Self {
        if is_asked { Self::Free } else { Self::Unknown }
    }
}

/// Builds the map of scans with known poses; skips those without one.
///
/// # Errors
/// If no scan has a point, or there are too many cells.
pub fn build_map(
    lines: &[FrameLine],
    cell_m: f64,
    no_return: NoReturn,
) -> Result<MapImage, MapError> {
    let mut map = MapBuilder::new(cell_m).with_no_return(no_return);
    for line in lines {
        if let Some([x, y, theta]) = line.pose {
            let frame = LogFrame::from(line.clone());
            map.add(&SE2::new(x, y, theta), &frame.scan)?;
        }
    }
    map.finish()
}

/// Builds the map of a session from its keyframes' filtered scans at the poses of its map, oldest first.
///
/// # Errors
/// If no scan has a point, or there are too many cells.
pub fn build_session_map(session: &Session, cell_m: f64) -> Result<MapImage, MapError> {
    let mut map = MapBuilder::new(cell_m);
    for (pose, scan) in session.posed_scans() {
        map.add(&pose, &scan)?;
    }
    map.finish()
}

/// An occupancy map.
#[derive(Clone, Debug)]
pub struct MapImage {
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Lower left corner, world frame, m.
    pub origin_m: [f64; 2],
    /// Side of a cell, m.
    pub cell_m: f64,
    /// Lower left cell in the grid.
    first: Cell,
    grid: TiledGrid,
}

impl MapImage {
    /// Probability that a cell is occupied; `None` if unknown.
    fn probability(log_odds: f64) -> Option<f64> {
        (log_odds != 0.0).then(|| 1.0 / (1.0 + math::exp(-log_odds)))
    }

    /// The pixels of cells in the trinary map.
    #[must_use]
    pub fn pixels(log_odds: &[f64]) -> Vec<u8> {
        log_odds.iter().map(|&l| Self::trinary(l)).collect()
    }

    fn trinary(log_odds: f64) -> u8 {
        match Self::probability(log_odds) {
            Some(p) if p > OCCUPIED => 0,
            Some(p) if p < FREE => 254,
            _ => 205,
        }
    }

    /// What to say if the map is coarser than what was asked for.
    #[must_use]
    pub fn coarser_than(&self, cell_m: f64) -> Option<String> {
        (self.cell_m > cell_m).then(|| {
            format!(
                "the map has cells of {} m, because the place has too many of {cell_m} m for memory or an image",
                self.cell_m
            )
        })
    }

    /// Calls `take` with the log odds of each row of cells, 0 if unknown, from the highest y on.
    ///
    /// # Errors
    /// Those of `take`.
    pub fn rows<E>(&self, mut take: impl FnMut(&[f64]) -> Result<(), E>) -> Result<(), E> {
        let mut cells = vec![0.0; self.width];
        (0..self.height).rev().try_for_each(|row| {
            let first = Cell {
                row: self.first.row + row as i32,
                ..self.first
            };
            self.grid.row(first, &mut cells);
            take(&cells)
        })
    }

    /// Log odds of all cells, row by row from the highest y.
    #[must_use]
    pub fn log_odds(&self) -> Vec<f64> {
        let mut all = Vec::with_capacity(self.width * self.height);
        let Ok(()) = self.rows(|row| {
            all.extend_from_slice(row);
            Ok::<(), Infallible>(())
        });
        all
    }

    /// Writes the trinary map as PGM.
    ///
    /// # Errors
    /// If `target` fails.
    pub fn write_pgm(&self, mut target: impl Write) -> io::Result<()> {
        write!(target, "P5\n{} {}\n255\n", self.width, self.height)?;
        let mut pixels = Vec::with_capacity(self.width);
        self.rows(|row| {
            pixels.clear();
            pixels.extend(row.iter().map(|&l| Self::trinary(l)));
            target.write_all(&pixels)
        })
    }

    /// Writes the map as greyscale PNG, with transparency if the mode needs it.
    ///
    /// # Errors
    /// If `target` fails.
    pub fn write_png(&self, target: impl Write, mode: MapMode) -> io::Result<()> {
        let mut encoder = png::Encoder::new(target, self.width as u32, self.height as u32);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.set_color(match mode {
            MapMode::Trinary => png::ColorType::Grayscale,
            MapMode::Scale => png::ColorType::GrayscaleAlpha,
        });
        let mut writer = encoder.write_header()?;
        let mut image = writer.stream_writer()?;
        let mut pixels = Vec::new();
        self.rows(|row| {
            pixels.clear();
            match mode {
                MapMode::Trinary => pixels.extend(row.iter().map(|&l| Self::trinary(l))),
                MapMode::Scale => {
                    pixels.extend(row.iter().flat_map(|&l| match Self::probability(l) {
                        Some(p) => [(254.0 * (1.0 - p)).round() as u8, 255],
                        None => [205, 0],
                    }));
                }
            }
            image.write_all(&pixels)
        })?;
        image.finish()?;
        Ok(())
    }

    /// The YAML file that refers to `image`.
    #[must_use]
    pub fn yaml(&self, image: &str, mode: MapMode) -> String {
        Self::yaml_of(image, mode, self.cell_m, self.origin_m)
    }

    /// The YAML file of a map with cells of this side and this lower left corner, m.
    #[must_use]
    pub fn yaml_of(image: &str, mode: MapMode, cell_m: f64, [x, y]: [f64; 2]) -> String {
        format!(
            "image: {image}\nmode: {}\nresolution: {}\norigin: [{x}, {y}, 0]\nnegate: 0\n\
             occupied_thresh: {OCCUPIED}\nfree_thresh: {FREE_PIXEL}\n",
            mode.name(),
            cell_m
        )
    }

    /// Numbers of occupied, free and unknown cells.
    #[must_use]
    pub fn counts(&self) -> [usize; 3] {
        let mut counts = [0; 3];
        let Ok(()) = self.rows(|row| {
            for &log_odds in row {
                counts[match Self::trinary(log_odds) {
                    0 => 0,
                    254 => 1,
                    _ => 2,
                }] += 1;
            }
            Ok::<(), Infallible>(())
        });
        counts
    }
}

#[cfg(test)]
mod tests;
