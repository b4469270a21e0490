//! A grid of tiles: memory holds what beams have crossed, not the rectangle around it.

use std::collections::BTreeMap;

use pr_geom::{Point2, SE2, Vector2};
use thiserror::Error;

use crate::beams::Beams;
use crate::bresenham::Cell;
use crate::grid::{Cells, GridConfig, Sweep};

/// Cells along the side of a tile, a power of two.
const SIDE: i32 = 64;

/// Cells farther from the first one have no number.
const FARTHEST: u32 = 1 << 30;

/// Maximum number of cells in tiles: 800 MB, 16 ha of seen area at 5 cm.
pub const MAX_TILED_CELLS: usize = 1 << 26;

/// The area that beams cross needs more cells than the grid may have; the grid is unchanged.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[error("the map needs more than {most} cells of {cell_m} m")]
pub struct TooManyCells {
    /// Maximum number of cells.
    pub most: usize,
    /// Side of a cell, m.
    pub cell_m: f64,
}

/// A tile: log odds, and the scan that updated each cell last.
#[derive(Clone, Debug)]
struct Tile {
    log_odds: Box<[f64]>,
    last_sweep: Box<[u32]>,
}

/// A log-odds occupancy grid without borders; cell (0, 0) has its lower left corner at `min_m` of its configuration.
#[derive(Clone, Debug)]
pub struct TiledGrid {
    config: GridConfig,
    most: usize,
    tiles: Vec<Tile>,
    /// Index of each tile by row and column of tiles.
    numbers: BTreeMap<(i32, i32), usize>,
    /// The tile of the last cell: a ray stays in one for many cells.
    current: Option<((i32, i32), usize)>,
    sweeps: u32,
}

impl TiledGrid {
    /// An unknown grid of at most this number of cells; the upper right corner of the configuration has no effect.
    #[must_use]
    pub fn new(config: GridConfig, most: usize) -> Self {
        Self {
            config,
            most,
            tiles: Vec::new(),
            numbers: BTreeMap::new(),
            current: None,
            sweeps: 0,
        }
    }

    /// Adds one scan as [`OccupancyGrid::integrate`](crate::OccupancyGrid::integrate) does, with ranges up to `reach_m`.
    ///
    /// # Errors
    /// If it could need too many cells; the grid is then unchanged.
    pub fn integrate(
        &mut self,
        world_from_sensor: &SE2,
        beams: &Beams,
        ranges_m: &[f64],
        reach_m: f64,
    ) -> Result<(), TooManyCells> {
        let reach = Vector2::repeat(reach_m + 2.0 * self.config.cell_m);
        let at = world_from_sensor.position();
        let [low, high] = [at - reach, at + reach].map(|corner| self.cell_at(corner));
        let too_many = TooManyCells {
            most: self.most,
            cell_m: self.config.cell_m,
        };
        let is_far = |index: i32| index.unsigned_abs() > FARTHEST;
        if [low.row, low.column, high.row, high.column]
            .into_iter()
            .any(is_far)
        {
            return Err(too_many);
        }
        let [low, high] = [low, high].map(key);
        let side = |low: i32, high: i32| (i64::from(high) - i64::from(low) + 1) as usize;
        let new = side(low.0, high.0).saturating_mul(side(low.1, high.1));
        let tile = (SIDE * SIDE) as usize;
        if (self.tiles.len() + new).saturating_mul(tile) > self.most {
            // Most of them may exist already.
            let rows = if new > self.most / tile {
                low.0..low.0
            } else {
                low.0..high.0 + 1
            };
            let known = rows.map(|row| self.numbers.range((row, low.1)..=(row, high.1)).count());
            let new = new - known.sum::<usize>();
            if (self.tiles.len() + new).saturating_mul(tile) > self.most {
                return Err(too_many);
            }
        }
        self.sweeps += 1;
        let sweep = Sweep {
            config: self.config,
            number: self.sweeps,
            world_from_sensor,
        };
        sweep.integrate(self, beams, ranges_m);
        Ok(())
    }

    /// The cell that contains a point in metres, world frame.
    #[must_use]
    pub fn cell_at(&self, point: Point2<f64>) -> Cell {
        self.config.cell_at(point)
    }

