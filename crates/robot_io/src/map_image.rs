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

use std::convert::Infallible;
use std::io::{self, Write};

use pr_geom::{Point2, SE2, math};
use pr_grid::{
    Beams, Cell, GridConfig, InverseSensorModel, MAX_TILED_CELLS, TiledGrid, TooManyCells,
};
use thiserror::Error;

use ch16_slam2d::scan::LaserScan;

use crate::json_log::FrameLine;
use crate::log::LogFrame;
use crate::session::Session;

/// A cell with a higher probability is occupied.
const OCCUPIED: f64 = 0.65;
/// A cell with a lower probability is free: one ray through it is enough.
const FREE: f64 = 0.4;
/// A map server takes pixels above this as free; 205 of 255 is 0.1961, which keeps unknown cells unknown.
const FREE_PIXEL: f64 = 0.196;
/// Longer rays mark no free space, m: distant readings are sparse and graze surfaces.
const FARTHEST_M: f64 = 30.0;

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

/// Builds the map of scans with known poses; skips those without one.
///
/// # Errors
/// If no scan has a point, or there are too many cells.
pub fn build_map(lines: &[FrameLine], cell_m: f64) -> Result<MapImage, MapError> {
    built(MapBuilder::new(cell_m), lines)
}

/// Builds the map of [`build_map`] with free space along beams without a return, up to the sensor's limit.
///
/// # Errors
/// Those of [`build_map`].
pub fn map_with_free_space(lines: &[FrameLine], cell_m: f64) -> Result<MapImage, MapError> {
    built(MapBuilder::new(cell_m).with_free_space(), lines)
}

fn built(mut map: MapBuilder, lines: &[FrameLine]) -> Result<MapImage, MapError> {
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

/// Range up to which a scan marks free space, m.
fn reach_of(scan: &LaserScan) -> f64 {
    math::min(scan.range_max_m, FARTHEST_M)
}

/// Adds scans to an occupancy grid of tiles.
#[derive(Clone, Debug)]
pub struct MapBuilder {
    cell_m: f64,
    /// Whether beams without a return mark free space up to the sensor's limit.
    clears: bool,
    most: usize,
    grid: Option<TiledGrid>,
    /// Bounds of all points and poses, m: the extent of the image.
    low: Point2<f64>,
    high: Point2<f64>,
}

impl MapBuilder {
    /// An empty map with cells of this side, m.
    #[must_use]
    pub fn new(cell_m: f64) -> Self {
        Self {
            cell_m,
            clears: false,
            most: MAX_TILED_CELLS,
            grid: None,
            low: Point2::new(f64::INFINITY, f64::INFINITY),
            high: Point2::new(f64::NEG_INFINITY, f64::NEG_INFINITY),
        }
    }

    /// Lets beams without a return mark free space up to the sensor's limit, as REP 117 defines them.
    #[must_use]
    pub fn with_free_space(mut self) -> Self {
        self.clears = true;
        self
    }

    /// Sets the maximum number of cells in memory.
    #[must_use]
    pub fn with_most_cells(mut self, most: usize) -> Self {
        self.most = most;
        self
    }

    /// Adds the scan taken at `world_from_body`; beams without a return are ignored.
    ///
    /// # Errors
    /// If the map would have too many cells; it stays unchanged.
    pub fn add(&mut self, world_from_body: &SE2, scan: &LaserScan) -> Result<(), TooManyCells> {
        let world_from_sensor = *world_from_body * scan.body_from_sensor;
        let mut beams: Vec<(f64, f64)> = Vec::with_capacity(scan.ranges_m.len());
        for (beam, &range_m) in scan.ranges_m.iter().enumerate() {
            if scan.is_return(range_m) && range_m < FARTHEST_M {
                beams.push((scan.bearing_rad(beam), range_m));
            } else if self.clears && range_m >= scan.range_max_m {
                beams.push((scan.bearing_rad(beam), reach_of(scan)));
            }
        }
        if scan.angle_step_rad < 0.0 {
            beams.reverse();
        }
        // More than a turn: the grid evaluates each bearing once.
        let first = beams.first().map_or(0.0, |beam| beam.0);
        beams.retain(|beam| beam.0 - first < core::f64::consts::TAU);
        let reach_m = beams.iter().map(|beam| beam.1).fold(0.0, f64::max);
        if beams.is_empty() {
            return Ok(());
        }
        let at = world_from_sensor.position();
        let config = self.config(scan, at);
        let most = self.most;
        let grid = self
            .grid
            .get_or_insert_with(|| TiledGrid::new(config, most));
        let (bearings, ranges_m): (Vec<f64>, Vec<f64>) = beams.iter().copied().unzip();
        let directions = Beams::new(&bearings);
        grid.integrate(&world_from_sensor, &directions, &ranges_m, reach_m)?;
        for &(bearing, range_m) in &beams {
            let (sin, cos) = math::sin_cos(bearing + world_from_sensor.theta());
            for point in [at, Point2::new(at.x + range_m * cos, at.y + range_m * sin)] {
                self.low = Point2::new(
                    math::min(self.low.x, point.x),
                    math::min(self.low.y, point.y),
                );
                self.high = Point2::new(
                    math::max(self.high.x, point.x),
                    math::max(self.high.y, point.y),
                );
            }
        }
        Ok(())
    }

    fn config(&self, scan: &LaserScan, at: Point2<f64>) -> GridConfig {
        let cell_m = self.cell_m;
        GridConfig {
            sensor: InverseSensorModel {
                // A return marks its own cell only.
                obstacle_thickness_m: 1.5 * cell_m,
                // Half a step to either side, plus rounding.
                beam_width_rad: 1.001 * scan.angle_step_rad.abs(),
                // A reading at the limit is no return.
                max_range_m: if self.clears {
                    reach_of(scan)
                } else {
                    FARTHEST_M
                },
                ..InverseSensorModel::default()
            },
            min_m: at,
            cell_m,
            ..GridConfig::default()
        }
    }

    /// The map, cropped to the observed area.
    ///
    /// # Errors
    /// If there is no observation, or the image would have too many pixels.
    pub fn finish(&self) -> Result<MapImage, MapError> {
        let grid = self.grid.as_ref().ok_or(MapError::Nothing)?;
        if self.low.x > self.high.x {
            return Err(MapError::Nothing);
        }
        let margin = 2;
        let [low, high] = [self.low, self.high].map(|corner| grid.cell_at(corner));
        let first = Cell {
            column: low.column - margin,
            row: low.row - margin,
        };
        let count = |from: i32, to: i32| (i64::from(to) - i64::from(from) + 1) as u64;
        let columns = count(first.column, high.column + margin);
        let rows = count(first.row, high.row + margin);
        let cell_m = self.cell_m;
        if columns.saturating_mul(rows) > MAX_PIXELS {
            return Err(MapError::TooWide {
                columns,
                rows,
                cell_m,
            });
        }
        let corner = grid.config().min_m;
        Ok(MapImage {
            width: columns as usize,
            height: rows as usize,
            origin_m: [
                corner.x + f64::from(first.column) * cell_m,
                corner.y + f64::from(first.row) * cell_m,
            ],
            cell_m,
            first,
            grid: grid.clone(),
        })
    }
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
        let [x, y] = self.origin_m;
        format!(
            "image: {image}\nmode: {}\nresolution: {}\norigin: [{x}, {y}, 0]\nnegate: 0\n\
             occupied_thresh: {OCCUPIED}\nfree_thresh: {FREE_PIXEL}\n",
            mode.name(),
            self.cell_m
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
