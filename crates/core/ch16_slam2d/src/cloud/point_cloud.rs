//! The point cloud: one array per coordinate, normals stored separately.

use nalgebra::{Point2, Vector2};
use pr_geom::{Rotation, SE2};
use rustc_hash::FxHashMap;

use super::cell_index;

/// Points in metres in one frame, with unit normals if they are known, and the time of the sweep.
///
/// A normal of `(0, 0)` in the arrays means that the point has none; [`PointCloud::normal`] returns `None` for it.
/// The sign of a normal is arbitrary.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PointCloud {
    xs: Vec<f64>,
    ys: Vec<f64>,
    normal_xs: Vec<f64>,
    normal_ys: Vec<f64>,
    stamp_s: f64,
}

impl PointCloud {
    /// A cloud of these points without normals, taken at `stamp_s` (s). The default is an empty one.
    #[must_use]
    pub fn new(points: Vec<Point2<f64>>, stamp_s: f64) -> Self {
        Self {
            stamp_s,
            ..points.into_iter().collect()
        }
    }

    /// Time of measurement, s; 0 if unknown.
    #[must_use]
    pub fn stamp_s(&self) -> f64 {
        self.stamp_s
    }

    /// Number of points.
    #[must_use]
    pub fn len(&self) -> usize {
        self.xs.len()
    }

    /// Whether the cloud has no points.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.xs.is_empty()
    }

    /// All x coordinates in metres.
    #[must_use]
    pub fn xs(&self) -> &[f64] {
        &self.xs
    }

    /// All y coordinates in metres.
    #[must_use]
    pub fn ys(&self) -> &[f64] {
        &self.ys
    }

    /// Point `index`.
    #[must_use]
    pub fn point(&self, index: usize) -> Point2<f64> {
        Point2::new(self.xs[index], self.ys[index])
    }

    /// The points in order.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = Point2<f64>> + Clone + '_ {
        self.xs
            .iter()
            .zip(&self.ys)
            .map(|(&x, &y)| Point2::new(x, y))
    }

    /// The unit normal of point `index`, if it is known.
    #[must_use]
    pub fn normal(&self, index: usize) -> Option<Vector2<f64>> {
        let (x, y) = self.raw_normal(index);
        (x != 0.0 || y != 0.0).then(|| Vector2::new(x, y))
    }

    /// The normal as stored: `(0, 0)` if there is none.
    #[inline]
    pub(crate) fn raw_normal(&self, index: usize) -> (f64, f64) {
        if self.normal_xs.is_empty() {
            (0.0, 0.0)
        } else {
            (self.normal_xs[index], self.normal_ys[index])
        }
    }

    /// Whether normals were estimated or added (single points may still lack one).
    #[must_use]
    pub fn has_normals(&self) -> bool {
        !self.normal_xs.is_empty()
    }

    /// Adds a point without a normal.
    pub fn push(&mut self, point: Point2<f64>) {
        self.push_raw(point.x, point.y, 0.0, 0.0);
    }

    /// Adds a point with its normal.
    pub fn push_with_normal(&mut self, point: Point2<f64>, normal: Option<Vector2<f64>>) {
        let normal = normal.unwrap_or_default();
        self.push_raw(point.x, point.y, normal.x, normal.y);
    }

    pub(crate) fn push_raw(&mut self, x: f64, y: f64, normal_x: f64, normal_y: f64) {
        if self.has_normals() || normal_x != 0.0 || normal_y != 0.0 {
            self.normal_xs.resize(self.xs.len(), 0.0);
            self.normal_ys.resize(self.xs.len(), 0.0);
            self.normal_xs.push(normal_x);
            self.normal_ys.push(normal_y);
        }
        self.xs.push(x);
        self.ys.push(y);
    }

    /// Removes all points and keeps the memory.
    pub fn clear(&mut self) {
        self.xs.clear();
        self.ys.clear();
        self.normal_xs.clear();
        self.normal_ys.clear();
    }

    /// The cloud moved by `target_from_source`, with rotated normals.
    #[must_use]
    pub fn transformed(&self, target_from_source: &SE2) -> Self {
        let mut moved = Self {
            stamp_s: self.stamp_s,
            ..Self::default()
        };
        moved.extend_transformed(self, target_from_source);
        moved
    }

    /// Adds the points of `other`, moved by `target_from_source`, with rotated normals.
    pub fn extend_transformed(&mut self, other: &Self, target_from_source: &SE2) {
        let rotation = target_from_source.rotation();
        let (tx, ty) = (target_from_source.x(), target_from_source.y());
        if self.has_normals() || other.has_normals() {
            self.normal_xs.resize(self.xs.len(), 0.0);
            self.normal_ys.resize(self.xs.len(), 0.0);
            for index in 0..other.len() {
                let (nx, ny) = other.raw_normal(index);
                let (nx, ny) = rotation.rotate(nx, ny);
                self.normal_xs.push(nx);
                self.normal_ys.push(ny);
            }
        }
        let points = other.xs.iter().zip(&other.ys);
        let Rotation { cos, sin } = rotation;
        self.xs
            .extend(points.clone().map(|(x, y)| cos * x - sin * y + tx));
        self.ys.extend(points.map(|(x, y)| sin * x + cos * y + ty));
    }

    /// One point for every cell of `cell_m`: the centroid of its points, without normals.
    ///
    /// The order is that of the first point in each cell.
    #[must_use]
    pub fn downsample(&self, cell_m: f64) -> Self {
        let mut thinned = Self::default();
        Downsampler::default().downsample_into(self, cell_m, &mut thinned);
        thinned
    }

    pub(crate) fn set_normals(&mut self, normals: impl ExactSizeIterator<Item = (f64, f64)>) {
        debug_assert_eq!(normals.len(), self.len());
        self.normal_xs.clear();
        self.normal_ys.clear();
        for (x, y) in normals {
            self.normal_xs.push(x);
            self.normal_ys.push(y);
        }
    }
}

