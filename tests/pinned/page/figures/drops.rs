//! Sweeps dropped in w16.3: the scatter of their results.

use ch16_lab::terrain::{Drops, TerrainScene};

use super::terrain::scene_kind;

/// Number of drops in the text.
const COUNT: usize = 100;

/// `count`, `long.std_x_cm`.
pub fn value(path: &[&str]) -> Option<f64> {
    let place = match *path {
        ["count"] => return Some(COUNT as f64),
        [place, "std_x_cm"] => place,
        _ => return None,
    };
    let kind = scene_kind(place)?;
    let scene = TerrainScene::new(kind, TerrainScene::DEFAULT_NDT_CELL_M);
    let mut drops = Drops::new(kind);
    let rests_cm: Vec<f64> = (0..COUNT)
        .filter_map(|number| Some(100.0 * drops.path_m(&scene, number).last()?[0]))
        .collect();
    let mean = rests_cm.iter().sum::<f64>() / COUNT as f64;
    let squares = rests_cm.iter().map(|at| (at - mean).powi(2));
    Some((squares.sum::<f64>() / (COUNT - 1) as f64).sqrt())
}
