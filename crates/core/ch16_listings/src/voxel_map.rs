//! A map that finds the nearest point: a hash of cells.

use nalgebra::{Point2, Vector2};
use rustc_hash::FxHashMap;
use smallvec::SmallVec;

use ch16_slam2d::cloud::cell_index;

/// Points hashed by cell, at most `max_per_cell` in each.
///
/// The bound keeps walls from growing dense. It does not reject moving objects: their cells were empty.
#[derive(Clone, Debug)]
pub struct VoxelMap {
    /// Width of a cell, m.
    pub cell: f64,
    /// Further points of a full cell are ignored.
    pub max_per_cell: usize,
    /// Indices of the points in each cell.
    pub cells: FxHashMap<(i32, i32), SmallVec<[u32; 4]>>,
    /// The stored points, m.
    pub pts: Vec<Point2<f64>>,
    /// Their unit normals.
    pub normals: Vec<Option<Vector2<f64>>>,
}

impl VoxelMap {
    /// A map without points.
    #[must_use]
    pub fn new(cell: f64, max_per_cell: usize) -> Self {
        Self {
            cell,
            max_per_cell,
            cells: FxHashMap::default(),
            pts: Vec::new(),
            normals: Vec::new(),
        }
    }

    /// The cell of a point: `(⌊x/cell⌋, ⌊y/cell⌋)`.
    #[must_use]
    pub fn key(&self, p: &Point2<f64>) -> (i32, i32) {
        (cell_index(p.x, self.cell), cell_index(p.y, self.cell))
    }

    /// Adds points in order, each with its normal if it has one.
    pub fn insert(&mut self, points: &[Point2<f64>], normals: &[Option<Vector2<f64>>]) {
        for (p, normal) in points.iter().zip(normals) {
            let key = self.key(p);
            let bucket = self.cells.entry(key).or_default();
            if bucket.len() < self.max_per_cell {
                bucket.push(self.pts.len() as u32);
                self.pts.push(*p);
                self.normals.push(*normal);
            }
        }
    }

    /// Number of the nearest point closer than `tau` (m); it lies at most ⌈τ/cell⌉ cells away.
    #[must_use]
    pub fn nearest(&self, query: &Point2<f64>, tau: f64) -> Option<u32> {
        let mut best = (tau * tau, None);
        self.visit(query, tau, |index, squared| {
            if squared < best.0 {
                best = (squared, Some(index));
            }
        });
        best.1
    }

    /// All points within `radius` (m), inclusive.
    #[must_use]
    pub fn within(&self, query: &Point2<f64>, radius: f64) -> Vec<Point2<f64>> {
        let mut found = Vec::new();
        self.visit(query, radius, |index, squared| {
            if squared <= radius * radius {
                found.push(self.pts[index as usize]);
            }
        });
        found
    }

    /// Calls `look` with index and squared distance of each point in the cells that `reach` touches.
    fn visit(&self, query: &Point2<f64>, reach: f64, mut look: impl FnMut(u32, f64)) {
        let rings = ((reach / self.cell).ceil() as i32).max(1);
        let (ci, cj) = self.key(query);
        for i in ci - rings..=ci + rings {
            for j in cj - rings..=cj + rings {
                for &index in self.cells.get(&(i, j)).into_iter().flatten() {
                    look(index, (self.pts[index as usize] - query).norm_squared());
                }
            }
        }
    }
}
