//! The map for very many queries: precomputed candidates for every small square.

use core::hint::select_unpredictable;

use nalgebra::{Point2, Vector2};
use pr_geom::math;

use super::{DenseMap, NearestMap, Neighbor, QueryCache};

/// Squared distances that differ by less than this, m², count as equal when candidates are excluded.
const ROUNDING_M2: f64 = 1e-12;

/// Largest number of squares and of candidates in a table: 120 MB. A room takes a hundredth of it.
const BUDGET: usize = 1 << 22;

/// A [`DenseMap`] with a table: for every small square, the points that can be nearest to a query in it.
///
/// A query compares the few points of its square. Building takes a search for every square, about 3 ms
/// for a room, which pays off after about 100,000 queries. The answers are those of the map. Queries
/// off the table go to the map, and so do all queries if the table would exceed its budget.
#[derive(Clone, Debug)]
pub struct NearestTable {
    map: DenseMap,
    origin: (f64, f64),
    per_metre: f64,
    columns: usize,
    rows: usize,
    /// `starts[column * rows + row]` to the next entry are the candidates of a square, in pairs.
    starts: Vec<u32>,
    /// A single candidate is stored twice. Four queries of five have one or two candidates, so the branch on their
    /// number is rarely mispredicted.
    candidates: Vec<[Candidate; 2]>,
}

#[derive(Clone, Copy, Debug)]
struct Candidate {
    x: f64,
    y: f64,
    index: u32,
}

/// The extent of a table, m.
#[derive(Clone, Copy)]
struct Extent {
    low: (f64, f64),
    high: (f64, f64),
}

impl NearestTable {
    /// A table of squares `square_m` wide that reaches `reach_m` beyond the points of `map`.
    ///
    /// # Panics
    /// If the square is not positive.
    #[must_use]
    pub fn new(map: DenseMap, square_m: f64, reach_m: f64) -> Self {
        assert!(square_m > 0.0, "a square of {square_m} m is not positive");
        let mut table = Self {
            origin: (0.0, 0.0),
            per_metre: 1.0 / square_m,
            columns: 0,
            rows: 0,
            starts: vec![0],
            candidates: Vec::new(),
            map,
        };
        if let Some(extent) = extent(&table.map) {
            table.origin = (extent.low.0 - reach_m, extent.low.1 - reach_m);
            let squares = |low: f64, high: f64| ((high - low + 2.0 * reach_m) / square_m).ceil();
            let (columns, rows) = (
                squares(extent.low.0, extent.high.0),
                squares(extent.low.1, extent.high.1),
            );
            // Written so that a NaN extent has no table.
            if columns * rows <= BUDGET as f64 {
                table.columns = columns as usize;
                table.rows = rows as usize;
                table.fill(square_m);
            }
        }
        table
    }

    /// Whether there is a table: the map is not empty, and its table is within the budget.
    #[must_use]
    pub fn is_tabulated(&self) -> bool {
        self.columns > 0
    }

    /// The map behind the table.
    #[must_use]
    pub fn map(&self) -> &DenseMap {
        &self.map
    }

    /// Out of line to keep the look-up itself short.
    #[cold]
    fn off_table(&self, query: Point2<f64>, radius_m: f64) -> Option<Neighbor> {
        self.map.neighbor(query, radius_m)
    }

    fn forget(&mut self) {
        (self.columns, self.rows) = (0, 0);
        self.starts = vec![0];
        self.candidates = Vec::new();
    }

