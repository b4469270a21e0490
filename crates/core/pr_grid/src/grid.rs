//! The occupancy grid: dense log odds over a rectangle, updated scan by scan.

use pr_geom::{Point2, SE2, Vector2, math};

use crate::beams::Beams;
use crate::bresenham::{Cell, bresenham};
use crate::sensor_model::InverseSensorModel;

/// Extent, resolution and sensor; the default covers the Apartment as the chapter's lap maps it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GridConfig {
    /// Lower left corner in metres, world frame.
    pub min_m: Point2<f64>,
    /// Upper right corner in metres; the last row and column may reach beyond it.
    pub max_m: Point2<f64>,
    /// Side of a cell in metres.
    pub cell_m: f64,
    /// The inverse sensor model.
    pub sensor: InverseSensorModel,
    /// Log odds are clamped to ± this, because a cell must be able to follow a changed world.
    pub clamp_log_odds: f64,
}

impl Default for GridConfig {
    fn default() -> Self {
        Self {
            min_m: Point2::new(0.0, 0.0),
            max_m: Point2::new(12.0, 9.0),
            cell_m: 0.15,
            sensor: InverseSensorModel::default(),
            clamp_log_odds: 12.0,
        }
    }
}

impl GridConfig {
    /// The cell that contains a point in metres, world frame.
    pub(crate) fn cell_at(&self, point: Point2<f64>) -> Cell {
        let index = |coordinate: f64, min: f64| ((coordinate - min) / self.cell_m).floor();
        Cell {
            column: index(point.x, self.min_m.x) as i32,
            row: index(point.y, self.min_m.y) as i32,
        }
    }

    /// Center of a cell in metres, world frame.
    pub(crate) fn center(&self, cell: Cell) -> Point2<f64> {
        let center = |k: i32, min: f64| min + (f64::from(k) + 0.5) * self.cell_m;
        Point2::new(
            center(cell.column, self.min_m.x),
            center(cell.row, self.min_m.y),
        )
    }
}

/// Where a grid keeps its cells.
pub(crate) trait Cells {
    /// Log odds of a cell and the number of the scan that updated it last; `None` outside of the grid.
    fn slot(&mut self, cell: Cell) -> Option<(&mut f64, &mut u32)>;
}

/// A scan to be added to a grid.
pub(crate) struct Sweep<'a> {
    /// Extent, resolution and sensor.
    pub config: GridConfig,
    /// Number of the scan, from 1 on.
    pub number: u32,
    /// Pose of the sensor.
    pub world_from_sensor: &'a SE2,
}

impl Sweep<'_> {
    /// Updates every cell on a ray once.
    pub fn integrate(&self, cells: &mut impl Cells, beams: &Beams, ranges_m: &[f64]) {
        debug_assert_eq!(beams.directions().len(), ranges_m.len());
        let sensor = self.config.sensor;
        let cos_half_width = math::cos(sensor.beam_width_rad / 2.0);
        let heading = self.world_from_sensor.rotation();
        let origin = self.world_from_sensor.position();
        let from = self.config.cell_at(origin);
        for (beam, (range, direction)) in ranges_m.iter().zip(beams.directions()).enumerate() {
            let reach = math::min(
                range + sensor.obstacle_thickness_m / 2.0,
                sensor.max_range_m,
            );
            let (dx, dy) = heading.rotate(reach * direction.cos, reach * direction.sin);
            let to = self.config.cell_at(origin + Vector2::new(dx, dy));
            let mut nearest_beam = beam;
            for cell in bresenham(from, to) {
                let Some((log_odds, last_sweep)) = cells.slot(cell) else {
                    continue;
                };
                if *last_sweep == self.number {
                    continue;
                }
                *last_sweep = self.number;
                let center = self.config.center(cell);
                let (x, y) = heading.unrotate(center.x - origin.x, center.y - origin.y);
                let distance = math::norm2(x, y);
                nearest_beam = beams.nearest(x, y, nearest_beam);
                if beams.along(nearest_beam, x, y) < distance * cos_half_width {
                    continue;
                }
                let change = sensor.log_odds(distance, ranges_m[nearest_beam]);
                let limit = self.config.clamp_log_odds;
                *log_odds = (*log_odds + change).clamp(-limit, limit);
            }
        }
    }
}

/// A log-odds occupancy grid. 0 is unknown, positive is occupied, negative is free.
#[derive(Clone, Debug)]
pub struct OccupancyGrid {
    config: GridConfig,
    columns: usize,
    rows: usize,
    log_odds: Vec<f64>,
    /// The number of the last scan that updated each cell: a cell is updated once per scan.
    last_sweep: Vec<u32>,
    sweeps: u32,
}

impl OccupancyGrid {
    /// Creates an unknown grid.
    #[must_use]
    pub fn new(config: GridConfig) -> Self {
        let count = |from: f64, to: f64| ((to - from) / config.cell_m - 1e-9).ceil() as usize;
        let columns = count(config.min_m.x, config.max_m.x);
        let rows = count(config.min_m.y, config.max_m.y);
        Self {
            config,
            columns,
            rows,
            log_odds: vec![0.0; columns * rows],
            last_sweep: vec![0; columns * rows],
            sweeps: 0,
        }
    }

    /// Resets all cells to unknown and keeps the memory.
    pub fn clear(&mut self) {
        self.log_odds.fill(0.0);
        self.last_sweep.fill(0);
        self.sweeps = 0;
    }

    /// The parameters.
    #[must_use]
    pub fn config(&self) -> &GridConfig {
        &self.config
    }

