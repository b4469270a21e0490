//! The map for speed: the same cells as a dense table, points of a column side by side.

use nalgebra::{Point2, Vector2};
use pr_geom::math;
use rustc_hash::FxHashMap;

use super::cell_table::{CellTable, finite_range, free_cell_m};
use super::{NearestMap, Neighbor, PointCloud, QueryCache, cell_index};

/// Index value for "no point".
const NONE: u32 = QueryCache::NO_POINT;

/// A cached search looks beyond the radius by this share of it, so that an empty result stays valid longer.
const LOOK_AHEAD: f64 = 0.25;

/// If two distances differ by less than this, m, a new search decides instead of the cache.
const ROUNDING_M: f64 = 1e-9;

/// An immutable [`VoxelMap`](super::VoxelMap) for queries: built at once, the same answers, no hashing.
///
/// The points are sorted by cell, x index first, so the cells of one column that a query visits are
/// one contiguous run. If a table of the map's cells would be mostly empty because of a large extent,
/// the table joins cells to larger ones; if cells have no limit of points, it chooses a size with a
/// few points in each. This affects the time, not the answers.
#[derive(Clone, Debug)]
pub struct DenseMap {
    cell_m: f64,
    max_per_cell: usize,
    table: CellTable,
    xs: Vec<f64>,
    ys: Vec<f64>,
    /// `(0, 0)` if a point has no normal; empty if no point has one.
    normals: Vec<(f64, f64)>,
    source_indices: Vec<u32>,
    scratch: Vec<u32>,
}

/// Result of a search.
#[derive(Clone, Copy)]
struct Found {
    /// The nearest point, or [`NONE`].
    index: u32,
    distance_squared_m2: f64,
    /// Lower bound of the distance to every other point.
    clearance_m: f64,
}

/// The nearest and the second nearest of the visited points.
struct Scan {
    index: u32,
    best: f64,
    second: f64,
}

impl DenseMap {
    /// A map without points, of cells `cell_m` wide with at most `max_per_cell` points.
    ///
    /// # Panics
    /// If the cell size is not positive and finite.
    #[must_use]
    pub fn new(cell_m: f64, max_per_cell: usize) -> Self {
        assert!(
            cell_m > 0.0 && cell_m.is_finite(),
            "cell size {cell_m} m is not positive"
        );
        let mut map = Self {
            cell_m,
            max_per_cell,
            table: CellTable::default(),
            xs: Vec::new(),
            ys: Vec::new(),
            normals: Vec::new(),
            source_indices: Vec::new(),
            scratch: Vec::new(),
        };
        // A search widens its box by cells until it covers the radius, so it needs the cell size.
        map.rebuild(&PointCloud::default());
        map
    }

    /// A map of the points of `cloud` in order, with their normals.
    #[must_use]
    pub fn from_cloud(cloud: &PointCloud, cell_m: f64, max_per_cell: usize) -> Self {
        let mut map = Self::new(cell_m, max_per_cell);
        map.rebuild(cloud);
        map
    }

    /// Replaces the contents by the points of `cloud` and keeps the cache.
    pub fn rebuild(&mut self, cloud: &PointCloud) {
        let kept = self.sort_into_cells(cloud);
        self.xs.clear();
        self.ys.clear();
        self.normals.clear();
        self.source_indices.clear();
        self.xs.resize(kept, 0.0);
        self.ys.resize(kept, 0.0);
        self.source_indices.resize(kept, 0);
        if cloud.has_normals() {
            self.normals.resize(kept, (0.0, 0.0));
        }
        let (xs, ys) = (cloud.xs(), cloud.ys());
        for index in 0..cloud.len() {
            let cell = self.scratch[index];
            if cell == NONE {
                continue;
            }
            // Filling moves each start to its end; it is moved back below.
            let slot = self.table.starts[cell as usize] as usize;
            self.table.starts[cell as usize] += 1;
            self.xs[slot] = xs[index];
            self.ys[slot] = ys[index];
            self.source_indices[slot] = index as u32;
            if cloud.has_normals() {
                self.normals[slot] = cloud.raw_normal(index);
            }
        }
        self.table.starts.rotate_right(1);
        self.table.starts[0] = 0;
    }

    /// [`NearestMap::neighbor`] that starts near the point `hint`.
    ///
    /// The hint affects the time, never the answer.
    #[inline]
    #[must_use]
    pub fn neighbor_from(
        &self,
        query: Point2<f64>,
        radius_m: f64,
        hint: Option<usize>,
    ) -> Option<Neighbor> {
        let hint = hint.map_or(NONE, |index| index as u32);
        let found = self.find(query.x, query.y, radius_m, hint);
        (found.index != NONE).then_some(Neighbor {
            index: found.index as usize,
            distance_squared_m2: found.distance_squared_m2,
        })
    }

