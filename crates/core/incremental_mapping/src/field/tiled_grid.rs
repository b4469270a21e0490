//! An unbounded grid that allocates memory only for known cells.

use pr_geom::Point2;
use rustc_hash::FxHashMap;

use super::{FieldSample, bicubic};

/// Cells along the side of a tile.
const SIDE: i32 = 16;
const CELLS: usize = (SIDE * SIDE) as usize;

/// Cells in square tiles; cells without a tile are unknown.
///
/// Cell (i, j) covers `[i, i+1) × [j, j+1)` times its side, from the frame's origin. A tile is allocated
/// with its first known cell, up to a limit, so memory is bounded.
#[derive(Clone, Debug, PartialEq)]
pub struct FieldTiles<T> {
    cell_m: f64,
    unknown: T,
    tiles: Vec<Tile<T>>,
    places: FxHashMap<(i32, i32), u32>,
    max_tiles: usize,
}

#[derive(Clone, Debug, PartialEq)]
struct Tile<T> {
    column: i32,
    row: i32,
    cells: Box<[T; CELLS]>,
}

impl<T: Copy> FieldTiles<T> {
    /// A grid of cells of `cell_m` metres that are all `unknown`; allocates at most `max_cells`.
    #[must_use]
    pub fn new(cell_m: f64, unknown: T, max_cells: usize) -> Self {
        Self {
            cell_m,
            unknown,
            tiles: Vec::new(),
            places: FxHashMap::default(),
            max_tiles: max_cells / CELLS,
        }
    }

    /// Removes all cells.
    pub fn clear(&mut self) {
        self.tiles.clear();
        self.places.clear();
    }

    /// Side of a cell, m.
    #[must_use]
    pub fn cell_m(&self) -> f64 {
        self.cell_m
    }

    /// Number of allocated cells.
    #[must_use]
    pub fn len(&self) -> usize {
        self.tiles.len() * CELLS
    }

    /// Whether no cell is allocated.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.tiles.is_empty()
    }

    /// Column and row of a point; indices saturate for points beyond their range.
    #[must_use]
    pub fn cell_of(&self, point: Point2<f64>) -> (i32, i32) {
        let index = |value: f64| (value / self.cell_m).floor() as i32;
        (index(point.x), index(point.y))
    }

    /// Centre of a cell, m.
    #[must_use]
    pub fn center(&self, (column, row): (i32, i32)) -> Point2<f64> {
        let at = |index: i32| (f64::from(index) + 0.5) * self.cell_m;
        Point2::new(at(column), at(row))
    }

    /// The value of a cell.
    #[must_use]
    pub fn get(&self, (column, row): (i32, i32)) -> T {
        let tile = (column.div_euclid(SIDE), row.div_euclid(SIDE));
        match self.places.get(&tile) {
            Some(&place) => self.tiles[place as usize].cells[within(column, row)],
            None => self.unknown,
        }
    }

    /// A cell for writing; `None` if the limit of cells is reached.
    pub fn get_mut(&mut self, (column, row): (i32, i32)) -> Option<&mut T> {
        let tile = (column.div_euclid(SIDE), row.div_euclid(SIDE));
        let place = match self.places.get(&tile) {
            Some(&place) => place as usize,
            None if self.tiles.len() >= self.max_tiles => return None,
            None => {
                self.places.insert(tile, self.tiles.len() as u32);
                self.tiles.push(Tile {
                    column: tile.0,
                    row: tile.1,
                    cells: Box::new([self.unknown; CELLS]),
                });
                self.tiles.len() - 1
            }
        };
        Some(&mut self.tiles[place].cells[within(column, row)])
    }

    /// All allocated cells with column and row, tile by tile in order of allocation.
    pub fn cells(&self) -> impl Iterator<Item = ((i32, i32), T)> + '_ {
        self.tiles.iter().flat_map(|tile| {
            let (column, row) = (tile.column * SIDE, tile.row * SIDE);
            let cells = tile.cells.iter().enumerate();
            cells.map(move |(k, &cell)| ((column + k as i32 % SIDE, row + k as i32 / SIDE), cell))
        })
    }

    /// Bicubic interpolation of `value` over the cells at a point; the gradient is per metre.
    #[must_use]
    pub fn sample(&self, point: Point2<f64>, value: impl Fn(T) -> f64) -> FieldSample {
        let (x, y) = (point.x / self.cell_m - 0.5, point.y / self.cell_m - 0.5);
        let (column, row) = (x.floor(), y.floor());
        let rows = self.neighbors(column as i32, row as i32, value);
        let found = bicubic(&rows, x - column, y - row);
        FieldSample {
            slope: found.slope / self.cell_m,
            ..found
        }
    }

    /// Four by four values around the corner above a cell.
    fn neighbors(&self, column: i32, row: i32, value: impl Fn(T) -> f64) -> [[f64; 4]; 4] {
        // Points beyond the range of indices lie at its end: their neighbours are themselves.
        let (left, low) = (column.saturating_sub(1), row.saturating_sub(1));
        let (x, y) = (left.rem_euclid(SIDE), low.rem_euclid(SIDE));
        if x + 3 < SIDE && y + 3 < SIDE {
            let tile = (left.div_euclid(SIDE), low.div_euclid(SIDE));
            let Some(&place) = self.places.get(&tile) else {
                return [[value(self.unknown); 4]; 4];
            };
            let cells = &self.tiles[place as usize].cells;
            let first = (y * SIDE + x) as usize;
            return core::array::from_fn(|j| {
                core::array::from_fn(|i| value(cells[first + j * SIDE as usize + i]))
            });
        }
        core::array::from_fn(|j| {
            core::array::from_fn(|i| {
                let cell = (left.saturating_add(i as i32), low.saturating_add(j as i32));
                value(self.get(cell))
            })
        })
    }
}

