//! Why a search cannot start.

use thiserror::Error;

use super::MAX_GRID_CELLS;

/// Why a search cannot start.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum SearchError {
    /// The map has no finite point.
    #[error("the map has no finite points; use a map with points")]
    EmptyMap,
    /// The scan has no finite point.
    #[error("the scan has no finite points; use a scan with returns")]
    EmptyScan,
    /// The map is too large for its cell size.
    #[error(
        "the map needs {columns} × {rows} cells of {cell_m} m, more than {MAX_GRID_CELLS} or than 16000 along a side; use larger cells"
    )]
    MapTooLarge {
        /// Number of columns needed.
        columns: u64,
        /// Number of rows needed.
        rows: u64,
        /// Side of a cell, m.
        cell_m: f64,
    },
    /// Cell size or blur is not positive.
    #[error("cell size {cell_m} m and blur {sigma_m} m must both be above 0")]
    NoCells {
        /// Side of a cell, m.
        cell_m: f64,
        /// Standard deviation of the blur, m.
        sigma_m: f64,
    },
    /// The window is not finite, or has too many poses.
    #[error(
        "the window of ±{half_x_m} m × ±{half_y_m} m × ±{half_turn_rad} rad cannot be searched; use finite half-widths, and smaller ones or larger cells"
    )]
    Window {
        /// Half its width along x, m.
        half_x_m: f64,
        /// Half its width along y, m.
        half_y_m: f64,
        /// Half its range of headings, rad.
        half_turn_rad: f64,
    },
}
