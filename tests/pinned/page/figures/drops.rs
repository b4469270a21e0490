//! Sweeps dropped in w16.3: the scatter of their results.

use ch16_lab::terrain::{DROP_SPREAD_M, Drops, SceneKind, TerrainScene, TerrainSettings};

use super::terrain::scene_kind;

/// Number of drops in the text.
const COUNT: usize = 100;

/// Maps of the bare corridor that differ in their noise.
const MAPS: u32 = 12;

/// `count`, `long.std_x_cm`, `long.from_60.std_x_cm`: by location, and by the spread of the starts in cm.
pub fn value(path: &[&str]) -> Option<f64> {
    let (place, spread_m) = match *path {
        ["count"] => return Some(COUNT as f64),
        ["spread_m"] => return Some(DROP_SPREAD_M),
        ["maps"] => return Some(f64::from(MAPS)),
        ["long", "along_std_mm", "least"] => return claims_mm().reduce(f64::min),
        ["long", "along_std_mm", "most"] => return claims_mm().reduce(f64::max),
        [place, "std_x_cm"] => (place, DROP_SPREAD_M),
        [place, "from_0", "std_x_cm"] => (place, 0.0),
        [place, "from_60", "std_x_cm"] => (place, 0.6),
        _ => return None,
    };
    let kind = scene_kind(place)?;
    let scene = TerrainScene::new(kind, TerrainScene::DEFAULT_NDT_CELL_M);
    let mut drops = Drops::new(kind).with_spread(spread_m);
    let rests_cm: Vec<f64> = (0..COUNT)
        .filter_map(|number| Some(100.0 * drops.path_m(&scene, number).last()?[0]))
        .collect();
    let mean = rests_cm.iter().sum::<f64>() / COUNT as f64;
    let squares = rests_cm.iter().map(|at| (at - mean).powi(2));
    Some((squares.sum::<f64>() / (COUNT - 1) as f64).sqrt())
}

/// The standard deviation along the bare corridor that a sweep claims on each map, mm.
fn claims_mm() -> impl Iterator<Item = f64> {
    (0..MAPS).map(|k| {
        let scene = TerrainScene::with_seed(
            SceneKind::LongCorridor,
            TerrainScene::DEFAULT_NDT_CELL_M,
            TerrainScene::SEED + k,
        );
        let information = scene.information(TerrainSettings::default().tau_m);
        1e3 / information.eigenvalues[0].sqrt()
    })
}
