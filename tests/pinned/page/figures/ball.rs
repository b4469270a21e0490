//! Balls of w16.3: where gradient descent stops.

use ch16_lab::terrain::{Ball, BallConfig, Objective, TerrainProbe, TerrainScene, TerrainSettings};
use pr_geom::Vector2;

use super::terrain::scene_kind;

/// Distance from the truth at which a ball stops. `reach` is τ for ICP and the cell for NDT; all in cm.
pub fn rest_m(place: &str, objective: &str, reach_and_start_cm: [&str; 3]) -> Option<f64> {
    let [reach, dx, dy] = reach_and_start_cm.map(|cm| cm.parse::<f64>().map(|cm| 0.01 * cm));
    let (reach_m, start_m) = (reach.ok()?, Vector2::new(dx.ok()?, dy.ok()?));
    let mut settings = TerrainSettings::default();
    let (objective, ndt_cell_m) = match objective {
        "icp" => {
            settings.tau_m = reach_m;
            (Objective::IcpCost, TerrainScene::DEFAULT_NDT_CELL_M)
        }
        "ndt" => (Objective::NdtScore, reach_m),
        _ => return None,
    };
    let scene = TerrainScene::new(scene_kind(place)?, ndt_cell_m);
    let probe = TerrainProbe::new(&scene, &settings);
    let mut ball = Ball::new(objective, start_m, BallConfig::default());
    loop {
        let step = ball.step(&probe);
        if step.stop.is_some() {
            return Some(step.offset_m.norm());
        }
    }
}
