//! Index of the points of each cell in a sorted array.

use core::ops::Range;

use pr_geom::math;

use super::PointCloud;

/// Largest number of cells for every point; beyond that the table gets coarser cells.
const CELLS_PER_POINT: i64 = 64;

/// Cells for every point if the table may choose: along a wall, a few points in each.
const CHOSEN_CELLS_PER_POINT: f64 = 3.0;

/// Chosen cells are larger than this, m, so that squared distances between neighbouring cells do not underflow
/// and ties can be detected.
const MIN_CHOSEN_M: f64 = 1e-150;

/// Start of each cell's run of points.
#[derive(Clone, Debug, Default)]
pub(super) struct CellTable {
    /// Cells joined along one side of a table cell: 1 unless the extent is very large.
    pub(super) factor: i32,
    origin: (i32, i32),
    columns: usize,
    rows: usize,
    /// Width of a table cell, m.
    pub(super) cell_m: f64,
    per_metre: f64,
    /// `starts[column * rows + row]..starts[column * rows + row + 1]` are the points of a cell.
    pub(super) starts: Vec<u32>,
}

/// A cell size for which a table of `cloud` has a few points in each occupied cell, m.
pub(super) fn free_cell_m(cloud: &PointCloud) -> Option<f64> {
    let span = |values: &[f64]| {
        let (low, high) = finite_range(values);
        high - low
    };
    let (width, height) = (span(cloud.xs()), span(cloud.ys()));
    let cells = CHOSEN_CELLS_PER_POINT * cloud.len() as f64;
    let cell_m = math::sqrt(width * height / cells).max((width + height) / cells);
    (cell_m > MIN_CHOSEN_M && cell_m.is_finite()).then_some(cell_m)
}

impl CellTable {
    /// Lays out an empty table for cells `low` to `high` of `cell_m`, inclusive.
    pub(super) fn clear(&mut self, low: (i32, i32), high: (i32, i32), cell_m: f64, points: usize) {
        let budget = CELLS_PER_POINT * points as i64 + 1024;
        let extent = |low: i32, high: i32, factor: i32| {
            if low > high {
                return 0;
            }
            i64::from(high.div_euclid(factor)) - i64::from(low.div_euclid(factor)) + 1
        };
        self.factor = 1;
        while extent(low.0, high.0, self.factor).saturating_mul(extent(low.1, high.1, self.factor))
            > budget
        {
            self.factor *= 2;
        }
        self.columns = extent(low.0, high.0, self.factor) as usize;
        self.rows = extent(low.1, high.1, self.factor) as usize;
        self.origin = (low.0.div_euclid(self.factor), low.1.div_euclid(self.factor));
        self.cell_m = cell_m * f64::from(self.factor);
        self.per_metre = 1.0 / self.cell_m;
        self.starts.clear();
        self.starts.resize(self.columns * self.rows + 1, 0);
    }

    #[inline]
    /// Index in `starts` of the table cell that contains a cell.
    pub(super) fn slot(&self, (i, j): (i32, i32)) -> usize {
        // Divisions dominate the cost here, and almost always they are by 1.
        let (i, j) = match self.factor {
            1 => (i, j),
            factor => (i.div_euclid(factor), j.div_euclid(factor)),
        };
        (i - self.origin.0) as usize * self.rows + (j - self.origin.1) as usize
    }

    /// First and last table index, of `count`, that `center ± reach` touches.
    #[inline]
    fn range(&self, center: f64, reach: f64, origin: i32, count: usize) -> Option<(usize, usize)> {
        let low = (center - reach) * self.per_metre - f64::from(origin);
        let high = (center + reach) * self.per_metre - f64::from(origin);
        // Written so that a NaN query touches no cell.
        if !(high >= 0.0 && low < count as f64) {
            return self.outermost(low, high, origin, count);
        }
        // The casts saturate at zero; through u32 they are single instructions.
        Some((low as u32 as usize, (high as u32 as usize).min(count - 1)))
    }

    /// The table index that a range beyond the table still touches: the cell at either end of all cells
    /// also holds everything farther out, see [`cell_index`](super::cell_index).
    #[cold]
    fn outermost(&self, low: f64, high: f64, origin: i32, count: usize) -> Option<(usize, usize)> {
        let last = count.checked_sub(1)?;
        let end = i64::from(origin) + last as i64;
        if high < 0.0 && origin == i32::MIN.div_euclid(self.factor) {
            Some((0, 0))
        } else if low >= count as f64 && end == i64::from(i32::MAX.div_euclid(self.factor)) {
            Some((last, last))
        } else {
            None
        }
    }

    /// Calls `visit` with the run of points of every column that the box touches, x ascending.
    #[inline]
    pub(super) fn for_each_run(
        &self,
        x: f64,
        y: f64,
        reach: f64,
        mut visit: impl FnMut(Range<usize>),
    ) {
        let Some((west, east)) = self.range(x, reach, self.origin.0, self.columns) else {
            return;
        };
        let Some((south, north)) = self.range(y, reach, self.origin.1, self.rows) else {
            return;
        };
        for column in west..=east {
            let base = column * self.rows;
            let run = self.starts[base + south] as usize..self.starts[base + north + 1] as usize;
            visit(run);
        }
    }
}

/// Smallest and largest of the finite values; ∞ and −∞ if there are none.
pub(super) fn finite_range(values: &[f64]) -> (f64, f64) {
    let finite = values.iter().filter(|value| value.is_finite());
    finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &value| {
        (
            if value < low { value } else { low },
            if value > high { value } else { high },
        )
    })
}
