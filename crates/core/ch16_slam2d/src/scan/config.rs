//! Settings for making a cloud from a scan.

/// Settings for making a cloud from a scan; the defaults are the chapter's.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScanConfig {
    /// A sweep is thinned to one point in each cell of this side, m.
    pub cell_m: f64,
    /// Radius of the neighbours for normals within a sweep, m.
    pub normal_radius_m: f64,
}

impl Default for ScanConfig {
    fn default() -> Self {
        Self {
            cell_m: 0.12,
            normal_radius_m: 0.3,
        }
    }
}
