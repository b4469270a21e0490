//! Rows of the point-to-plane step in w16.3, and their constraints.

use ch16_lab::terrain::{PlaneRows, TerrainScene, TerrainSettings};

use super::terrain::scene_kind;

/// Deviation of the row of odometry, m.
const WHEELS_SIGMA_M: f64 = 0.05;

/// `long.2.rank`, `long.wheels.along_m`: by place, rows and question.
pub fn value(path: &[&str]) -> Option<f64> {
    let [place, taken, what] = *path else {
        return None;
    };
    let scene = TerrainScene::new(scene_kind(place)?, TerrainScene::DEFAULT_NDT_CELL_M);
    let rows = PlaneRows::from_scene(&scene, TerrainSettings::default().tau_m);
    let (taken, sigma_m) = match taken {
        "all" => (rows.rows.len(), None),
        "wheels" => (rows.rows.len(), Some(WHEELS_SIGMA_M)),
        count => (count.parse().ok()?, None),
    };
    let know = rows.constraints(taken, sigma_m);
    match what {
        "taken" => Some(taken as f64),
        "rank" => Some(know.rank as f64),
        "null_x" => know.null.map(|null| null.x),
        "along_m" => know.along_m,
        "sigma_m" => sigma_m,
        _ => None,
    }
}
