//! Landscapes of w16.3: costs at a shift, and the information of a sweep.

use ch16_lab::terrain::{SceneKind, Terrain, TerrainProbe, TerrainScene, TerrainSettings};
use pr_geom::Vector2;

/// The shift at which the text compares landscapes, m.
const PROBE_M: f64 = 0.6;

/// `room.icp.x06`, `corridor.information.along_std_mm`: by scene, objective and shift.
pub fn value(path: &[&str]) -> Option<f64> {
    let settings = TerrainSettings::default();
    let (place, objective, what) = match *path {
        ["probe_m"] => return Some(PROBE_M),
        [place, objective, what] => (place, objective, what),
        _ => return None,
    };
    let scene = TerrainScene::new(scene_kind(place)?, TerrainScene::DEFAULT_NDT_CELL_M);
    if objective == "information" {
        return known(&scene, what);
    }
    let probe = TerrainProbe::new(&scene, &settings);
    let at = |x, y| match objective {
        "icp" => probe.icp_cost_m2(Vector2::new(x, y)),
        _ => probe.ndt_score(Vector2::new(x, y)),
    };
    Some(match what {
        "x06" => at(PROBE_M, 0.0),
        "y06" => at(0.0, PROBE_M),
        "x06_percent" => {
            100.0 * at(PROBE_M, 0.0) / Terrain::compute(&scene, &settings).ndt_maximum()?.value
        }
        _ => return None,
    })
}

/// The scene of that name.
pub fn scene_kind(place: &str) -> Option<SceneKind> {
    match place {
        "room" => Some(SceneKind::Room),
        "corridor" => Some(SceneKind::Corridor),
        "long" => Some(SceneKind::LongCorridor),
        _ => None,
    }
}

/// The information of a registration at the truth along the corridor, and in the best constrained direction.
fn known(scene: &TerrainScene, what: &str) -> Option<f64> {
    let information = scene.information(TerrainSettings::default().tau_m);
    match what {
        "along_std_mm" => Some(1e3 / information.eigenvalues[0].sqrt()),
        "across_std_mm" => Some(1e3 / information.matrix[(1, 1)].sqrt()),
        _ => None,
    }
}