    /// Index of the map's point `index` in the source cloud.
    #[must_use]
    pub fn source_index(&self, index: usize) -> usize {
        self.source_indices[index] as usize
    }

    /// Width of a cell, m.
    #[must_use]
    pub fn cell_m(&self) -> f64 {
        self.cell_m
    }

    /// x coordinates of the points, in the order of the map's cells.
    #[must_use]
    pub fn xs(&self) -> &[f64] {
        &self.xs
    }

    /// y coordinates of the points, in the order of the map's cells.
    #[must_use]
    pub fn ys(&self) -> &[f64] {
        &self.ys
    }

    /// Calls `visit` with the index of every point within `radius_m`, inclusive.
    #[inline]
    pub fn for_each_within(&self, query: Point2<f64>, radius_m: f64, mut visit: impl FnMut(usize)) {
        let reach = radius_m + self.margin();
        self.table.for_each_run(query.x, query.y, reach, |run| {
            for index in run {
                let (dx, dy) = (self.xs[index] - query.x, self.ys[index] - query.y);
                if dx * dx + dy * dy <= radius_m * radius_m {
                    visit(index);
                }
            }
        });
    }

    /// Margin of a box of cells: absorbs the rounding of cell edges, and gives clearance.
    #[inline]
    fn margin(&self) -> f64 {
        0.0625 * self.table.cell_m
    }

    /// The nearest point closer than `radius_m`; the search starts near the point `hint`.
    #[inline]
    fn find(&self, x: f64, y: f64, radius_m: f64, hint: u32) -> Found {
        let mut reach = if let Some(&hint_x) = self.xs.get(hint as usize) {
            let hint_y = self.ys[hint as usize];
            let distance = math::norm2(hint_x - x, hint_y - y);
            math::min(distance, radius_m)
        } else {
            math::min(self.table.cell_m, radius_m)
        };
        loop {
            let covered = reach + self.margin();
            let scan = self.scan_box(x, y, covered);
            let nearest = math::sqrt(scan.best);
            if nearest <= covered || reach >= radius_m {
                let within = scan.best < radius_m * radius_m;
                let next = if within {
                    math::sqrt(scan.second)
                } else {
                    nearest
                };
                return Found {
                    index: if within { scan.index } else { NONE },
                    distance_squared_m2: scan.best,
                    clearance_m: math::min(next, covered),
                };
            }
            // A point beyond the box bounds the search; an empty box doubles the reach.
            let next = if scan.index == NONE {
                2.0 * covered
            } else {
                nearest
            };
            reach = math::min(next, radius_m);
        }
    }

    #[inline]
    fn scan_box(&self, x: f64, y: f64, reach: f64) -> Scan {
        let mut scan = Scan {
            index: NONE,
            best: f64::INFINITY,
            second: f64::INFINITY,
        };
        self.table.for_each_run(x, y, reach, |run| {
            let points = self.xs[run.clone()].iter().zip(&self.ys[run.clone()]);
            // A range has no overflow check, unlike `enumerate`.
            for (index, (&px, &py)) in run.zip(points) {
                let (dx, dy) = (px - x, py - y);
                let squared = dx * dx + dy * dy;
                // Selections instead of branches, because the branch is unpredictable.
                let nearer = squared < scan.best;
                let loser = math::max(squared, scan.best);
                scan.second = math::min(loser, scan.second);
                scan.best = math::min(squared, scan.best);
                scan.index = if nearer { index as u32 } else { scan.index };
            }
        });
        if scan.second == scan.best && scan.index != NONE {
            scan.index = self.first_of_equals(x, y, reach, scan.best);
        }
        scan
    }

    /// Whether the points are in the order in which the chapter's loop visits them.
    pub(super) fn is_in_visit_order(&self) -> bool {
        self.table.cell_m == self.cell_m
    }

    /// Sort key of the order in which the chapter's loop visits points.
    pub(super) fn visit_order(&self, index: u32) -> (i32, i32, u32) {
        let index = index as usize;
        (
            cell_index(self.xs[index], self.cell_m),
            cell_index(self.ys[index], self.cell_m),
            self.source_indices[index],
        )
    }

