//! The grid and the largest scores of squares of increasing size.

use super::score_scale::FULL_SCORE;
use super::{LikelihoodConfig, LikelihoodGrid, SearchError};
use crate::cloud::PointCloud;

/// Levels of a map: the squares of the last one have `2^(LEVELS−1)` cells a side.
pub(super) const LEVELS: usize = 7;

/// Number of points that are looked up together, for vectorized index computation.
pub(super) const BATCH: usize = 64;

/// Squares of a row that are loaded at once: those of neighbouring boxes are among them.
const LANES: usize = 16;

/// Largest side of boxes whose neighbours are summed with them, in cells; wider ones are few.
pub(super) const NEAR_SIDE: i32 = 4;

/// A map for searches: the grid and its sliding maxima.
///
/// Level h holds for every cell (i, j) the largest score of the cells `[i, i + 2^h) × [j, j + 2^h)`
/// (Hess et al. 2016, §IV-D). The score outside of the grid is 0.
#[derive(Clone, Debug)]
pub struct SearchMap {
    grid: LikelihoodGrid,
    levels: Vec<Level>,
}

/// The maxima for one size of squares, for all squares that touch the grid, with a border of zeros that holds the
/// neighbours of a square beside it.
#[derive(Clone, Debug)]
pub(super) struct Level {
    /// Side of a square in cells.
    side: i16,
    /// Index of the grid's own first cell in a row and in a column.
    margin: i16,
    columns: i16,
    rows: i16,
    /// A row starts every `2^row_shift` entries, because a shift is cheaper than a product.
    row_shift: u32,
    maxima: Vec<u8>,
}

/// Cells of at most one [`BATCH`] of points, one array for each axis.
#[derive(Clone, Copy)]
pub(super) struct CellSlice<'a> {
    pub columns: &'a [i16],
    pub rows: &'a [i16],
}

impl SearchMap {
    /// The map of the finite points of `map`.
    ///
    /// # Errors
    /// If [`LikelihoodGrid::build`] fails.
    pub fn build(map: &PointCloud, config: LikelihoodConfig) -> Result<Self, SearchError> {
        Ok(Self::new(LikelihoodGrid::build(map, config)?))
    }

    /// The map of a grid.
    #[must_use]
    pub fn new(grid: LikelihoodGrid) -> Self {
        let mut levels = vec![Level::base(&grid)];
        for _ in 1..LEVELS {
            let finer = levels.last().expect("the first level is there");
            levels.push(finer.doubled());
        }
        Self { grid, levels }
    }

    /// The grid.
    #[must_use]
    pub fn grid(&self) -> &LikelihoodGrid {
        &self.grid
    }

    /// The largest score in the square of `2^level` cells a side whose lower left cell is this one.
    #[must_use]
    pub fn largest(&self, level: usize, column: i16, row: i16) -> u8 {
        match self.levels.get(level) {
            Some(level) => level.at(column, row),
            None => FULL_SCORE,
        }
    }

    pub(super) fn level(&self, level: usize) -> &Level {
        &self.levels[level]
    }
}

impl Level {
    /// The grid itself, with a border of one cell of score 0.
    fn base(grid: &LikelihoodGrid) -> Self {
        let mut level = Self::without_squares(1, grid.columns(), grid.rows());
        level.maxima.resize(level.size(), 0);
        let (stride, margin) = (level.stride(), level.margin as usize);
        for (row, scores) in grid.scores().chunks_exact(grid.columns()).enumerate() {
            let start = (row + margin) * stride + margin;
            level.maxima[start..][..scores.len()].copy_from_slice(scores);
        }
        level
    }

    /// Allocates squares of `side` cells a side that touch a grid of `columns` × `rows`, without maxima.
    fn without_squares(side: usize, columns: usize, rows: usize) -> Self {
        let margin = side + NEAR_SIDE as usize;
        let stride = (columns + margin + LANES).next_power_of_two();
        Self {
            side: side as i16,
            margin: margin as i16,
            columns: columns as i16,
            rows: rows as i16,
            row_shift: stride.ilog2(),
            maxima: Vec::with_capacity(stride * (rows + margin + side + 1)),
        }
    }

