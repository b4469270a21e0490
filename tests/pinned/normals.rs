//! The normals of the target of `basin.json`.

use ch16_slam2d::cloud::PointCloud;
use pr_geom::{Point2, Vector2};
use serde::Deserialize;
use slam2d_tests::{assert_close, reference};

#[derive(Deserialize)]
struct Normals {
    target: Vec<[f64; 2]>,
    normals: Vec<Option<[f64; 2]>>,
}

#[test]
fn normals_of_the_target_are_those_of_the_reference_up_to_sign() {
    let expected: Normals = reference("basin.json");
    let mut cloud: PointCloud = expected
        .target
        .iter()
        .map(|&[x, y]| Point2::new(x, y))
        .collect();
    cloud.estimate_normals(0.3);
    assert_eq!(cloud.len(), expected.normals.len());
    for (index, expected) in expected.normals.iter().enumerate() {
        let normal = cloud.normal(index);
        assert_eq!(normal.is_some(), expected.is_some(), "point {index}");
        let (Some(normal), Some([x, y])) = (normal, expected) else {
            continue;
        };
        let sign = if normal.dot(&Vector2::new(*x, *y)) < 0.0 {
            -1.0
        } else {
            1.0
        };
        assert_close(&format!("x of normal {index}"), sign * normal.x, *x, 1e-9);
        assert_close(&format!("y of normal {index}"), sign * normal.y, *y, 1e-9);
    }
}
