//! Why a search cannot start.

use thiserror::Error;

use super::MAX_GRID_CELLS;

/// Why a search cannot start.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum SearchError {
    /// The map has no finite point.
    #[error("the map has no points; search on a map that has some")]
    EmptyMap,
    /// The scan has no finite point.
    #[error("the scan has no points; search with a scan that has some")]
    EmptyScan,
    /// The map is too wide for its cells.
    #[error(
        "the map needs {columns} × {rows} cells of {cell_m} m, more than {MAX_GRID_CELLS} or than 16000 along a side; take larger cells"
    )]
    MapTooLarge {
        /// Columns that it would have.
        columns: u64,
        /// Rows that it would have.
        rows: u64,
        /// Side of a cell, m.
        cell_m: f64,
    },
    /// A length of the map's cells is no length.
    #[error("cells of {cell_m} m with a blur of {sigma_m} m are no map; both must be above 0")]
    NoCells {
        /// Side of a cell, m.
        cell_m: f64,
        /// Standard deviation of the blur, m.
        sigma_m: f64,
    },
    /// The window is not finite, or has more poses than can be numbered.
    #[error(
        "the window of ±{half_x_m} m × ±{half_y_m} m × ±{half_turn_rad} rad cannot be searched; take finite half-widths, and smaller ones or larger cells"
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
