//! A scan for the tests of all fields.

use nalgebra::{Point2, Vector2};

use ch16_slam2d::cloud::PointCloud;

/// Two walls of a room and a post, seen from its middle, with normals.
pub fn corner() -> PointCloud {
    let mut cloud = PointCloud::default();
    for k in 0..30 {
        let along = 0.12 * f64::from(k) - 1.7;
        cloud.push_with_normal(Point2::new(along, -1.5), Some(Vector2::y()));
        cloud.push_with_normal(Point2::new(1.9, along + 0.2), Some(Vector2::x()));
    }
    cloud.push(Point2::new(0.4, 1.1));
    cloud
}
