//! The grid that a flat is drawn on.

use pr_sim::sketch::{PlaceCm, limits};

/// What is drawn lies on a grid of so many centimetres.
pub const GRID_CM: i32 = 5;

/// The heading of the start goes in steps of so many degrees.
pub const HEADING_STEP_DEG: i32 = 5;

/// The nearest place of the grid, within what a flat may reach.
pub fn snapped(at: [f64; 2]) -> PlaceCm {
    let most = limits::COORDINATE_CM as i32;
    at.map(|m| {
        let steps = (m * 100.0 / f64::from(GRID_CM)).round();
        (steps as i32).saturating_mul(GRID_CM).clamp(-most, most)
    })
}

/// A place that moved by so much, within what a flat may reach.
pub fn moved(at: PlaceCm, by: PlaceCm) -> PlaceCm {
    let most = limits::COORDINATE_CM as i32;
    [0, 1].map(|axis| at[axis].saturating_add(by[axis]).clamp(-most, most))
}
