//! The scores of all poses of a window, which a search avoids to compute: the picture below it.

use ch16_slam2d::search::ScanSearch;

/// Stride of the first pass over the headings, a power of two: a coarse surface appears early.
const FIRST_STRIDE: usize = 16;

/// The best score at each position, filled one row of positions at a time.
#[derive(Clone, Debug, PartialEq)]
pub struct ScoreSurface {
    by_place: Vec<f64>,
    /// Headings in the order in which they are scored.
    order: Vec<usize>,
    columns: usize,
    rows_done: usize,
}

impl ScoreSurface {
    /// A surface without scores.
    #[must_use]
    pub fn new(search: &ScanSearch) -> Self {
        let headings = search.headings();
        let [rows, columns] = search.places();
        let strides = core::iter::successors(Some(FIRST_STRIDE), |stride| Some(stride / 2));
        let order = strides.take_while(|stride| *stride > 0).flat_map(|stride| {
            let on_grid = (0..headings).step_by(stride);
            // Those of the earlier stride are done.
            on_grid.filter(move |heading| stride == FIRST_STRIDE || heading % (2 * stride) != 0)
        });
        Self {
            by_place: vec![0.0; rows * columns],
            order: order.collect(),
            columns,
            rows_done: 0,
        }
    }

    /// Scores one row of positions at one heading; false once all are scored.
    pub fn advance(&mut self, search: &ScanSearch) -> bool {
        let rows = self.by_place.len() / self.columns;
        let Some(&heading) = self.order.get(self.rows_done / rows) else {
            return false;
        };
        let row = self.rows_done % rows;
        let places = &mut self.by_place[row * self.columns..][..self.columns];
        for (place, score) in places.iter_mut().zip(search.row_scores(heading, row)) {
            *place = place.max(score);
        }
        self.rows_done += 1;
        true
    }

    /// The best score over all headings so far, row by row from the lowest y.
    #[must_use]
    pub fn by_place(&self) -> &[f64] {
        &self.by_place
    }

    /// Number of rows so far; it changes whenever a score may have changed.
    #[must_use]
    pub fn rows_done(&self) -> usize {
        self.rows_done
    }

    /// Share of the poses that are scored.
    #[must_use]
    pub fn progress(&self) -> f64 {
        let rows = self.by_place.len() / self.columns;
        self.rows_done as f64 / (rows * self.order.len()) as f64
    }
}

#[cfg(test)]
mod tests {
    use super::super::{WindowConfig, WindowSearch};
    use super::*;
    use crate::basin::BasinScene;

    #[test]
    fn its_peak_is_what_the_search_finds_without_it() {
        let config = WindowConfig {
            cell_m: 0.2,
            half_width_m: 1.0,
            ..WindowConfig::default()
        };
        let window = WindowSearch::new(&BasinScene::new(), config).unwrap().run();
        let mut surface = ScoreSurface::new(window.search());
        while surface.advance(window.search()) {}
        assert_eq!(surface.progress(), 1.0);
        let peak = surface.by_place().iter().copied().fold(0.0, f64::max);
        assert_eq!(peak, window.result().unwrap().best.score);
    }
}
