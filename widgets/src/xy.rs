//! Poses in a picture.

use pr_geom::SE2;

/// Position of a pose.
pub fn xy(pose: &SE2) -> [f64; 2] {
    [pose.x(), pose.y()]
}
