//! How every turn of the first guess ends, as a ring round it in the colours of the basin map: what the title asks.

use ch16_lab::basin::{BasinScene, BasinStart, Minimum};
use ch16_slam2d::icp::IcpWorkspace;
use widget_kit::model::Activity;
use widget_kit::scene::{Layer, Stroke, Tone};
use widget_kit::values::Values;

use super::BasinExplorer;
use super::basins::{COLUMNS, REGISTRATIONS_PER_PIECE, class};
use super::settings::{config, start, variant};
use crate::pose_handle::turn_handle;

/// Angle between two turns, as on the map, °.
const STEP_DEG: f64 = 360.0 / (COLUMNS - 1) as f64;
/// Width of the ring, pixels.
const WIDTH_PX: f32 = 5.0;
/// Distance of the ring's word from it, pixels.
const CLEAR_PX: f32 = 10.0;

/// The minima that the turns reach, in order, as far as they are computed.
#[derive(Default)]
pub struct Turns(Vec<Minimum>);

impl Turns {
    /// Forgets them, because the guess or a setting changed.
    pub fn clear(&mut self) {
        self.0.clear();
    }

    /// Registers some of those that remain.
    pub fn work(
        &mut self,
        scene: &BasinScene,
        values: &Values,
        workspace: &mut IcpWorkspace,
    ) -> Activity {
        let config = config(values, variant(values));
        let done = self.0.len();
        let next = done..COLUMNS.min(done + REGISTRATIONS_PER_PIECE);
        if next.is_empty() {
            return Activity::Idle;
        }
        for turn in next {
            let start = BasinStart {
                heading_deg: heading_deg(turn),
                ..start(values)
            };
            let end = scene.register_from(&start, &config, workspace);
            self.0.push(end.ending);
        }
        Activity::Busy
    }
}

fn heading_deg(turn: usize) -> f64 {
    STEP_DEG * turn as f64 - 180.0
}

/// The ring, and a word at the turns that end right.
pub fn ring(explorer: &BasinExplorer) -> Vec<Layer> {
    let from = start(&explorer.values);
    let at = |heading_deg: f64| {
        let guess = explorer.scene.guess(&BasinStart {
            heading_deg,
            ..from
        });
        let turn = turn_handle(&guess);
        [turn.x, turn.y]
    };
    let ends = &explorer.turns.0;
    let mut arcs: [Vec<[[f64; 2]; 2]>; 8] = Default::default();
    for (turn, minimum) in ends.iter().enumerate() {
        let middle_deg = heading_deg(turn);
        let ends = [middle_deg - 0.5 * STEP_DEG, middle_deg + 0.5 * STEP_DEG];
        arcs[usize::from(class(*minimum))].push(ends.map(at));
    }
    let is_right = ends.get(COLUMNS / 2) == Some(&Minimum::Right);
    let word = is_right.then(|| Layer::label(at(0.0), "ends right".to_owned(), CLEAR_PX));
    let arcs = (0..).zip(arcs).filter(|(_, arcs)| !arcs.is_empty());
    let arcs = arcs
        .map(|(class, arcs)| Layer::segments(arcs, Stroke::Solid, Tone::Class(class), WIDTH_PX));
    arcs.chain(word).collect()
}