    fn fill(&mut self, square_m: f64) {
        let half_diagonal = square_m * core::f64::consts::FRAC_1_SQRT_2;
        let mut near = Vec::new();
        for column in 0..self.columns {
            for row in 0..self.rows {
                let low = Point2::new(
                    self.origin.0 + column as f64 * square_m,
                    self.origin.1 + row as f64 * square_m,
                );
                let center = low + Vector2::repeat(0.5 * square_m);
                let Some(nearest) = self.map.neighbor(center, f64::INFINITY) else {
                    continue;
                };
                // A point nearest to q in the square is within |q − c| of being nearest to c.
                let radius_m = math::sqrt(nearest.distance_squared_m2) + 2.0 * half_diagonal;
                near.clear();
                self.map
                    .for_each_within(center, radius_m, |index| near.push(index as u32));
                if !self.map.is_in_visit_order() {
                    near.sort_by_key(|&index| self.map.visit_order(index));
                }
                keep_candidates(&self.map, low, square_m, &mut near);
                let candidate = |index: u32| Candidate {
                    x: self.map.xs()[index as usize],
                    y: self.map.ys()[index as usize],
                    index,
                };
                let pairs = near.chunks(2);
                self.candidates
                    .extend(pairs.map(|pair| [pair[0], pair[pair.len() - 1]].map(candidate)));
                if 2 * self.candidates.len() > BUDGET {
                    self.forget();
                    return;
                }
                self.starts.push(self.candidates.len() as u32);
            }
        }
    }
}

/// Drops points that are farther than another one in the whole square.
///
/// The difference of two squared distances is affine in the query, so comparing at the four corners is enough.
fn keep_candidates(map: &DenseMap, low: Point2<f64>, square_m: f64, near: &mut Vec<u32>) {
    let corners = |index: u32| {
        let dx = map.xs()[index as usize] - low.x;
        let dy = map.ys()[index as usize] - low.y;
        let (ex, ey) = (dx - square_m, dy - square_m);
        [
            dx * dx + dy * dy,
            ex * ex + dy * dy,
            dx * dx + ey * ey,
            ex * ex + ey * ey,
        ]
    };
    let distances: Vec<[f64; 4]> = near.iter().map(|&index| corners(index)).collect();
    let beaten = |mine: &[f64; 4]| {
        distances.iter().any(|other| {
            let mut both = mine.iter().zip(other);
            both.all(|(mine, other)| other + ROUNDING_M2 < *mine)
        })
    };
    let mut mine = distances.iter();
    near.retain(|_| mine.next().is_some_and(|mine| !beaten(mine)));
}

fn extent(map: &DenseMap) -> Option<Extent> {
    let range = |values: &[f64]| {
        values
            .iter()
            .fold(None, |range: Option<(f64, f64)>, &value| {
                let (low, high) = range.unwrap_or((value, value));
                Some((math::min(value, low), math::max(value, high)))
            })
    };
    let ((west, east), (south, north)) = (range(map.xs())?, range(map.ys())?);
    Some(Extent {
        low: (west, south),
        high: (east, north),
    })
}

impl NearestMap for NearestTable {
    #[inline]
    fn len(&self) -> usize {
        self.map.len()
    }

    #[inline]
    fn point(&self, index: usize) -> Point2<f64> {
        self.map.point(index)
    }

    #[inline]
    fn normal(&self, index: usize) -> Option<Vector2<f64>> {
        self.map.normal(index)
    }

    #[inline]
    fn neighbor(&self, query: Point2<f64>, radius_m: f64) -> Option<Neighbor> {
        let column = (query.x - self.origin.0) * self.per_metre;
        let row = (query.y - self.origin.1) * self.per_metre;
        let on_table =
            column >= 0.0 && row >= 0.0 && column < self.columns as f64 && row < self.rows as f64;
        if !on_table {
            return self.off_table(query, radius_m);
        }
        let square = column as u32 as usize * self.rows + row as u32 as usize;
        let (start, end) = (
            self.starts[square] as usize,
            self.starts[square + 1] as usize,
        );
        let (mut best, mut least) = (QueryCache::NO_POINT, radius_m * radius_m);
        for pair in &self.candidates[start..end] {
            for candidate in pair {
                let (dx, dy) = (candidate.x - query.x, candidate.y - query.y);
                let squared = dx * dx + dy * dy;
                // Candidates are in the chapter's order: the first of equals stays. The comparison is
                // unpredictable, so it must not branch.
                let nearer = squared < least;
                least = math::min(squared, least);
                best = select_unpredictable(nearer, candidate.index, best);
            }
        }
        (best != QueryCache::NO_POINT).then_some(Neighbor {
            index: best as usize,
            distance_squared_m2: least,
        })
    }
}