impl FromIterator<Point2<f64>> for PointCloud {
    fn from_iter<I: IntoIterator<Item = Point2<f64>>>(points: I) -> Self {
        let mut cloud = Self::default();
        for point in points {
            cloud.push(point);
        }
        cloud
    }
}

/// Voxel downsampling that keeps its memory between clouds; see [`PointCloud::downsample`].
#[derive(Clone, Debug, Default)]
pub struct Downsampler {
    slot_of_cell: FxHashMap<(i32, i32), u32>,
    sums: Vec<(f64, f64, f64)>,
}

impl Downsampler {
    /// Replaces the contents of `thinned` by one centroid for every occupied cell of `cell_m`.
    pub fn downsample_into(&mut self, cloud: &PointCloud, cell_m: f64, thinned: &mut PointCloud) {
        self.slot_of_cell.clear();
        self.sums.clear();
        for (&x, &y) in cloud.xs.iter().zip(&cloud.ys) {
            let cell = (cell_index(x, cell_m), cell_index(y, cell_m));
            let slot = *self.slot_of_cell.entry(cell).or_insert_with(|| {
                self.sums.push((0.0, 0.0, 0.0));
                (self.sums.len() - 1) as u32
            });
            let (sum_x, sum_y, count) = &mut self.sums[slot as usize];
            *sum_x += x;
            *sum_y += y;
            *count += 1.0;
        }
        thinned.clear();
        thinned.stamp_s = cloud.stamp_s;
        for &(sum_x, sum_y, count) in &self.sums {
            thinned.xs.push(sum_x / count);
            thinned.ys.push(sum_y / count);
        }
    }

    /// The mean of `values`, one for each point, in every cell of the last [`downsample_into`](Self::downsample_into),
    /// which has to be of this cloud.
    pub(crate) fn means(&self, cloud: &PointCloud, cell_m: f64, values: &[f64]) -> Vec<f64> {
        let mut sums = vec![(0.0, 0.0); self.sums.len()];
        for (point, value) in cloud.iter().zip(values) {
            let cell = (cell_index(point.x, cell_m), cell_index(point.y, cell_m));
            let (sum, count) = &mut sums[self.slot_of_cell[&cell] as usize];
            *sum += value;
            *count += 1.0;
        }
        let mean = |(sum, count): (f64, f64)| sum / count;
        sums.into_iter().map(mean).collect()
    }
}
