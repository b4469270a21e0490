//! The scan at every heading of a window, in cells of the map.

use core::ops::Range;
use std::sync::Arc;

use pr_geom::{Point2, Rotation, math, order_by};

use super::lattice::Lattice;
use super::pyramid::{BATCH, CellSlice, LEVELS, Level};
use super::score_scale::FULL_SCORE;
use super::{LikelihoodGrid, SearchMap};
use crate::cloud::PointCloud;

/// Largest distance of a cell from the map's corner; farther ones are clamped, as both are outside.
const FARTHEST_CELL: f64 = 16_383.0;

/// Adding this to a number below 2^51 rounds it to a whole one and leaves that in the lowest bits: 1.5 · 2^52.
const TO_WHOLE: f64 = 6_755_399_441_055_744.0;

/// Boxes with sides of fewer than `2` to this power cells contain one heading each.
const FINEST_GROUP: u32 = 2;

/// The size of a box of poses: `2^side` columns and rows, `2^turn` headings.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct BoxShape {
    pub side: u32,
    pub turn: u32,
}

impl BoxShape {
    /// One pose.
    const POSE: Self = Self { side: 0, turn: 0 };

    /// The shapes of a search from coarse to fine, for windows of `columns` × `rows` × `headings`.
    ///
    /// A step of the heading moves a far point by a cell, so a box with as many headings as columns
    /// is balanced. Small boxes need fewer lookups with one heading each.
    pub fn schedule(columns: i32, rows: i32, headings: i32) -> Vec<Self> {
        let widest = columns.max(rows).ilog2().min(LEVELS as u32 - 2);
        let is_grouped = headings > 1 << widest;
        let mut shapes = Vec::new();
        for side in (0..=widest).rev() {
            if is_grouped && side >= FINEST_GROUP {
                shapes.push(Self { side, turn: side });
            }
            if !is_grouped || side <= FINEST_GROUP {
                shapes.push(Self { side, turn: 0 });
            }
        }
        shapes
    }

    /// Columns and rows of a box.
    pub fn cells(self) -> i32 {
        1 << self.side
    }

    /// Headings of a box.
    pub fn headings(self) -> i32 {
        1 << self.turn
    }

    /// Whether a box is a single pose.
    pub fn is_pose(self) -> bool {
        self == Self::POSE
    }
}

/// The points of a scan as cells, for every group of headings of every shape.
#[derive(Clone, Debug)]
pub(super) struct TurnedScan {
    points: usize,
    plans: Vec<Plan>,
}

/// The lookups for one shape of boxes.
///
/// Over a box, a point visits the cells from the lowest to the highest of its headings, extended by the size of
/// the box. Squares of one level at the ends of that area cover it: one for a single heading, four otherwise.
#[derive(Clone, Debug)]
struct Plan {
    runs: Vec<Run>,
    /// Lowest column and row of every point, group by group.
    low: Arc<Cells>,
    /// Last column and row of a square that ends with the area; empty if there is one square.
    high: Cells,
}

/// Columns and rows, one array each.
#[derive(Clone, Debug, Default)]
struct Cells {
    columns: Vec<i16>,
    rows: Vec<i16>,
}

/// Consecutive points that look up the same level; `None` if no level is large enough.
#[derive(Clone, Copy, Debug)]
struct Run {
    first: usize,
    end: usize,
    level: Option<usize>,
}

impl TurnedScan {
    /// The finite points of `scan`, rotated by every heading of the lattice, at its centre.
    pub fn new(
        scan: &PointCloud,
        lattice: &Lattice,
        grid: &LikelihoodGrid,
        shapes: &[BoxShape],
    ) -> Self {
        let points = far_points_first(scan);
        let single = Arc::new(Cells::turned(&points, lattice, grid));
        let plan = |shape: &BoxShape| Plan::new(&single, points.len(), *shape);
        Self {
            points: points.len(),
            plans: shapes.iter().map(plan).collect(),
        }
    }

    /// The largest possible sum of scores.
    pub fn full_score(&self) -> u32 {
        self.points as u32 * u32::from(FULL_SCORE)
    }

    /// Upper bound of the score of all poses of a box, as the sum of the largest scores around each point.
    ///
    /// The box has the shape of this index in the schedule and the headings of the group; its lowest pose is
    /// `column` and `row` cells away from the window's centre. For a single pose it is the score itself. Once the
    /// bound is certain to stay below `of_interest`, the remaining points count fully: a looser bound, still
    /// below.
    pub fn sum(
        &self,
        map: &SearchMap,
        shape: usize,
        group: i32,
        at: [i32; 2],
        of_interest: u32,
    ) -> u32 {
        let offset = at.map(|cells| cells as i16);
        let [sum] = self.sums(map, shape, group, of_interest, |level, low, high| {
            [match high {
                None => level.sum(low, offset),
                Some(high) => level.sum_of_areas(low, high, offset),
            }]
        });
        sum
    }

