//! One measure over all shifts, ready to draw, with the ball that was dropped on it.

use pr_geom::sort_numbers;

use crate::w16_3_cost_terraces::spec::Colors;
use crate::w16_3_cost_terraces::spec::HALF_SPAN_M;

/// A ball that stops this close to the truth counts as a success, m: the limit of the chapter's basin runs.
const HOME_M: f64 = 0.12;

/// Heights on a square grid over ±1.3 m, row by row from the smallest Δy; low is good.
#[derive(Clone, Debug)]
pub struct Landscape {
    /// The level of each cell's colour, from dark to bright: [`Landscape::color`].
    pub levels: Vec<f32>,
    /// Lowest and highest height, zero included.
    pub range: [f64; 2],
    /// Shift of the lowest cell, m.
    pub lowest_m: [f64; 2],
    /// The ball that was dropped at the crosshair.
    pub ball: BallPath,
    /// Heights from its end straight on to the truth, as `[distance from the end (m), height]`.
    pub ahead: Vec<[f64; 2]>,
    /// Heights close around its end on that line, as `[distance ahead of the end (m), height]`; none if it is home.
    pub around: Vec<[f64; 2]>,
    heights: Vec<f64>,
    cells: usize,
}

/// The path of a ball.
#[derive(Clone, Debug, PartialEq)]
pub struct BallPath {
    /// Shift after every step, the drop first, m; never empty.
    pub path_m: Vec<[f64; 2]>,
    /// Height after every step.
    pub heights: Vec<f64>,
    /// Why it ended.
    pub end: End,
}

/// Why the path of a ball ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// The ball is on level ground or in a hollow.
    Rests,
    /// It was still rolling at the limit of steps.
    OutOfSteps,
}

impl BallPath {
    /// A ball that stops where it was dropped.
    pub fn at(shift_m: [f64; 2], height: f64) -> Self {
        Self {
            path_m: vec![shift_m],
            heights: vec![height],
            end: End::Rests,
        }
    }

    /// Number of steps.
    pub fn steps(&self) -> usize {
        self.path_m.len() - 1
    }

    /// Distance from the drop along the path after every step, m.
    pub fn rolled_m(&self) -> Vec<f64> {
        let mut rolled = vec![0.0];
        for pair in self.path_m.windows(2) {
            let [from, to] = [pair[0], pair[1]];
            let step_m = pr_geom::math::norm2(to[0] - from[0], to[1] - from[1]);
            rolled.push(rolled[rolled.len() - 1] + step_m);
        }
        rolled
    }

    /// Final shift, m.
    pub fn end_m(&self) -> [f64; 2] {
        self.path_m[self.steps()]
    }

    /// Shift after that many steps, or the final one, m.
    pub fn at_step(&self, step: usize) -> [f64; 2] {
        self.path_m[step.min(self.steps())]
    }

    /// Distance of its final shift from the truth, m.
    pub fn rest_distance_m(&self) -> f64 {
        let [x, y] = self.end_m();
        pr_geom::math::norm2(x, y)
    }

    /// Whether it stopped at the truth.
    pub fn is_home(&self) -> bool {
        self.rest_distance_m() < HOME_M
    }
}

impl Landscape {
    /// A landscape without heights.
    pub fn flat() -> Self {
        Self {
            levels: Vec::new(),
            range: [0.0, 1.0],
            lowest_m: [0.0, 0.0],
            ball: BallPath::at([0.0, 0.0], 0.0),
            ahead: Vec::new(),
            around: Vec::new(),
            heights: Vec::new(),
            cells: 0,
        }
    }

    /// Sets new heights, `cells` on a side; [`Landscape::color`] updates the levels.
    ///
    /// # Panics
    /// If there are not `cells × cells` heights.
    pub fn renew(&mut self, cells: usize, heights: impl Iterator<Item = f64>) {
        self.heights.clear();
        self.heights.extend(heights);
        assert_eq!(
            self.heights.len(),
            cells * cells,
            "one height for every cell"
        );
        let heights = self.heights.iter().copied();
        self.range = [
            heights.clone().fold(0.0, f64::min),
            heights.fold(0.0, f64::max),
        ];
        let mut best = 0;
        for (index, height) in self.heights.iter().enumerate() {
            if *height < self.heights[best] {
                best = index;
            }
        }
        self.lowest_m = [best % cells, best / cells].map(|k| shift_m(cells, k));
        self.cells = cells;
    }

