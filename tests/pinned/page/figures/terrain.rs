//! Landscapes of w16.3: costs at a shift, the roughness of the ground, and what a sweep knows.

use ch16_lab::terrain::{SceneKind, Terrain, TerrainProbe, TerrainScene, TerrainSettings};
use pr_geom::Vector2;

/// The shift at which the text compares landscapes, m.
const PROBE_M: f64 = 0.6;

/// `room.icp.x06`, `corridor.information.along_std_mm`: by scene, objective and place.
pub fn value(path: &[&str]) -> Option<f64> {
    let settings = TerrainSettings::default();
    let (place, objective, what) = match *path {
        ["probe_m"] => return Some(PROBE_M),
        ["tau_m"] => return Some(settings.tau_m),
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
    let n = settings.n;
    Some(match what {
        "x06" => at(PROBE_M, 0.0),
        "y06" => at(0.0, PROBE_M),
        "x13" => at(settings.span_m, 0.0),
        "x00" | "peak" => at(0.0, 0.0),
        "beside_peak" => at(settings.offset_m(n / 2 + 1), 0.0),
        "x06_percent" => {
            100.0 * at(PROBE_M, 0.0) / Terrain::compute(&scene, &settings).ndt_maximum()?.value
        }
        "lowest_m" => {
            let lowest = Terrain::compute(&scene, &settings).icp_minimum()?;
            let [x, y] = [lowest.column, lowest.row].map(|index| settings.offset_m(index));
            x.hypot(y)
        }
        "local_minima" => dents(Terrain::compute(&scene, &settings).icp_cost_m2(), n, 1.0),
        "local_maxima" => dents(Terrain::compute(&scene, &settings).ndt_score(), n, -1.0),
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

/// What a registration at the truth knows along the corridor, and in the direction known best.
fn known(scene: &TerrainScene, what: &str) -> Option<f64> {
    let information = scene.information(TerrainSettings::default().tau_m);
    match what {
        "along_std_mm" => Some(1e3 / information.eigenvalues[0].sqrt()),
        "across_std_mm" => Some(1e3 / information.matrix[(1, 1)].sqrt()),
        _ => None,
    }
}

/// Inner cells that lie below all of their eight neighbours, after a change of sign.
fn dents(values: &[f64], n: usize, sign: f64) -> f64 {
    let is_dent = |&(column, row): &(usize, usize)| {
        let here = sign * values[row * n + column];
        let block =
            (row - 1..=row + 1).flat_map(|r| (column - 1..=column + 1).map(move |c| (c, r)));
        block
            .filter(|&cell| cell != (column, row))
            .all(|(c, r)| sign * values[r * n + c] > here)
    };
    let inner = (1..n - 1).flat_map(|row| (1..n - 1).map(move |column| (column, row)));
    inner.filter(is_dent).count() as f64
}
