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

use std::io::{self, Write};

use pr_geom::{Point2, SE2, math};
use pr_grid::{Beams, GridConfig, GridTooLarge, InverseSensorModel, OccupancyGrid};
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
    /// The mapped area needs too many cells.
    #[error(transparent)]
    TooLarge(#[from] GridTooLarge),
    /// No scan has a point.
    #[error("no scan has a point, so the map is empty")]
    Nothing,
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

/// Adds scans to an occupancy grid that grows as needed.
#[derive(Clone, Debug)]
pub struct MapBuilder {
    cell_m: f64,
    /// Whether beams without a return mark free space up to the sensor's limit.
    clears: bool,
    grid: Option<OccupancyGrid>,
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

    /// Adds the scan taken at `world_from_body`; beams without a return are ignored.
    ///
    /// # Errors
    /// If the map would have too many cells; it stays unchanged.
    pub fn add(&mut self, world_from_body: &SE2, scan: &LaserScan) -> Result<(), GridTooLarge> {
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
        let grid = self.grid.get_or_insert_with(|| OccupancyGrid::new(config));
        grid.cover(at, reach_m + 2.0 * self.cell_m)?;
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
        let (bearings, ranges_m): (Vec<f64>, Vec<f64>) = beams.into_iter().unzip();
        grid.integrate(&world_from_sensor, &Beams::new(&bearings), &ranges_m);
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
            ..GridConfig::growing_from(at, cell_m)
        }
    }

    /// The map, cropped to the observed area.
    ///
    /// # Errors
    /// If there is no observation.
    pub fn finish(&self) -> Result<MapImage, MapError> {
        let grid = self.grid.as_ref().ok_or(MapError::Nothing)?;
        let margin = 2;
        let [low, high] = [self.low, self.high].map(|corner| grid.cell_at(corner));
        let clamp = |cell: i32, count: usize| cell.clamp(0, count as i32 - 1) as usize;
        let columns = clamp(low.column - margin, grid.columns())
            ..clamp(high.column + margin, grid.columns()) + 1;
        let rows = clamp(low.row - margin, grid.rows())..clamp(high.row + margin, grid.rows()) + 1;
        let min_m = grid.config().min_m;
        let mut log_odds = Vec::with_capacity(columns.len() * rows.len());
        for row in rows.clone().rev() {
            let start = row * grid.columns();
            log_odds
                .extend_from_slice(&grid.log_odds()[start + columns.start..start + columns.end]);
        }
        Ok(MapImage {
            width: columns.len(),
            height: rows.len(),
            origin_m: [
                min_m.x + columns.start as f64 * self.cell_m,
                min_m.y + rows.start as f64 * self.cell_m,
            ],
            cell_m: self.cell_m,
            log_odds,
        })
    }
}

/// An occupancy map.
#[derive(Clone, Debug, PartialEq)]
pub struct MapImage {
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Lower left corner, world frame, m.
    pub origin_m: [f64; 2],
    /// Side of a cell, m.
    pub cell_m: f64,
    /// Log odds, row by row from the highest y; 0 if unknown.
    pub log_odds: Vec<f64>,
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

    /// Writes the trinary map as PGM.
    ///
    /// # Errors
    /// If `target` fails.
    pub fn write_pgm(&self, mut target: impl Write) -> io::Result<()> {
        write!(target, "P5\n{} {}\n255\n", self.width, self.height)?;
        let pixels: Vec<u8> = self.log_odds.iter().map(|&l| Self::trinary(l)).collect();
        target.write_all(&pixels)
    }

    /// Writes the map as greyscale PNG, with transparency if the mode needs it.
    ///
    /// # Errors
    /// If `target` fails.
    pub fn write_png(&self, target: impl Write, mode: MapMode) -> io::Result<()> {
        let mut encoder = png::Encoder::new(target, self.width as u32, self.height as u32);
        encoder.set_depth(png::BitDepth::Eight);
        let pixels: Vec<u8> = match mode {
            MapMode::Trinary => {
                encoder.set_color(png::ColorType::Grayscale);
                self.log_odds.iter().map(|&l| Self::trinary(l)).collect()
            }
            MapMode::Scale => {
                encoder.set_color(png::ColorType::GrayscaleAlpha);
                let cells = self.log_odds.iter();
                cells
                    .flat_map(|&l| match Self::probability(l) {
                        Some(p) => [(254.0 * (1.0 - p)).round() as u8, 255],
                        None => [205, 0],
                    })
                    .collect()
            }
        };
        let mut writer = encoder.write_header()?;
        writer.write_image_data(&pixels)?;
        writer.finish()?;
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
        for &log_odds in &self.log_odds {
            counts[match Self::trinary(log_odds) {
                0 => 0,
                254 => 1,
                _ => 2,
            }] += 1;
        }
        counts
    }
}

#[cfg(test)]
mod tests;