    /// Number of squares, including the padding of the rows.
    fn size(&self) -> usize {
        self.stride() * (self.rows + self.margin + self.side + 1) as usize
    }

    fn stride(&self) -> usize {
        1 << self.row_shift
    }

    /// The maxima of squares of twice the side: each is the maximum of four squares of this level.
    fn doubled(&self) -> Self {
        let step = self.side as usize;
        let (columns, rows) = (self.columns as usize, self.rows as usize);
        let mut wider = Self::without_squares(2 * step, columns, rows);
        let stride = wider.stride();
        let used = columns + self.margin as usize + 1;
        for from in self.maxima.chunks_exact(self.stride()) {
            let start = wider.maxima.len();
            wider.maxima.extend_from_slice(&from[..used]);
            wider.maxima.resize(start + stride, 0);
            raise(&mut wider.maxima[start + step..], &from[..used]);
        }
        wider.maxima.resize(wider.size(), 0);
        // From the top down, so that no row is raised by one that was already raised.
        let height = rows + wider.margin as usize + 1;
        for row in (step..height).rev() {
            let (below, above) = wider.maxima.split_at_mut(row * stride);
            raise(
                &mut above[..stride],
                &below[(row - step) * stride..][..stride],
            );
        }
        wider
    }

    /// The sum of the maxima at all cells, shifted by an offset in columns and rows.
    pub(super) fn sum(&self, cells: CellSlice<'_>, offset: [i16; 2]) -> u32 {
        let (mut in_row, mut rows) = ([0; BATCH], [0; BATCH]);
        self.locate_columns(cells.columns, offset[0], &mut in_row);
        self.locate_rows(cells.rows, offset[1], &mut rows);
        let places = in_row.iter().zip(&rows).take(cells.columns.len());
        places
            .map(|(column, row)| u32::from(self.maxima[(row + column) as usize]))
            .sum()
    }

    /// The sum of the maxima over areas whose corner squares start at these cells, with the same shift.
    pub(super) fn sum_of_areas(
        &self,
        low: CellSlice<'_>,
        high: CellSlice<'_>,
        offset: [i16; 2],
    ) -> u32 {
        let (mut left, mut right) = ([0; BATCH], [0; BATCH]);
        let (mut bottom, mut top) = ([0; BATCH], [0; BATCH]);
        self.locate_columns(low.columns, offset[0], &mut left);
        self.locate_columns(high.columns, offset[0], &mut right);
        self.locate_rows(low.rows, offset[1], &mut bottom);
        self.locate_rows(high.rows, offset[1], &mut top);
        let columns = left.iter().zip(&right);
        let rows = bottom.iter().zip(&top);
        let areas = columns.zip(rows).take(low.columns.len());
        areas
            .map(|((&left, &right), (&bottom, &top))| {
                let at = |row: u32, column: u32| self.maxima[(row + column) as usize];
                let lower = at(bottom, left).max(at(bottom, right));
                let upper = at(top, left).max(at(top, right));
                u32::from(lower.max(upper))
            })
            .sum()
    }

