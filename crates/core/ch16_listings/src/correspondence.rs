//! Data association: which point of the map belongs to each point of the sweep.

use nalgebra::{Point2, Vector2};
use smallvec::{SmallVec, smallvec};

use crate::{PointCloud, SE2, VoxelMap};

/// A point of the sweep and the map point nearest to it, both in the map's frame, m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Correspondence {
    /// The point of the sweep, moved by the current pose.
    pub src: Point2<f64>,
    /// Its partner.
    pub dst: Point2<f64>,
    /// Unit normal of the partner.
    pub normal: Option<Vector2<f64>>,
}

impl Correspondence {
    /// The directions along which the pair measures: across its wall, or both axes without a normal.
    #[must_use]
    pub fn constrained_directions(&self) -> SmallVec<[Vector2<f64>; 2]> {
        match self.normal {
            Some(normal) => smallvec![normal],
            None => smallvec![Vector2::x(), Vector2::y()],
        }
    }

    /// Squared distance of the two points, m².
    #[must_use]
    pub fn distance_squared(&self) -> f64 {
        (self.src - self.dst).norm_squared()
    }
}

/// Pairs each point, moved by `map_from_cloud`, with its nearest within `tau`; others stay unpaired.
#[must_use]
pub fn associate(
    cloud: &PointCloud,
    map: &VoxelMap,
    map_from_cloud: &SE2,
    tau: f64,
) -> Vec<Correspondence> {
    let moved = cloud.points.iter().map(|p| map_from_cloud.transform(p));
    moved
        .filter_map(|src| {
            let index = map.nearest(&src, tau)? as usize;
            Some(Correspondence {
                src,
                dst: map.pts[index],
                normal: map.normals[index],
            })
        })
        .collect()
}