    /// Among the points at exactly this squared distance, the one that the chapter's loop visits first.
    #[cold]
    fn first_of_equals(&self, x: f64, y: f64, reach: f64, squared_m2: f64) -> u32 {
        let mut first = NONE;
        self.table.for_each_run(x, y, reach, |run| {
            for index in run {
                let (dx, dy) = (self.xs[index] - x, self.ys[index] - y);
                let index = index as u32;
                let ties = dx * dx + dy * dy == squared_m2;
                if ties && (first == NONE || self.visit_order(index) < self.visit_order(first)) {
                    first = index;
                }
            }
        });
        first
    }

    /// Lays out the table: `scratch` holds the cell of each point, `starts` where its run begins.
    fn sort_into_cells(&mut self, cloud: &PointCloud) -> usize {
        // Without a limit of points per cell, cells serve only the search, and their size is free.
        let chosen_m = (self.max_per_cell == usize::MAX).then(|| free_cell_m(cloud));
        let cell_m = chosen_m.flatten().unwrap_or(self.cell_m);
        let cells = |index: usize| {
            let (x, y) = (cloud.xs()[index], cloud.ys()[index]);
            (x.is_finite() && y.is_finite()).then(|| (cell_index(x, cell_m), cell_index(y, cell_m)))
        };
        // Cells grow with coordinates, so the extreme points have the extreme cells.
        let ((west, east), (south, north)) = (finite_range(cloud.xs()), finite_range(cloud.ys()));
        let (mut low, mut high) = ((i32::MAX, i32::MAX), (i32::MIN, i32::MIN));
        if west <= east && south <= north {
            low = (cell_index(west, cell_m), cell_index(south, cell_m));
            high = (cell_index(east, cell_m), cell_index(north, cell_m));
        }
        self.table.clear(low, high, cell_m, cloud.len());

        // Only joined cells need separate counts for each map cell.
        let mut counts = FxHashMap::<(i32, i32), usize>::default();
        self.scratch.clear();
        for index in 0..cloud.len() {
            let mut slot = NONE;
            if let Some(cell) = cells(index) {
                let table_cell = self.table.slot(cell);
                let count = &mut self.table.starts[table_cell + 1];
                let in_map_cell = if self.table.factor == 1 {
                    *count as usize
                } else {
                    let in_map_cell = counts.entry(cell).or_default();
                    *in_map_cell += 1;
                    *in_map_cell - 1
                };
                if in_map_cell < self.max_per_cell {
                    *count += 1;
                    slot = table_cell as u32;
                }
            }
            self.scratch.push(slot);
        }
        let mut total = 0;
        for start in &mut self.table.starts {
            total += *start;
            *start = total;
        }
        total as usize
    }
}

impl NearestMap for DenseMap {
    #[inline]
    fn len(&self) -> usize {
        self.xs.len()
    }

    #[inline]
    fn point(&self, index: usize) -> Point2<f64> {
        Point2::new(self.xs[index], self.ys[index])
    }

    #[inline]
    fn normal(&self, index: usize) -> Option<Vector2<f64>> {
        let &(x, y) = self.normals.get(index)?;
        (x != 0.0 || y != 0.0).then(|| Vector2::new(x, y))
    }

    #[inline]
    fn neighbor(&self, query: Point2<f64>, radius_m: f64) -> Option<Neighbor> {
        self.neighbor_from(query, radius_m, None)
    }

    /// If the query moved by m, the cached point is still the nearest if its distance plus m is below the
    /// clearance, because every other point was at least that far from the anchor.
    #[inline]
    fn neighbor_cached(
        &self,
        query: Point2<f64>,
        radius_m: f64,
        cache: &mut QueryCache,
    ) -> Option<Neighbor> {
        let moved = math::norm2(query.x - cache.anchor.0, query.y - cache.anchor.1);
        let clear_m = cache.clearance_m - moved - ROUNDING_M;
        let within = |index: u32, distance_squared_m2: f64| {
            (distance_squared_m2 < radius_m * radius_m).then_some(Neighbor {
                index: index as usize,
                distance_squared_m2,
            })
        };
        if let Some(&x) = self.xs.get(cache.index as usize) {
            let (dx, dy) = (x - query.x, self.ys[cache.index as usize] - query.y);
            let distance_squared_m2 = dx * dx + dy * dy;
            if clear_m > 0.0 && distance_squared_m2 < clear_m * clear_m {
                return within(cache.index, distance_squared_m2);
            }
        } else if clear_m >= radius_m {
            return None;
        }
        let reach = radius_m * (1.0 + LOOK_AHEAD);
        let found = self.find(query.x, query.y, reach, cache.index);
        *cache = QueryCache {
            index: found.index,
            anchor: (query.x, query.y),
            clearance_m: found.clearance_m,
        };
        if found.index == NONE {
            return None;
        }
        within(found.index, found.distance_squared_m2)
    }
}
