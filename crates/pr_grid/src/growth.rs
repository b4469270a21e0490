//! A grid that grows with the mapped area: for logs, whose extent is unknown beforehand.

use pr_geom::{Point2, Vector2};
use thiserror::Error;

use crate::grid::{GridConfig, OccupancyGrid};

/// The grid grows by whole blocks of this many cells, because growing at every scan would be slow.
const BLOCK: usize = 64;

/// Maximum number of cells of a growing grid: 50 MB, 300 m × 300 m at the chapter's 0.15 m.
pub const MAX_CELLS: usize = 1 << 22;

/// The mapped area needs more cells than a grid may have; the grid is unchanged.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[error(
    "the map needs {columns} × {rows} cells of {cell_m} m, more than {MAX_CELLS}; take larger cells"
)]
pub struct GridTooLarge {
    /// Number of columns that it would have.
    pub columns: u64,
    /// Number of rows that it would have.
    pub rows: u64,
    /// Side of a cell, m.
    pub cell_m: f64,
}

impl GridConfig {
    /// The configuration of a grid without cells at `point`, to be enlarged by
    /// [`OccupancyGrid::cover`].
    #[must_use]
    pub fn growing_from(point: Point2<f64>, cell_m: f64) -> Self {
        Self {
            min_m: point,
            max_m: point,
            cell_m,
            ..Self::default()
        }
    }
}

impl OccupancyGrid {
    /// Enlarges the grid by unknown cells until it contains all points within `reach_m` of `center`
    /// along the axes; known cells keep their values.
    ///
    /// # Errors
    /// If it would have more than [`MAX_CELLS`] cells; it is then unchanged.
    pub fn cover(&mut self, center: Point2<f64>, reach_m: f64) -> Result<(), GridTooLarge> {
        let low = self.cell_at(center - Vector2::repeat(reach_m));
        let high = self.cell_at(center + Vector2::repeat(reach_m));
        let more = |outside: i64| (outside.max(0) as u64).next_multiple_of(BLOCK as u64);
        let (columns, rows) = (self.columns(), self.rows());
        let beyond = |cell: i32, count: usize| more(i64::from(cell) + 1 - count as i64);
        let (west, east) = (more(-i64::from(low.column)), beyond(high.column, columns));
        let (south, north) = (more(-i64::from(low.row)), beyond(high.row, rows));
        if west + east + south + north == 0 {
            return Ok(());
        }
        let (wider, taller) = (west + columns as u64 + east, south + rows as u64 + north);
        if wider.saturating_mul(taller) > MAX_CELLS as u64 {
            return Err(GridTooLarge {
                columns: wider,
                rows: taller,
                cell_m: self.config().cell_m,
            });
        }
        self.grow(
            (west as usize, south as usize),
            (wider as usize, taller as usize),
        );
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use pr_geom::SE2;

    use super::*;
    use crate::beams::Beams;

    fn beams() -> (Beams, [f64; 4]) {
        let bearings = [-3.0, -1.0, 0.5, 2.0];
        (Beams::new(&bearings), [2.0, 3.0, 1.5, 2.5])
    }

    #[test]
    fn a_grid_that_grows_knows_what_a_large_one_knows() {
        let poses = [(0.3, 0.2), (-7.0, 4.0), (12.0, -9.0), (12.5, 30.0)];
        let poses = poses.map(|(x, y)| SE2::new(x, y, 0.4));
        let (beams, ranges_m) = beams();
        let mut grown = OccupancyGrid::new(GridConfig::growing_from(Point2::origin(), 0.25));
        let mut large = OccupancyGrid::new(GridConfig {
            min_m: Point2::new(-50.0, -50.0),
            max_m: Point2::new(50.0, 50.0),
            cell_m: 0.25,
            ..GridConfig::default()
        });
        for pose in &poses {
            grown.cover(pose.position(), 4.0).unwrap();
            grown.integrate(pose, &beams, &ranges_m);
            large.integrate(pose, &beams, &ranges_m);
        }
        assert!(grown.occupied_cells() > 0 && grown.log_odds().len() < large.log_odds().len());
        assert_eq!(grown.occupied_cells(), large.occupied_cells());
        assert_eq!(grown.free_cells(), large.free_cells());
        for row in 0..large.rows() {
            for column in 0..large.columns() {
                let value = large.log_odds()[row * large.columns() + column];
                let center = large.center(crate::Cell {
                    column: column as i32,
                    row: row as i32,
                });
                let here = grown.index(grown.cell_at(center));
                assert_eq!(here.map_or(0.0, |index| grown.log_odds()[index]), value);
            }
        }
    }

    #[test]
    fn a_map_beyond_the_budget_is_refused_and_the_grid_stays() {
        let mut grid = OccupancyGrid::new(GridConfig::growing_from(Point2::origin(), 0.15));
        grid.cover(Point2::origin(), 6.0).unwrap();
        let cells = grid.log_odds().len();
        for far in [1e4, 1e300, f64::INFINITY] {
            let refused = grid.cover(Point2::new(far, far), 6.0).unwrap_err();
            assert!(refused.columns > 20_000);
            assert_eq!(grid.log_odds().len(), cells);
        }
        grid.cover(Point2::new(20.0, 0.0), 6.0).unwrap();
    }
}
