//! The grid of the drawing.

use pr_sim::sketch::{PlaceCm, limits};

/// Spacing of the grid, cm.
pub const GRID_CM: i32 = 5;

/// Step of the start's heading, degrees.
pub const HEADING_STEP_DEG: i32 = 5;

/// The nearest point of the grid, within the limits of a flat.
pub fn snapped(at: [f64; 2]) -> PlaceCm {
    let most = limits::COORDINATE_CM as i32;
    at.map(|m| {
        let steps = (m * 100.0 / f64::from(GRID_CM)).round();
        (steps as i32).saturating_mul(GRID_CM).clamp(-most, most)
    })
}

/// A shifted point, within the limits of a flat.
pub fn moved(at: PlaceCm, by: PlaceCm) -> PlaceCm {
    let most = limits::COORDINATE_CM as i32;
    [0, 1].map(|axis| at[axis].saturating_add(by[axis]).clamp(-most, most))
}