    /// The sums of [`Level::sum`] or [`Level::sum_of_areas`] at an offset, and at those `step` cells to the right, above
    /// and both, of at most [`NEAR_SIDE`] cells.
    pub(super) fn sums_of_four(
        &self,
        low: CellSlice<'_>,
        high: Option<CellSlice<'_>>,
        offset: [i16; 2],
        step: usize,
    ) -> [u32; 4] {
        let (mut left, mut bottom) = ([0; BATCH], [0; BATCH]);
        self.locate_columns(low.columns, offset[0], &mut left);
        self.locate_rows(low.rows, offset[1], &mut bottom);
        let above = step << self.row_shift;
        let squares = |place: usize| -> &[u8; LANES] {
            let row = self.maxima[place..].first_chunk();
            row.expect("a row is longer")
        };
        // Two sums of 16 bits each: a batch is too short for them to overflow.
        let pair = |squares: &[u8; LANES]| {
            u32::from(squares[0]) | (u32::from(squares[step % LANES]) << 16)
        };
        let mut sums = [0_u32; 2];
        let count = low.columns.len();
        if let Some(high) = high {
            let (mut right, mut top) = ([0; BATCH], [0; BATCH]);
            self.locate_columns(high.columns, offset[0], &mut right);
            self.locate_rows(high.rows, offset[1], &mut top);
            let columns = left.iter().zip(&right);
            let rows = bottom.iter().zip(&top);
            for ((&left, &right), (&bottom, &top)) in columns.zip(rows).take(count) {
                for (sum, up) in sums.iter_mut().zip([0, above]) {
                    let at =
                        |row: u32, column: u32| squares(row.wrapping_add(column) as usize + up);
                    let mut largest = *at(bottom, left);
                    raise(&mut largest, at(bottom, right));
                    raise(&mut largest, at(top, left));
                    raise(&mut largest, at(top, right));
                    *sum = sum.wrapping_add(pair(&largest));
                }
            }
        } else {
            for (&left, &bottom) in left.iter().zip(&bottom).take(count) {
                let place = bottom.wrapping_add(left) as usize;
                for (sum, up) in sums.iter_mut().zip([0, above]) {
                    *sum = sum.wrapping_add(pair(squares(place + up)));
                }
            }
        }
        let [here, above] = sums;
        [here & 0xFFFF, here >> 16, above & 0xFFFF, above >> 16]
    }

    /// Indices of columns in a row. All squares beyond the border are zero.
    #[inline]
    fn locate_columns(&self, columns: &[i16], offset: i16, places: &mut [u32; BATCH]) {
        for (place, column) in places.iter_mut().zip(columns) {
            let column = column
                .wrapping_add(offset)
                .clamp(-self.margin, self.columns);
            let column = column.wrapping_add(self.margin);
            *place = u32::from(column as u16);
        }
    }

    /// Indices of the first square of rows.
    #[inline]
    fn locate_rows(&self, rows: &[i16], offset: i16, places: &mut [u32; BATCH]) {
        for (place, row) in places.iter_mut().zip(rows) {
            let row = row.wrapping_add(offset).clamp(-self.margin, self.rows);
            let row = row.wrapping_add(self.margin);
            *place = u32::from(row as u16) << self.row_shift;
        }
    }

    /// The maximum of the square whose lower left cell is this one.
    fn at(&self, column: i16, row: i16) -> u8 {
        let cells = CellSlice {
            columns: &[column],
            rows: &[row],
        };
        self.sum(cells, [0, 0]) as u8
    }
}

fn raise(to: &mut [u8], from: &[u8]) {
    for (to, &from) in to.iter_mut().zip(from) {
        *to = (*to).max(from);
    }
}

#[cfg(test)]
mod tests {
    use pr_geom::Point2;

    use super::*;

    #[test]
    fn every_level_holds_the_largest_score_of_its_squares() {
        let points = [(0.0, 0.0), (0.33, 0.21), (0.4, -0.3), (-0.52, 0.6)];
        let cloud = points.map(|(x, y)| Point2::new(x, y)).into_iter().collect();
        let map = SearchMap::build(&cloud, LikelihoodConfig::default()).unwrap();
        let grid = map.grid();
        let (columns, rows) = (grid.columns() as i16, grid.rows() as i16);
        let score = |column: i16, row: i16| {
            let is_inside = (0..columns).contains(&column) && (0..rows).contains(&row);
            if is_inside {
                grid.scores()[row as usize * grid.columns() + column as usize]
            } else {
                0
            }
        };
        for level in 0..LEVELS {
            let side = 1_i16 << level;
            for row in (-side - 2..rows + 3).step_by(3) {
                for column in (-side - 2..columns + 3).step_by(3) {
                    let square = (0..side).flat_map(|j| (0..side).map(move |i| (i, j)));
                    let largest = square.map(|(i, j)| score(column + i, row + j)).max();
                    assert_eq!(Some(map.largest(level, column, row)), largest);
                }
            }
        }
        assert_eq!(map.largest(LEVELS, 0, 0), FULL_SCORE);
    }
}
