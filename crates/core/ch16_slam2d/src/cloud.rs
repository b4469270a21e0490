//! Point clouds and maps for nearest-neighbour search.
//!
//! - [`PointCloud`] stores points, and normals if they were estimated, as one array per coordinate.
//! - [`VoxelMap`] is the chapter's map: hashed cells, points added at any time, no bound on the extent.
//! - [`DenseMap`] is the same map, immutable: built at once from a cloud, faster to query, same answers.
//! - [`NearestTable`] precomputes the answers, for one map and very many queries.
//!
//! All maps implement [`NearestMap`], so registration does not depend on the kind of map.

mod cell_table;
mod csv;
mod dense_map;
mod nearest;
mod nearest_table;
mod normals;
mod point_cloud;
mod voxel_map;

pub use csv::CsvError;
pub use dense_map::DenseMap;
pub use nearest::{NearestMap, Neighbor, QueryCache};
pub use nearest_table::NearestTable;
pub use normals::NormalEstimator;
pub(crate) use normals::{MAX_FLATNESS, MIN_NEIGHBORS};
pub use point_cloud::{Downsampler, PointCloud};
pub use voxel_map::VoxelMap;

/// Index of the cell that holds `coordinate_m`, for cells of `cell_m` that tile the axis from 0.
#[inline]
#[must_use]
pub fn cell_index(coordinate_m: f64, cell_m: f64) -> i32 {
    let cells = coordinate_m / cell_m;
    // The cast truncates towards zero and saturates: everything beyond ±2³¹ cells shares the
    // outermost one. `floor` itself is a function call without SSE 4.1.
    let toward_zero = cells as i32;
    toward_zero.saturating_sub(i32::from(cells < f64::from(toward_zero)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cell_index_is_the_floor_for_either_sign_and_saturates() {
        for k in -4000_i32..4000 {
            for offset in [0.0, 1e-13, 0.3, 0.999_999] {
                let x = f64::from(k) + offset;
                assert_eq!(cell_index(x, 1.0), x.floor() as i32, "{x}");
                assert_eq!(cell_index(x, 0.3), (x / 0.3).floor() as i32, "{x}");
            }
        }
        assert_eq!(cell_index(-1e-300, 1.0), -1);
        assert_eq!(cell_index(1e30, 1.0), i32::MAX);
        assert_eq!(cell_index(-1e30, 1.0), i32::MIN);
        assert_eq!(cell_index(f64::NAN, 1.0), 0);
    }
}
