//! A submap that never changes again.

use std::sync::Arc;

use nalgebra::{Point2, Vector2};
use pr_geom::SE2;

use super::FinishedGrid;
use super::probability_grid::Walls;
use crate::cloud::PointCloud;
use crate::icp::Pair;

/// A finished submap.
#[derive(Clone, Debug, PartialEq)]
pub struct FinishedSubmap {
    /// The keyframe whose frame is the submap's.
    pub anchor: usize,
    /// The keyframes that were added to it, the anchor first.
    pub nodes: Vec<usize>,
    /// Scans that it holds.
    pub scans: usize,
    /// Its grid, in the anchor's frame.
    pub grid: Arc<FinishedGrid>,
}

/// The points of a scan that lie at walls of a grid, each with the direction in which the grid holds
/// it: what such a registration measures.
pub(super) fn wall_pairs(
    grid: &impl Walls,
    scan: &PointCloud,
    grid_from_scan: &SE2,
    occupied: f64,
    pairs: &mut Vec<Pair>,
) {
    pairs.clear();
    let rotation = grid_from_scan.rotation();
    for (index, point) in scan.iter().enumerate() {
        let at: Point2<f64> = grid_from_scan.transform(point);
        if !grid.is_wall(at, occupied) {
            continue;
        }
        let (x, y) = scan.raw_normal(index);
        let (x, y) = rotation.rotate(x, y);
        pairs.push(Pair {
            source_index: index,
            target_index: index,
            source: at,
            target: at,
            normal: (x != 0.0 || y != 0.0).then(|| Vector2::new(x, y)),
        });
    }
}
