//! How every turn of the first guess ends: a ring round it, in the colours of the basin map, of which it is a row.

use ch16_lab::basin::{BasinStart, Minimum};
use widget_kit::scene::{Layer, Stroke, Tone};

use super::BasinExplorer;
use super::basins::{COLUMNS, ROWS, class};
use super::settings::{start, variant};
use crate::pose_handle::turn_handle;

/// Width of the ring, pixels.
const WIDTH_PX: f32 = 5.0;
/// Distance of the ring's word from it, pixels.
const CLEAR_PX: f32 = 10.0;

/// The ring, as far as the map is filled, and a word at the turns that end right.
pub fn ring(explorer: &BasinExplorer) -> Vec<Layer> {
    let map = explorer.basins.map(variant(&explorer.values));
    let from = start(&explorer.values);
    let (_, row) = map.axes().position(&from);
    let row = row.round().clamp(0.0, (ROWS - 1) as f64) as usize;
    let at = |heading_deg: f64| {
        let guess = explorer.scene.guess(&BasinStart {
            heading_deg,
            ..from
        });
        let turn = turn_handle(&guess);
        [turn.x, turn.y]
    };
    let half_deg = 180.0 / (COLUMNS - 1) as f64;
    let mut arcs: [Vec<[[f64; 2]; 2]>; 8] = Default::default();
    for column in 0..COLUMNS {
        let heading_deg = map.axes().start(column, row).heading_deg;
        if let Some(minimum) = map.shown(column, row) {
            let ends = [heading_deg - half_deg, heading_deg + half_deg];
            arcs[usize::from(class(minimum))].push(ends.map(at));
        }
    }
    let right = map.shown(COLUMNS / 2, row) == Some(Minimum::Right);
    let word = right.then(|| Layer::label(at(0.0), "ends right".to_owned(), CLEAR_PX));
    let arcs = (0..).zip(arcs).filter(|(_, arcs)| !arcs.is_empty());
    let arcs = arcs
        .map(|(class, arcs)| Layer::segments(arcs, Stroke::Solid, Tone::Class(class), WIDTH_PX));
    arcs.chain(word).collect()
}
