use super::*;
use crate::basin::BasinScene;
use crate::cloud::cell_index;
use proptest::prelude::*;

/// Half the width of a difference, m and rad.
const H: f64 = 1e-6;

/// The six poses of the central differences along x, y and θ.
fn around(pose: &SE2) -> [(SE2, SE2); 3] {
    let moved = |x, y, theta| SE2::new(pose.x() + x, pose.y() + y, pose.theta() + theta);
    [
        (moved(H, 0.0, 0.0), moved(-H, 0.0, 0.0)),
        (moved(0.0, H, 0.0), moved(0.0, -H, 0.0)),
        (moved(0.0, 0.0, H), moved(0.0, 0.0, -H)),
    ]
}

/// The cells of all points, as the score looks them up.
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
        let scene = BasinScene::new();
        let (cloud, map) = (scene.source(), NdtMap::build(scene.target(), cell_m, 3));
        let truth = scene.truth();
        let pose = SE2::new(truth.x() + dx, truth.y() + dy, truth.theta() + turn_rad);
        // Where a point changes its cell the score jumps, and no difference is a derivative.
        let here = cells(cloud, &map, &pose);
        let stays = |moved: &SE2| cells(cloud, &map, moved) == here;
        prop_assume!(around(&pose).iter().all(|(ahead, behind)| stays(ahead) && stays(behind)));

        let (gradient, _) = linearize(cloud, &map, &pose);
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
fn near_the_truth_every_entry_of_the_gradient_is_large_enough_to_be_seen() {
    let scene = BasinScene::new();
    let map = NdtMap::build(scene.target(), 0.8, 3);
    let pose = scene.truth() * SE2::new(0.1, 0.1, 0.05);
    let (gradient, _) = linearize(scene.source(), &map, &pose);
    assert!(gradient.amin() > 10.0, "{gradient}");
}
