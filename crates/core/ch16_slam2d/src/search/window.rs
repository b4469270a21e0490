//! The window of a search, and the neighbourhood of a pose.

use core::f64::consts::PI;

use pr_geom::{Point2, SE2};

use super::LikelihoodGrid;

/// The searched poses: `map_from_scan` within these half-widths of a centre.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SearchWindow {
    /// The centre, `map_from_scan`.
    pub center: SE2,
    /// Half its width along the map's x, m.
    pub half_x_m: f64,
    /// Half its width along the map's y, m.
    pub half_y_m: f64,
    /// Half its range of headings, rad; π or more is the full turn.
    pub half_turn_rad: f64,
}

impl SearchWindow {
    /// A square of ± `half_width_m` around `center`, headings of ± `half_turn_rad`.
    #[must_use]
    pub fn around(center: SE2, half_width_m: f64, half_turn_rad: f64) -> Self {
        Self {
            center,
            half_x_m: half_width_m,
            half_y_m: half_width_m,
            half_turn_rad,
        }
    }

    /// The whole map at every heading, to relocalize a lost robot.
    #[must_use]
    pub fn whole(grid: &LikelihoodGrid) -> Self {
        let (low, high) = (grid.min_m(), grid.max_m());
        let middle = Point2::from((low.coords + high.coords) / 2.0);
        Self {
            center: SE2::from_xy(middle.x, middle.y),
            half_x_m: (high.x - low.x) / 2.0,
            half_y_m: (high.y - low.y) / 2.0,
            half_turn_rad: PI,
        }
    }
}

/// The neighbourhood of a pose, outside of which another pose is distinct.
///
/// The runner-up is the best pose that is farther from the best one than this in x, in y or in its
/// heading.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SearchNeighborhood {
    /// Along x and along y, m.
    pub reach_m: f64,
    /// In the heading, rad.
    pub turn_rad: f64,
}

impl Default for SearchNeighborhood {
    fn default() -> Self {
        Self {
            reach_m: 0.5,
            turn_rad: 0.35,
        }
    }
}
