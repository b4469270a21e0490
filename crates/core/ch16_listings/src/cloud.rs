//! A sweep as points.

use nalgebra::{Point2, Vector2};
use pr_geom::math;

use crate::{SE2, VoxelMap};

/// A return at this share of the longest range or beyond is not a point: the beam hit nothing.
const RANGE_LIMIT_SHARE: f64 = 0.995;
/// Smallest number of neighbours for a normal, the point itself included.
const MIN_NEIGHBORS: usize = 4;
/// Above this ratio of the smaller to the larger scatter a neighbourhood is not a line.
const MAX_FLATNESS: f64 = 0.35;
/// Smallest cell of the search for neighbours, m, and how many points of a cell it keeps.
const NORMAL_CELL: (f64, usize) = (0.05, 64);

/// The points of one sweep, body frame, m.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PointCloud {
    /// Where the beams ended.
    pub points: Vec<Point2<f64>>,
    /// When, s.
    pub stamp: f64,
}

impl PointCloud {
    /// Points of a sweep whose beam k has the bearing `bearings[k]` (rad) and the range `ranges[k]` (m).
    ///
    /// Beams that reached the longest range are dropped: as points they would be a wall in the open.
    #[must_use]
    pub fn from_ranges(ranges: &[f64], bearings: &[f64], max_range: f64, stamp: f64) -> Self {
        let hits = ranges
            .iter()
            .zip(bearings)
            .filter(|(range, _)| **range < RANGE_LIMIT_SHARE * max_range);
        let points = hits.map(|(&range, &bearing)| {
            let (sin, cos) = math::sin_cos(bearing);
            Point2::new(range * cos, range * sin)
        });
        Self {
            points: points.collect(),
            stamp,
        }
    }

    /// The same points in another frame.
    #[must_use]
    pub fn transformed(&self, pose: &SE2) -> Self {
        Self {
            points: self.points.iter().map(|p| pose.transform(p)).collect(),
            stamp: self.stamp,
        }
    }

    /// A unit normal for each point: the direction in which its neighbours within `radius` (m) scatter
    /// least. None at corners and where neighbours are few. The sign is arbitrary.
    #[must_use]
    pub fn normals(&self, radius: f64) -> Vec<Option<Vector2<f64>>> {
        let mut map = VoxelMap::new(math::max(radius, NORMAL_CELL.0), NORMAL_CELL.1);
        map.insert(&self.points, &vec![None; self.points.len()]);
        let normal = |p| normal_of(&map.within(p, radius));
        self.points.iter().map(normal).collect()
    }
}

/// The eigenvector of the smaller eigenvalue of the scatter.
fn normal_of(neighbors: &[Point2<f64>]) -> Option<Vector2<f64>> {
    if neighbors.len() < MIN_NEIGHBORS {
        return None;
    }
    let sum: Vector2<f64> = neighbors.iter().map(|p| p.coords).sum();
    let mean = sum / neighbors.len() as f64;
    let (mut xx, mut xy, mut yy) = (0.0, 0.0, 0.0);
    for p in neighbors {
        let d = p.coords - mean;
        xx += d.x * d.x;
        xy += d.x * d.y;
        yy += d.y * d.y;
    }
    let (center, half_gap) = (0.5 * (xx + yy), math::norm2(0.5 * (xx - yy), xy));
    let (smaller, larger) = (center - half_gap, center + half_gap);
    if smaller / math::max(larger, 1e-12) > MAX_FLATNESS {
        return None;
    }
    // Both rows of S − λ I are orthogonal to the eigenvector; the longer one rounds less.
    let along = if xx > yy {
        Vector2::new(xx - smaller, xy)
    } else {
        Vector2::new(xy, yy - smaller)
    };
    let length = along.norm();
    (length > 0.0).then(|| Vector2::new(-along.y, along.x) / length)
}
