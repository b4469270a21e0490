//! Normals from the scatter of a point's neighbours.

use nalgebra::{Point2, Vector2};
use pr_geom::math;

use super::{DenseMap, PointCloud};

/// Smallest number of neighbours for a normal, the point itself included.
pub(crate) const MIN_NEIGHBORS: usize = 4;
/// Above this ratio of smallest to largest scatter the neighbourhood is not a line.
pub(crate) const MAX_FLATNESS: f64 = 0.35;
/// Smallest cell of the neighbour search, m.
const MIN_CELL_M: f64 = 0.05;
/// Neighbour search keeps this many points of a cell.
const MAX_PER_CELL: usize = 64;

/// Estimates normals: the direction of least scatter of a point's neighbours.
///
/// For the neighbours `p_k` within the radius (inclusive, including the point itself) with mean
/// `m`, the scatter is `Σ (p_k − m)(p_k − m)ᵀ`, 2×2. The normal is the unit eigenvector of the
/// smaller eigenvalue; its sign is arbitrary. There is none with fewer than 4 neighbours, or
/// if the smaller eigenvalue exceeds 0.35 of the larger: a corner or a blob has no normal.
///
/// The estimator keeps its memory between clouds. [`NormalEstimator::prepare`] followed by
/// [`NormalEstimator::normal_at`] computes single normals on demand.
#[derive(Clone, Debug, Default)]
pub struct NormalEstimator {
    map: Option<DenseMap>,
    radius_m: f64,
    neighbors: Vec<(f64, f64)>,
    normals: Vec<(f64, f64)>,
}

impl PointCloud {
    /// Estimates the normal of every point from its neighbours within `radius_m`.
    ///
    /// See [`NormalEstimator`] for the rules; use that directly to keep its memory between clouds.
    pub fn estimate_normals(&mut self, radius_m: f64) {
        NormalEstimator::default().estimate(self, radius_m);
    }
}

impl NormalEstimator {
    /// Sets the normal of every point of `cloud` from its neighbours within `radius_m`.
    pub fn estimate(&mut self, cloud: &mut PointCloud, radius_m: f64) {
        self.prepare(cloud, radius_m);
        let mut normals = std::mem::take(&mut self.normals);
        normals.clear();
        normals.extend(cloud.iter().map(|point| {
            let normal = self.normal_at(point).unwrap_or_default();
            (normal.x, normal.y)
        }));
        cloud.set_normals(normals.iter().copied());
        self.normals = normals;
    }

    /// Indexes `cloud` for [`NormalEstimator::normal_at`].
    pub fn prepare(&mut self, cloud: &PointCloud, radius_m: f64) {
        let cell_m = radius_m.max(MIN_CELL_M);
        let map = match self.map.take() {
            Some(mut map) if map.cell_m() == cell_m => {
                map.rebuild(cloud);
                map
            }
            _ => DenseMap::from_cloud(cloud, cell_m, MAX_PER_CELL),
        };
        self.map = Some(map);
        self.radius_m = radius_m;
    }

    /// The normal of the prepared cloud at one of its points.
    #[must_use]
    pub fn normal_at(&mut self, point: Point2<f64>) -> Option<Vector2<f64>> {
        let map = self.map.as_ref()?;
        let neighbors = &mut self.neighbors;
        neighbors.clear();
        map.for_each_within(point, self.radius_m, |index| {
            neighbors.push((map.xs()[index], map.ys()[index]));
        });
        normal_of(neighbors)
    }
}

fn normal_of(neighbors: &[(f64, f64)]) -> Option<Vector2<f64>> {
    if neighbors.len() < MIN_NEIGHBORS {
        return None;
    }
    let count = neighbors.len() as f64;
    let (mut mean_x, mut mean_y) = (0.0, 0.0);
    for (x, y) in neighbors {
        mean_x += x;
        mean_y += y;
    }
    mean_x /= count;
    mean_y /= count;
    let (mut xx, mut xy, mut yy) = (0.0, 0.0, 0.0);
    for (x, y) in neighbors {
        let (dx, dy) = (x - mean_x, y - mean_y);
        xx += dx * dx;
        xy += dx * dy;
        yy += dy * dy;
    }
    let half_gap = math::norm2(0.5 * (xx - yy), xy);
    let center = 0.5 * (xx + yy);
    let (smallest, largest) = (center - half_gap, center + half_gap);
    if smallest / math::max(largest, 1e-12) > MAX_FLATNESS {
        return None;
    }
    // Both rows of (S − λ_min I) are orthogonal to the eigenvector; the longer one rounds less.
    let (along_x, along_y) = if xx > yy {
        (xx - smallest, xy)
    } else {
        (xy, yy - smallest)
    };
    let length = math::norm2(along_x, along_y);
    // Infinite for points 1e150 m apart.
    (length > 0.0 && length.is_finite()).then(|| Vector2::new(-along_y / length, along_x / length))
}
