//! Poses and walls in a picture.

use pr_geom::{Point2, SE2};
use widget_kit::scene::Layer;

/// Position of a pose.
pub fn xy(pose: &SE2) -> [f64; 2] {
    [pose.x(), pose.y()]
}

/// The walls of a scene, by their ends.
pub fn walls(walls: &[[Point2<f64>; 2]]) -> Layer {
    let ends = walls.iter().map(|wall| wall.map(|end| [end.x, end.y]));
    Layer::Walls(ends.collect())
}
