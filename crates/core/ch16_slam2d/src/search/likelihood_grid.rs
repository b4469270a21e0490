//! The likelihood grid: scores of cells by their distance to the map's points.

use pr_geom::{Point2, math};

use super::score_scale::{FARTHEST_SIGMAS, ScoreScale};
use super::{MAX_GRID_CELLS, SearchError};
use crate::cloud::{PointCloud, cell_index};

/// Largest number of columns and of rows: a cell's index fits into 16 bits, including a window's width.
const MAX_SIDE_CELLS: u64 = 16_000;

/// Cells and blur of a [`LikelihoodGrid`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LikelihoodConfig {
    /// Side of a cell, m, which is also the resolution of the search.
    pub cell_m: f64,
    /// Standard deviation of the blur around a point, m: noise of the ranges and half a cell.
    pub sigma_m: f64,
}

impl Default for LikelihoodConfig {
    fn default() -> Self {
        Self {
            cell_m: 0.05,
            sigma_m: 0.08,
        }
    }
}

/// Scores of all cells around a map's points, 0 to 255.
///
/// A cell whose centre is d metres from the nearest point has the score `255 exp(−d²/(2σ²))`,
/// rounded; beyond 3 σ it is 0. The cells tile the map's frame from its origin, so a distant
/// point does not change nearby scores.
#[derive(Clone, Debug, PartialEq)]
pub struct LikelihoodGrid {
    config: LikelihoodConfig,
    first_column: i32,
    first_row: i32,
    columns: usize,
    rows: usize,
    scores: Vec<u8>,
}

impl LikelihoodGrid {
    /// The grid of the finite points of `map`.
    ///
    /// # Errors
    /// If the map has no such points or needs more than [`MAX_GRID_CELLS`].
    pub fn build(map: &PointCloud, config: LikelihoodConfig) -> Result<Self, SearchError> {
        let LikelihoodConfig { cell_m, sigma_m } = config;
        let is_length = |length: f64| length > 0.0 && length.is_finite();
        if !is_length(cell_m) || !is_length(sigma_m) {
            return Err(SearchError::NoCells { cell_m, sigma_m });
        }
        let points = || {
            map.iter()
                .filter(|point| point.x.is_finite() && point.y.is_finite())
        };
        let mut low = (i64::MAX, i64::MAX);
        let mut high = (i64::MIN, i64::MIN);
        for point in points() {
            let column = i64::from(cell_index(point.x, cell_m));
            let row = i64::from(cell_index(point.y, cell_m));
            low = (low.0.min(column), low.1.min(row));
            high = (high.0.max(column), high.1.max(row));
        }
        if low.0 > high.0 {
            return Err(SearchError::EmptyMap);
        }
        let reach = (FARTHEST_SIGMAS * sigma_m / cell_m)
            .ceil()
            .min(f64::from(i32::MAX)) as i64;
        let columns = (high.0 - low.0 + 1 + 2 * reach) as u64;
        let rows = (high.1 - low.1 + 1 + 2 * reach) as u64;
        if columns.saturating_mul(rows) > MAX_GRID_CELLS || columns.max(rows) > MAX_SIDE_CELLS {
            return Err(SearchError::MapTooLarge {
                columns,
                rows,
                cell_m,
            });
        }
        let mut grid = Self {
            config,
            // Within the range of a cell's index: the grid is smaller than that, and so is its reach.
            first_column: (low.0 - reach).max(i64::from(i32::MIN)) as i32,
            first_row: (low.1 - reach).max(i64::from(i32::MIN)) as i32,
            columns: columns as usize,
            rows: rows as usize,
            scores: Vec::new(),
        };
        grid.scores = grid.scored(points(), reach as usize);
        Ok(grid)
    }

    /// Computes squared distances first, then one lookup in the scale for each cell.
    fn scored(&self, points: impl Iterator<Item = Point2<f64>>, reach: usize) -> Vec<u8> {
        let cell_m = self.config.cell_m;
        let mut nearest_m2 = vec![f64::INFINITY; self.columns * self.rows];
        let mut gaps_m2 = vec![0.0; 2 * reach + 1];
        for point in points {
            let column = self.column_of(point.x).saturating_sub(reach);
            let row = self.row_of(point.y).saturating_sub(reach);
            let last_column = (column + 2 * reach).min(self.columns - 1);
            for (gap, k) in gaps_m2.iter_mut().zip(column..=last_column) {
                let x = (f64::from(self.first_column) + k as f64 + 0.5) * cell_m - point.x;
                *gap = x * x;
            }
            for k in row..=(row + 2 * reach).min(self.rows - 1) {
                let y = (f64::from(self.first_row) + k as f64 + 0.5) * cell_m - point.y;
                let cells = &mut nearest_m2[k * self.columns..][column..=last_column];
                for (cell, gap) in cells.iter_mut().zip(&gaps_m2) {
                    *cell = math::min(*cell, gap + y * y);
                }
            }
        }
        let scale = ScoreScale::new(self.config.sigma_m);
        nearest_m2.iter().map(|&d2| scale.score(d2)).collect()
    }