fn within(column: i32, row: i32) -> usize {
    (row.rem_euclid(SIDE) * SIDE + column.rem_euclid(SIDE)) as usize
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn written_cells_are_read_back_and_others_are_unknown() {
        let mut grid = FieldTiles::new(0.1, -1.0, 1 << 20);
        let cells = [(0, 0), (-1, -1), (15, 16), (-17, 300), (i32::MIN, i32::MAX)];
        for (k, &cell) in cells.iter().enumerate() {
            *grid.get_mut(cell).unwrap() = k as f64;
        }
        for (k, &cell) in cells.iter().enumerate() {
            assert_eq!(grid.get(cell), k as f64);
        }
        assert_eq!(grid.get((1, 0)), -1.0);
        let known: Vec<_> = grid.cells().filter(|(_, value)| *value >= 0.0).collect();
        assert_eq!(known.len(), cells.len());
        assert!(known.iter().all(|(cell, value)| grid.get(*cell) == *value));
    }

    #[test]
    fn cells_beyond_the_limit_are_rejected_and_known_ones_stay() {
        let mut grid = FieldTiles::new(0.1, 0.0, 3 * CELLS);
        for k in 0..3 {
            *grid.get_mut((100 * k, 0)).unwrap() = 1.0;
        }
        assert!(grid.get_mut((300, 0)).is_none());
        assert_eq!(grid.len(), 3 * CELLS);
        assert_eq!(grid.get((200, 0)), 1.0);
        assert!(grid.get_mut((201, 5)).is_some());
    }

    #[test]
    fn the_field_is_smooth_across_the_borders_of_tiles() {
        let mut grid = FieldTiles::new(0.5, 0.0, 1 << 20);
        let plane = |(column, row): (i32, i32)| f64::from(3 * column - 2 * row);
        for column in -20..40 {
            for row in -20..40 {
                *grid.get_mut((column, row)).unwrap() = plane((column, row));
            }
        }
        // A plane: the interpolation is exact, whatever tiles the neighbours lie in.
        for (x, y) in [(0.0, 0.0), (7.9, 8.1), (-0.1, 15.6), (3.3, -7.9)] {
            let found = grid.sample(Point2::new(x, y), |value| value);
            let expected = 3.0 * (x / 0.5 - 0.5) - 2.0 * (y / 0.5 - 0.5);
            assert!((found.value - expected).abs() < 1e-11, "{x} {y}");
            assert!((found.slope.x - 6.0).abs() < 1e-11);
            assert!((found.slope.y + 4.0).abs() < 1e-11);
        }
        for far in [1e300, f64::NAN, f64::INFINITY] {
            // No panic: the value is not finite, and climbs reject it.
            let _ = grid.sample(Point2::new(far, -far), |value| value);
        }
    }
}