    /// Number of columns (x).
    #[must_use]
    pub fn columns(&self) -> usize {
        self.columns
    }

    /// Number of rows (y).
    #[must_use]
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// Log odds of all cells, row by row from the lowest y: index `row · columns + column`.
    #[must_use]
    pub fn log_odds(&self) -> &[f64] {
        &self.log_odds
    }

    /// Number of scans since the grid was empty.
    #[must_use]
    pub fn sweeps(&self) -> u32 {
        self.sweeps
    }

    /// Number of occupied cells: log odds above 0.
    #[must_use]
    pub fn occupied_cells(&self) -> usize {
        self.log_odds.iter().filter(|l| **l > 0.0).count()
    }

    /// Number of free cells: log odds below 0.
    #[must_use]
    pub fn free_cells(&self) -> usize {
        self.log_odds.iter().filter(|l| **l < 0.0).count()
    }

    /// Adds one scan taken at `world_from_sensor`; `ranges_m` has one range for each of the `beams`.
    ///
    /// Every cell on a ray is updated once, by the beam nearest to it in bearing as in Table 9.2, which
    /// is not always the beam whose ray reached it first.
    pub fn integrate(&mut self, world_from_sensor: &SE2, beams: &Beams, ranges_m: &[f64]) {
        self.sweeps += 1;
        let sweep = Sweep {
            config: self.config,
            number: self.sweeps,
            world_from_sensor,
        };
        sweep.integrate(self, beams, ranges_m);
    }

    /// The cell that contains a point in metres, world frame; may be outside of the grid.
    #[must_use]
    pub fn cell_at(&self, point: Point2<f64>) -> Cell {
        self.config.cell_at(point)
    }

    /// Center of a cell in metres, world frame.
    #[must_use]
    pub fn center(&self, cell: Cell) -> Point2<f64> {
        self.config.center(cell)
    }

    /// Index of a cell into [`OccupancyGrid::log_odds`]; `None` outside of the grid.
    #[must_use]
    pub fn index(&self, cell: Cell) -> Option<usize> {
        let column = usize::try_from(cell.column).ok()?;
        let row = usize::try_from(cell.row).ok()?;
        (column < self.columns && row < self.rows).then(|| row * self.columns + column)
    }
}

impl Cells for OccupancyGrid {
    fn slot(&mut self, cell: Cell) -> Option<(&mut f64, &mut u32)> {
        let index = self.index(cell)?;
        Some((&mut self.log_odds[index], &mut self.last_sweep[index]))
    }
}

#[cfg(test)]
mod tests {
    use core::f64::consts::PI;

    use super::*;

    /// A robot in the middle of a 2 m × 2 m grid, four beams of 0.6 m.
    fn cross() -> OccupancyGrid {
        let mut grid = OccupancyGrid::new(GridConfig {
            max_m: Point2::new(2.0, 2.0),
            cell_m: 0.1,
            ..GridConfig::default()
        });
        let beams = Beams::new(&[-PI, -PI / 2.0, 0.0, PI / 2.0]);
        grid.integrate(&SE2::new(1.05, 1.05, 0.0), &beams, &[0.6; 4]);
        grid
    }

    fn at(grid: &OccupancyGrid, x: f64, y: f64) -> f64 {
        let cell = grid.cell_at(Point2::new(x, y));
        grid.log_odds()[grid.index(cell).unwrap()]
    }

    #[test]
    fn cells_before_the_return_are_free_and_at_it_occupied() {
        let grid = cross();
        let sensor = grid.config().sensor;
        for (dx, dy) in [(1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0)] {
            assert_eq!(
                at(&grid, 1.05 + 0.3 * dx, 1.05 + 0.3 * dy),
                sensor.free_log_odds
            );
            assert_eq!(
                at(&grid, 1.05 + 0.6 * dx, 1.05 + 0.6 * dy),
                sensor.occupied_log_odds
            );
            assert_eq!(at(&grid, 1.05 + 0.85 * dx, 1.05 + 0.85 * dy), 0.0);
        }
        assert_eq!(at(&grid, 1.35, 1.35), 0.0);
    }

    #[test]
    fn a_cell_counts_once_a_sweep_however_many_beams_cross_it() {
        // All four beams start in the robot's own cell.
        let grid = cross();
        assert_eq!(at(&grid, 1.05, 1.05), grid.config().sensor.free_log_odds);
    }

    #[test]
    fn log_odds_stay_within_the_clamp() {
        let mut grid = OccupancyGrid::new(GridConfig::default());
        let beams = Beams::new(&[0.0]);
        for _ in 0..50 {
            grid.integrate(&SE2::new(1.0, 1.0, 0.0), &beams, &[3.0]);
        }
        assert_eq!(at(&grid, 2.0, 1.0), -12.0);
        assert_eq!(at(&grid, 4.0, 1.0), 12.0);
        grid.clear();
        assert_eq!(
            (grid.occupied_cells(), grid.free_cells(), grid.sweeps()),
            (0, 0, 0)
        );
    }

    #[test]
    fn rays_that_leave_the_grid_are_cut_at_its_border() {
        let mut grid = OccupancyGrid::new(GridConfig::default());
        let beams = Beams::new(&[0.0]);
        grid.integrate(&SE2::new(11.0, 8.9, PI / 4.0), &beams, &[6.0]);
        assert!(grid.free_cells() > 0);
        grid.integrate(&SE2::new(-5.0, 4.0, 0.0), &beams, &[6.0]);
        assert!(at(&grid, 0.5, 4.0) < 0.0);
    }
}