    /// [`TurnedScan::sum`] of a box of at most [`NEAR_SIDE`](super::pyramid::NEAR_SIDE) columns, and of those right of
    /// it, above it, and above that to the right; the looser bounds are used if all four stay below `of_interest`.
    pub fn sums_of_four(
        &self,
        map: &SearchMap,
        (shape, cells): (usize, i32),
        group: i32,
        at: [i32; 2],
        of_interest: u32,
    ) -> [u32; 4] {
        let offset = at.map(|cells| cells as i16);
        self.sums(map, shape, group, of_interest, |level, low, high| {
            level.sums_of_four(low, high, offset, cells as usize)
        })
    }

    /// The bounds of `N` boxes by the sums of a batch of points: at their cells, or over areas from these to the others.
    #[inline]
    fn sums<const N: usize>(
        &self,
        map: &SearchMap,
        shape: usize,
        group: i32,
        of_interest: u32,
        of_batch: impl Fn(&Level, CellSlice<'_>, Option<CellSlice<'_>>) -> [u32; N],
    ) -> [u32; N] {
        let plan = &self.plans[shape];
        let start = group as usize * self.points;
        // The bounds so far: every point counts fully until it has been looked up.
        let mut sums = [self.full_score(); N];
        for run in &plan.runs {
            let Some(level) = run.level else { continue };
            let level = map.level(level);
            for first in (run.first..run.end).step_by(BATCH) {
                let end = run.end.min(first + BATCH);
                let range = start + first..start + end;
                let low = plan.low.slice(range.clone());
                let high = (!plan.high.columns.is_empty()).then(|| plan.high.slice(range));
                let full = (end - first) as u32 * u32::from(FULL_SCORE);
                for (sum, found) in sums.iter_mut().zip(of_batch(level, low, high)) {
                    *sum = *sum - full + found;
                }
                if sums.iter().all(|sum| *sum < of_interest) {
                    return sums;
                }
            }
        }
        sums
    }
}

/// Sorts far points first, because they move most with the heading; neighbours in this order need the same level.
fn far_points_first(scan: &PointCloud) -> Vec<Point2<f64>> {
    let reach = |point: &Point2<f64>| math::norm2(point.x, point.y);
    let points: Vec<_> = scan
        .iter()
        .filter(|point| reach(point).is_finite())
        .collect();
    let order = order_by(points.len(), &|index| -reach(&points[index]));
    order.into_iter().map(|index| points[index]).collect()
}

impl Cells {
    /// The points at every heading, with the sensor at the window's centre.
    fn turned(points: &[Point2<f64>], lattice: &Lattice, grid: &LikelihoodGrid) -> Self {
        let (x_m, y_m) = lattice.center_m();
        let places = points.len() * lattice.headings as usize;
        let mut cells = Self {
            columns: Vec::with_capacity(places),
            rows: Vec::with_capacity(places),
        };
        let cell_m = grid.config().cell_m;
        let [first_column, first_row] = grid.first_cell().map(f64::from);
        for heading in 0..lattice.headings {
            let rotation = Rotation::new(lattice.heading_rad(heading));
            let turned = || points.iter().map(|point| rotation.rotate(point.x, point.y));
            let columns = turned().map(|(x, _)| near_cell((x + x_m) / cell_m, first_column));
            cells.columns.extend(columns);
            let rows = turned().map(|(_, y)| near_cell((y + y_m) / cell_m, first_row));
            cells.rows.extend(rows);
        }
        cells
    }

    fn slice(&self, range: Range<usize>) -> CellSlice<'_> {
        CellSlice {
            columns: &self.columns[range.clone()],
            rows: &self.rows[range],
        }
    }
}

/// Cells from the map's first one to the one that contains a place, clamped.
///
/// Like [`cell_index`](crate::cloud::cell_index), in operations that are vectorized.
#[inline]
fn near_cell(cells: f64, first: f64) -> i16 {
    let cells = math::max(
        math::min(cells, first + FARTHEST_CELL),
        first - FARTHEST_CELL,
    );
    let nearest = (cells + TO_WHOLE) - TO_WHOLE;
    let floor = nearest - f64::from(u8::from(nearest > cells));
    (floor - first + TO_WHOLE).to_bits() as i16
}