    /// A height as a share of the whole range: the same scale for every measure.
    pub fn share(&self, height: f64) -> f64 {
        let [low, high] = self.range;
        if high > low {
            (height - low) / (high - low)
        } else {
            0.0
        }
    }

    /// The ground from the drop along the ball's path and straight on to the truth: the distance from the
    /// drop, m, and the height.
    pub fn profile(&self) -> Vec<[f64; 2]> {
        let rolled = self.ball.rolled_m();
        let end_m = rolled[self.ball.steps()];
        let path = rolled.into_iter().zip(&self.ball.heights);
        let ahead = self.ahead.iter().map(|[at, height]| [end_m + at, *height]);
        path.map(|(at, height)| [at, *height])
            .chain(ahead)
            .collect()
    }

    /// Colours the heights: dark is low.
    pub fn color(&mut self, colors: Colors) {
        let heights = self.heights.iter();
        self.levels = match colors {
            Colors::ByHeight => heights.map(|height| self.share(*height) as f32).collect(),
            Colors::ByRank => {
                let mut sorted = self.heights.clone();
                sort_numbers(&mut sorted);
                // Equal heights share a rank, so level ground has one colour.
                let below = |height: &f64| sorted.partition_point(|other| other < height);
                let scale = 1.0 / sorted.len() as f32;
                heights.map(|h| below(h) as f32 * scale).collect()
            }
        };
    }

    /// Number of cells on a side.
    pub fn cells(&self) -> usize {
        self.cells
    }

    /// Height exactly under the crosshair, not of its cell.
    pub fn at_probe(&self) -> f64 {
        self.ball.heights[0]
    }

    /// Height of the cell nearest to a shift.
    pub fn value_near(&self, [x, y]: [f64; 2]) -> f64 {
        let cells = self.cells();
        self.heights[nearest(cells, y) * cells + nearest(cells, x)]
    }

    /// All heights, row by row from the smallest Δy.
    pub fn heights(&self) -> &[f64] {
        &self.heights
    }

    /// The shift of the sample nearest to one along an axis, m.
    pub fn sample_near(&self, shift: f64) -> f64 {
        shift_m(self.cells(), nearest(self.cells(), shift))
    }

    /// `(Δx, height)` of every cell in the row nearest to `y`.
    pub fn row(&self, y: f64) -> Vec<[f64; 2]> {
        let cells = self.cells();
        let row = nearest(cells, y) * cells;
        self.line((0..cells).map(|k| row + k))
    }

    /// `(Δy, height)` of every cell in the column nearest to `x`.
    pub fn column(&self, x: f64) -> Vec<[f64; 2]> {
        let cells = self.cells();
        let column = nearest(cells, x);
        self.line((0..cells).map(|k| k * cells + column))
    }

    fn line(&self, indices: impl Iterator<Item = usize>) -> Vec<[f64; 2]> {
        let at = |(k, index): (usize, usize)| [shift_m(self.cells(), k), self.heights[index]];
        indices.enumerate().map(at).collect()
    }
}

/// Distance of two samples, m.
pub fn spacing_m(cells: usize) -> f64 {
    2.0 * HALF_SPAN_M / (cells - 1) as f64
}

/// The shift of sample `k` of an axis, m.
pub fn shift_m(cells: usize, k: usize) -> f64 {
    -HALF_SPAN_M + 2.0 * HALF_SPAN_M * k as f64 / (cells - 1) as f64
}

fn nearest(cells: usize, shift_m: f64) -> usize {
    let place = (shift_m + HALF_SPAN_M) / spacing_m(cells);
    (place.round().max(0.0) as usize).min(cells - 1)
}