    /// The parameters.
    #[must_use]
    pub fn config(&self) -> &GridConfig {
        &self.config
    }

    /// Log odds of a row of cells from `first` on.
    pub fn row(&self, first: Cell, into: &mut [f64]) {
        into.fill(0.0);
        let mut at = 0;
        while at < into.len() {
            let cell = Cell {
                column: first.column + at as i32,
                ..first
            };
            let count = ((SIDE - (cell.column & (SIDE - 1))) as usize).min(into.len() - at);
            if let Some(&number) = self.numbers.get(&key(cell)) {
                let from = index(cell);
                let log_odds = &self.tiles[number].log_odds[from..from + count];
                into[at..at + count].copy_from_slice(log_odds);
            }
            at += count;
        }
    }
}

impl Cells for TiledGrid {
    fn slot(&mut self, cell: Cell) -> Option<(&mut f64, &mut u32)> {
        let key = key(cell);
        let number = match self.current {
            Some((current, number)) if current == key => number,
            _ => *self.numbers.entry(key).or_insert_with(|| {
                let cells = (SIDE * SIDE) as usize;
                self.tiles.push(Tile {
                    log_odds: vec![0.0; cells].into(),
                    last_sweep: vec![0; cells].into(),
                });
                self.tiles.len() - 1
            }),
        };
        self.current = Some((key, number));
        let (tile, at) = (&mut self.tiles[number], index(cell));
        Some((&mut tile.log_odds[at], &mut tile.last_sweep[at]))
    }
}

/// Row and column of the tile of a cell.
fn key(cell: Cell) -> (i32, i32) {
    (cell.row.div_euclid(SIDE), cell.column.div_euclid(SIDE))
}

/// Index of a cell in its tile.
fn index(cell: Cell) -> usize {
    ((cell.row & (SIDE - 1)) * SIDE + (cell.column & (SIDE - 1))) as usize
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::OccupancyGrid;

    fn beams() -> (Beams, [f64; 4]) {
        let bearings = [-3.0, -1.0, 0.5, 2.0];
        (Beams::new(&bearings), [2.0, 3.0, 1.5, 2.5])
    }

    #[test]
    fn tiles_know_what_a_dense_grid_knows() {
        let poses = [(0.3, 0.2), (-7.0, 4.0), (12.0, -9.0), (12.5, 30.0)];
        let (beams, ranges_m) = beams();
        let config = GridConfig {
            min_m: Point2::new(-50.0, -50.0),
            max_m: Point2::new(50.0, 50.0),
            cell_m: 0.25,
            ..GridConfig::default()
        };
        let mut dense = OccupancyGrid::new(config);
        let mut tiled = TiledGrid::new(config, MAX_TILED_CELLS);
        for (x, y) in poses {
            let pose = SE2::new(x, y, 0.4);
            dense.integrate(&pose, &beams, &ranges_m);
            tiled.integrate(&pose, &beams, &ranges_m, 3.0).unwrap();
        }
        assert!(dense.occupied_cells() > 0);
        let mut row = vec![0.0; dense.columns()];
        for (number, cells) in dense.log_odds().chunks(dense.columns()).enumerate() {
            tiled.row(
                Cell {
                    row: number as i32,
                    column: 0,
                },
                &mut row,
            );
            assert_eq!(row, cells, "row {number}");
        }
    }

    #[test]
    fn two_rooms_far_apart_cost_two_rooms_and_too_many_cells_are_rejected() {
        let (beams, ranges_m) = beams();
        let mut grid = TiledGrid::new(GridConfig::default(), 10 * 64 * 64);
        for x in [0.0, 1e5, 0.0] {
            let pose = SE2::new(x, 0.0, 0.0);
            grid.integrate(&pose, &beams, &ranges_m, 3.0).unwrap();
        }
        let tiles = grid.tiles.len();
        for x in [2e5, 1e300, f64::INFINITY] {
            let pose = SE2::new(x, 0.0, 0.0);
            assert!(grid.integrate(&pose, &beams, &ranges_m, 1e4).is_err());
            assert_eq!(grid.tiles.len(), tiles, "{x}");
        }
    }
}