impl Plan {
    fn new(single: &Arc<Cells>, points: usize, shape: BoxShape) -> Self {
        if shape.turn == 0 {
            return Self {
                runs: vec![Run {
                    first: 0,
                    end: points,
                    level: Some(shape.side as usize),
                }],
                low: Arc::clone(single),
                high: Cells::default(),
            };
        }
        let columns = Spans::new(&single.columns, points, shape);
        let rows = Spans::new(&single.rows, points, shape);
        let widest = columns.widest.iter().zip(&rows.widest);
        let runs = runs(widest.map(|(x, y)| x.max(y) + shape.cells()));
        Self {
            high: Cells {
                columns: columns.last_squares(&runs, points, shape),
                rows: rows.last_squares(&runs, points, shape),
            },
            low: Arc::new(Cells {
                columns: columns.low,
                rows: rows.low,
            }),
            runs,
        }
    }
}

/// Lowest and highest cell of every point over each group of headings, along one axis.
struct Spans {
    low: Vec<i16>,
    high: Vec<i16>,
    /// Largest movement of a point over the headings of any group, in cells.
    widest: Vec<i32>,
}

impl Spans {
    fn new(single: &[i16], points: usize, shape: BoxShape) -> Self {
        let places = single.len() >> shape.turn;
        let mut spans = Self {
            low: Vec::with_capacity(places + points),
            high: Vec::with_capacity(places + points),
            widest: vec![0; points],
        };
        for group in single.chunks(points << shape.turn) {
            let start = spans.low.len();
            spans.low.extend_from_slice(&group[..points]);
            spans.high.extend_from_slice(&group[..points]);
            let (low, high) = (&mut spans.low[start..], &mut spans.high[start..]);
            for heading in group.chunks_exact(points).skip(1) {
                for ((low, high), &cell) in low.iter_mut().zip(high.iter_mut()).zip(heading) {
                    *low = cell.min(*low);
                    *high = cell.max(*high);
                }
            }
            for ((widest, &low), &high) in spans.widest.iter_mut().zip(&*low).zip(&*high) {
                *widest = (i32::from(high) - i32::from(low)).max(*widest);
            }
        }
        spans
    }

    /// Start of the square that ends with the area, not before the first one.
    fn last_squares(&self, runs: &[Run], points: usize, shape: BoxShape) -> Vec<i16> {
        let mut last = self.high.clone();
        for (last, low) in last
            .chunks_exact_mut(points)
            .zip(self.low.chunks_exact(points))
        {
            for run in runs {
                let back = run.level.map_or(0, |level| (1 << level) - shape.cells());
                for k in run.first..run.end {
                    last[k] = (last[k] - back as i16).max(low[k]);
                }
            }
        }
        last
    }
}

/// The largest levels whose squares fit into areas of these widths, for consecutive points.
fn runs(widths: impl Iterator<Item = i32>) -> Vec<Run> {
    let mut runs: Vec<Run> = Vec::new();
    for (point, width) in widths.enumerate() {
        // Two squares cover up to twice a side.
        let level = width.ilog2() as usize;
        let level = if level < LEVELS {
            Some(level)
        } else {
            (width <= 1 << LEVELS).then_some(LEVELS - 1)
        };
        match runs.last_mut() {
            Some(run) if run.level == level => run.end = point + 1,
            _ => runs.push(Run {
                first: point,
                end: point + 1,
                level,
            }),
        }
    }
    runs
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_near_cell_is_the_floor_within_its_limits() {
        for first in [-40, 0, 7] {
            for place in [-3e9, -1.0, -0.5, -1e-9, 0.0, 0.5, 1.5, 2.0 - 1e-9, 2.0, 5e9] {
                let cell = i64::from(crate::cloud::cell_index(place, 1.0)) - i64::from(first);
                let limit = FARTHEST_CELL as i64;
                let expected = cell.clamp(-limit, limit);
                assert_eq!(
                    i64::from(near_cell(place, f64::from(first))),
                    expected,
                    "{place} {first}"
                );
            }
        }
    }

    #[test]
    fn boxes_shrink_from_shape_to_shape_down_to_a_pose() {
        for (columns, rows, headings) in [(121, 121, 754), (1, 1, 754), (40, 40, 20), (9, 9, 1)] {
            let shapes = BoxShape::schedule(columns, rows, headings);
            assert!(shapes.last().unwrap().is_pose());
            for pair in shapes.windows(2) {
                assert!(pair[1].side <= pair[0].side && pair[1].turn <= pair[0].turn);
                assert_ne!(pair[0], pair[1]);
            }
        }
    }
}
