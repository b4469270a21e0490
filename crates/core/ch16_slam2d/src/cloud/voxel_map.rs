//! The chapter's map: a hash of cells with a short list of points in each.

use nalgebra::{Point2, Vector2};
use rustc_hash::FxHashMap;
use smallvec::SmallVec;

use super::{NearestMap, Neighbor, PointCloud, cell_index};

/// Points hashed by cell, at most `max_per_cell` in each; further points of a full cell are ignored.
///
/// A query visits the cells around it, ring by ring, until no farther ring can contain a nearer
/// point. The answer is exact within the radius.
#[derive(Clone, Debug)]
pub struct VoxelMap {
    cell_m: f64,
    max_per_cell: usize,
    buckets: FxHashMap<(i32, i32), SmallVec<[u32; 8]>>,
    points: PointCloud,
}

impl VoxelMap {
    /// A map without points, of cells `cell_m` wide.
    ///
    /// # Panics
    /// If the cell size is not positive and finite.
    #[must_use]
    pub fn new(cell_m: f64, max_per_cell: usize) -> Self {
        assert!(
            cell_m > 0.0 && cell_m.is_finite(),
            "cell size {cell_m} m is not positive"
        );
        Self {
            cell_m,
            max_per_cell,
            buckets: FxHashMap::default(),
            points: PointCloud::default(),
        }
    }

    /// A map of the points of `cloud`, inserted in order, with their normals.
    #[must_use]
    pub fn from_cloud(cloud: &PointCloud, cell_m: f64, max_per_cell: usize) -> Self {
        let mut map = Self::new(cell_m, max_per_cell);
        map.insert_cloud(cloud);
        map
    }

    /// Adds points in order, each with its unit normal if it has one.
    ///
    /// A point is ignored if its cell is full or a coordinate is not finite. The stored points are
    /// numbered from 0 in the order of insertion.
    ///
    /// # Panics
    /// If the slices differ in length.
    pub fn insert(&mut self, points: &[Point2<f64>], normals: &[Option<Vector2<f64>>]) {
        assert_eq!(points.len(), normals.len(), "every point has an entry");
        for (point, normal) in points.iter().zip(normals) {
            self.insert_point(*point, *normal);
        }
    }

    /// Adds the points of a cloud in order, with their normals.
    pub fn insert_cloud(&mut self, cloud: &PointCloud) {
        for index in 0..cloud.len() {
            self.insert_point(cloud.point(index), cloud.normal(index));
        }
    }

    fn insert_point(&mut self, point: Point2<f64>, normal: Option<Vector2<f64>>) {
        if !(point.x.is_finite() && point.y.is_finite()) {
            return;
        }
        let bucket = self.buckets.entry(self.cell_of(point)).or_default();
        if bucket.len() < self.max_per_cell {
            bucket.push(self.points.len() as u32);
            self.points.push_with_normal(point, normal);
        }
    }

    /// Removes all points and keeps the memory of the tables.
    pub fn clear(&mut self) {
        self.buckets.clear();
        self.points.clear();
    }

    /// Width of a cell, m.
    #[must_use]
    pub fn cell_m(&self) -> f64 {
        self.cell_m
    }

    /// The stored points, in the order of insertion.
    #[must_use]
    pub fn points(&self) -> &PointCloud {
        &self.points
    }

    /// Number of the nearest point strictly closer than `tau` (m); see [`NearestMap::neighbor`].
    #[must_use]
    pub fn nearest(&self, query: &Point2<f64>, tau: f64) -> Option<u32> {
        let neighbor = self.neighbor(*query, tau)?;
        Some(neighbor.index as u32)
    }

    fn cell_of(&self, point: Point2<f64>) -> (i32, i32) {
        (
            cell_index(point.x, self.cell_m),
            cell_index(point.y, self.cell_m),
        )
    }
}

/// The best point so far, with its cell to break ties.
struct Best {
    distance_squared_m2: f64,
    cell: (i32, i32),
    index: Option<u32>,
}

impl Best {
    #[inline]
    fn consider(&mut self, points: &PointCloud, query: Point2<f64>, cell: (i32, i32), index: u32) {
        let dx = points.xs()[index as usize] - query.x;
        let dy = points.ys()[index as usize] - query.y;
        let distance_squared_m2 = dx * dx + dy * dy;
        // Within a cell the first of equals stays; across cells the smaller cell wins.
        let tie = distance_squared_m2 == self.distance_squared_m2
            && self.index.is_some()
            && cell < self.cell;
        if distance_squared_m2 < self.distance_squared_m2 || tie {
            self.distance_squared_m2 = distance_squared_m2;
            self.cell = cell;
            self.index = Some(index);
        }
    }
}

impl VoxelMap {
    fn scan(&self, cell: (i32, i32), query: Point2<f64>, best: &mut Best) {
        let Some(bucket) = self.buckets.get(&cell) else {
            return;
        };
        for &index in bucket {
            best.consider(&self.points, query, cell, index);
        }
    }

    fn scan_all(&self, query: Point2<f64>, best: &mut Best) {
        for index in 0..self.points.len() {
            let cell = self.cell_of(self.points.point(index));
            best.consider(&self.points, query, cell, index as u32);
        }
    }

    /// A lower bound of the distance to the points of cells `ring` or more cells away.
    fn ring_distance(&self, ring: i32, query: Point2<f64>, (ci, cj): (i32, i32)) -> f64 {
        let to_edge = |coordinate: f64, cell: i32| {
            let low = coordinate - f64::from(cell) * self.cell_m;
            low.min(self.cell_m - low)
        };
        // The division that selects a cell rounds, so a point may lie that far outside of its cell.
        let rounding = 1e-12 * (self.cell_m + query.x.abs() + query.y.abs());
        f64::from(ring - 1) * self.cell_m + to_edge(query.x, ci).min(to_edge(query.y, cj))
            - rounding
    }
}

impl NearestMap for VoxelMap {
    fn len(&self) -> usize {
        self.points.len()
    }

    fn point(&self, index: usize) -> Point2<f64> {
        self.points.point(index)
    }

    fn normal(&self, index: usize) -> Option<Vector2<f64>> {
        self.points.normal(index)
    }

    fn neighbor(&self, query: Point2<f64>, radius_m: f64) -> Option<Neighbor> {
        let center = self.cell_of(query);
        let (ci, cj) = center;
        let last_ring = ((radius_m / self.cell_m).ceil() as i32).max(1);
        let mut best = Best {
            distance_squared_m2: radius_m * radius_m,
            cell: (i32::MIN, i32::MIN),
            index: None,
        };
        self.scan(center, query, &mut best);
        for ring in 1..=last_ring {
            let bound = self.ring_distance(ring, query, center);
            if bound > 0.0 && bound * bound > best.distance_squared_m2 {
                break;
            }
            // Far from a small map the rings are many and empty: a linear scan is cheaper.
            if i64::from(ring) * i64::from(ring) > self.points.len() as i64 {
                self.scan_all(query, &mut best);
                break;
            }
            let (west, east) = (ci.saturating_sub(ring), ci.saturating_add(ring));
            let (south, north) = (cj.saturating_sub(ring), cj.saturating_add(ring));
            for j in south..=north {
                self.scan((west, j), query, &mut best);
                self.scan((east, j), query, &mut best);
            }
            for i in west + 1..east {
                self.scan((i, south), query, &mut best);
                self.scan((i, north), query, &mut best);
            }
        }
        best.index.map(|index| Neighbor {
            index: index as usize,
            distance_squared_m2: best.distance_squared_m2,
        })
    }
}
