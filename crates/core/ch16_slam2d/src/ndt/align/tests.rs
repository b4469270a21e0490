use nalgebra::Point2;
use pr_geom::math;

use super::*;
use crate::cloud::cell_index;
use proptest::prelude::*;

/// Half the width of a difference, m and rad.
const H: f64 = 1e-6;

/// Pose of the source in the frame of the target.
fn truth() -> SE2 {
    SE2::new(0.4, -0.3, 0.35)
}

/// The walls of a room with an alcove, with errors of up to a centimetre, as two clouds of different points: a
/// target, and a source seen from [`truth`].
fn room() -> (PointCloud, PointCloud) {
    let corners = [
        (-2.3, -1.6),
        (2.1, -1.6),
        (2.1, 0.4),
        (2.9, 0.4),
        (2.9, 1.7),
        (-2.3, 1.7),
        (-2.3, -1.6),
    ];
    let (mut target, mut source) = (PointCloud::default(), PointCloud::default());
    for wall in corners.windows(2) {
        let ((x0, y0), (x1, y1)) = (wall[0], wall[1]);
        let length = math::norm2(x1 - x0, y1 - y0);
        let steps = (length / 0.03) as usize;
        for step in 0..steps {
            let share = step as f64 / steps as f64;
            let off = 0.002 * ((step * 7919 % 11) as f64 - 5.0);
            let (nx, ny) = ((y0 - y1) / length, (x1 - x0) / length);
            let point = Point2::new(
                x0 + share * (x1 - x0) + off * nx,
                y0 + share * (y1 - y0) + off * ny,
            );
            match step % 2 {
                0 => target.push(point),
                _ => source.push(truth().inverse().transform(point)),
            }
        }
    }
    (target, source)
}

/// The six poses of the central differences along x, y and θ.
fn around(pose: &SE2) -> [(SE2, SE2); 3] {
    let moved = |x, y, theta| SE2::new(pose.x() + x, pose.y() + y, pose.theta() + theta);
    [
        (moved(H, 0.0, 0.0), moved(-H, 0.0, 0.0)),
        (moved(0.0, H, 0.0), moved(0.0, -H, 0.0)),
        (moved(0.0, 0.0, H), moved(0.0, 0.0, -H)),
    ]
}

/// The cells of all points, by the lookup of the score.
fn cells(cloud: &PointCloud, map: &NdtMap, pose: &SE2) -> Vec<(i32, i32)> {
    let cell = |coordinate_m| cell_index(coordinate_m, map.cell_m());
    cloud
        .iter()
        .map(|point| pose.transform(point))
        .map(|point| (cell(point.x), cell(point.y)))
        .collect()
}

proptest! {
    #[test]
    fn the_gradient_is_that_of_the_negative_score(
        dx in -0.5..0.5, dy in -0.5..0.5, turn_rad in -0.5..0.5, cell_m in 0.4..1.5,
    ) {
        let (target, cloud) = room();
        let (cloud, map) = (&cloud, NdtMap::build(&target, cell_m, 3));
        let pose = SE2::new(truth().x() + dx, truth().y() + dy, truth().theta() + turn_rad);
        // If a point changes its cell, the score jumps, and the difference is not a derivative.
        let here = cells(cloud, &map, &pose);
        let stays = |moved: &SE2| cells(cloud, &map, moved) == here;
        prop_assume!(around(&pose).iter().all(|(ahead, behind)| stays(ahead) && stays(behind)));

        let gradient = score_with_slope(cloud, &map, &pose).1.gradient;
        let score = |pose: &SE2| map.score(cloud, pose);
        let numeric = around(&pose).map(|(ahead, behind)| (score(&behind) - score(&ahead)) / (2.0 * H));
        for (axis, (exact, numeric)) in gradient.iter().zip(numeric).enumerate() {
            // 1e-5 of the gradient's size: H²/6 times the third derivative of a Gaussian as narrow as
            // a wall, and the rounding of the score over 2 H.
            let tolerance = 1e-5 * (1.0 + gradient.norm());
            prop_assert!(
                (exact - numeric).abs() < tolerance,
                "axis {axis} at {pose:?}: {exact} against {numeric}"
            );
        }
    }
}

#[test]
fn gradient_entries_near_the_truth_exceed_the_test_tolerance() {
    let (target, cloud) = room();
    let map = NdtMap::build(&target, 0.8, 3);
    let pose = truth() * SE2::new(0.1, 0.1, 0.05);
    let gradient = score_with_slope(&cloud, &map, &pose).1.gradient;
    assert!(gradient.amin() > 10.0, "{gradient}");
}
