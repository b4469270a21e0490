//! Adds scans to a map.

use ch16_slam2d::scan::LaserScan;
use pr_geom::{Point2, SE2, math};
use pr_grid::{
    Beams, Cell, GridConfig, InverseSensorModel, MAX_TILED_CELLS, TiledGrid, TooManyCells,
};

use super::{MAX_PIXELS, MapError, MapImage, NoReturn};

/// Longer rays mark no free space, m: distant readings are sparse and graze surfaces.
const FARTHEST_M: f64 = 30.0;

/// Range up to which a scan marks free space, m.
fn reach_of(scan: &LaserScan) -> f64 {
    math::min(scan.range_max_m, FARTHEST_M)
}

/// Adds scans to an occupancy grid of tiles.
#[derive(Clone, Debug)]
pub struct MapBuilder {
    cell_m: f64,
    no_return: NoReturn,
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
            no_return: NoReturn::default(),
            most: MAX_TILED_CELLS,
            grid: None,
            low: Point2::new(f64::INFINITY, f64::INFINITY),
            high: Point2::new(f64::NEG_INFINITY, f64::NEG_INFINITY),
        }
    }

    /// Sets what beams without a return say.
    #[must_use]
    pub fn with_no_return(mut self, no_return: NoReturn) -> Self {
        self.no_return = no_return;
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
            } else if self.no_return == NoReturn::Free && range_m >= scan.range_max_m {
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
                max_range_m: if self.no_return == NoReturn::Free {
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