    fn column_of(&self, x_m: f64) -> usize {
        (cell_index(x_m, self.config.cell_m) - self.first_column) as usize
    }

    fn row_of(&self, y_m: f64) -> usize {
        (cell_index(y_m, self.config.cell_m) - self.first_row) as usize
    }

    /// Cells and blur.
    #[must_use]
    pub fn config(&self) -> &LikelihoodConfig {
        &self.config
    }

    /// Lower left corner, m, in the map's frame.
    #[must_use]
    pub fn min_m(&self) -> Point2<f64> {
        let at = |first: i32| f64::from(first) * self.config.cell_m;
        Point2::new(at(self.first_column), at(self.first_row))
    }

    /// Upper right corner, m, in the map's frame.
    #[must_use]
    pub fn max_m(&self) -> Point2<f64> {
        let at = |first: i32, count: usize| (f64::from(first) + count as f64) * self.config.cell_m;
        Point2::new(
            at(self.first_column, self.columns),
            at(self.first_row, self.rows),
        )
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

    /// Scores of all cells, row by row from the lowest y.
    #[must_use]
    pub fn scores(&self) -> &[u8] {
        &self.scores
    }

    /// Column and row of its lower left cell, counted from the origin.
    pub(super) fn first_cell(&self) -> [i32; 2] {
        [self.first_column, self.first_row]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CONFIG: LikelihoodConfig = LikelihoodConfig {
        cell_m: 0.1,
        sigma_m: 0.2,
    };

    fn grid(points: &[(f64, f64)]) -> LikelihoodGrid {
        let cloud = points.iter().map(|&(x, y)| Point2::new(x, y)).collect();
        LikelihoodGrid::build(&cloud, CONFIG).unwrap()
    }

    fn score(grid: &LikelihoodGrid, x: f64, y: f64) -> u8 {
        grid.scores()[grid.row_of(y) * grid.columns() + grid.column_of(x)]
    }

    #[test]
    fn a_score_is_the_gaussian_of_the_distance_from_the_nearest_point() {
        let grid = grid(&[(0.05, 0.05), (1.05, 0.05)]);
        assert_eq!(score(&grid, 0.05, 0.05), 255);
        // 255 exp(−1/2) = 154.7 and 255 exp(−2) = 34.5 at one and two σ.
        assert_eq!(score(&grid, 0.25, 0.05), 155);
        assert_eq!(score(&grid, 0.05, -0.35), 35);
        // In the middle of both, half a metre away from either.
        assert_eq!(score(&grid, 0.55, 0.05), 11);
    }

    #[test]
    fn a_distant_point_changes_no_local_score() {
        let (one, two) = (grid(&[(-0.31, 0.07)]), grid(&[(-0.31, 0.07), (4.0, -3.0)]));
        for k in -6..6 {
            let (x, y) = (-0.31 + 0.1 * f64::from(k), 0.07 - 0.05 * f64::from(k));
            assert_eq!(score(&one, x, y), score(&two, x, y));
        }
    }

    #[test]
    fn empty_and_too_large_maps_are_rejected() {
        let build = |cloud: &PointCloud, config| LikelihoodGrid::build(cloud, config).unwrap_err();
        let nothing = [Point2::new(f64::NAN, 0.0)].into_iter().collect();
        assert_eq!(build(&nothing, CONFIG), SearchError::EmptyMap);
        let wide = [Point2::new(-1e300, 0.0), Point2::new(1e300, 1.0)];
        assert!(matches!(
            build(&wide.into_iter().collect(), CONFIG),
            SearchError::MapTooLarge { .. }
        ));
        let none = LikelihoodConfig {
            cell_m: 0.0,
            ..CONFIG
        };
        assert!(matches!(build(&nothing, none), SearchError::NoCells { .. }));
    }

    #[test]
    fn a_map_at_the_limit_of_cell_indices_has_its_scores() {
        let far = [Point2::new(-1e300, 1e300)].into_iter().collect();
        let grid = LikelihoodGrid::build(&far, CONFIG).unwrap();
        assert!(grid.columns() * grid.rows() < 400);
    }
}
