//! How far the first guess may be turned, as an arc round it in the colour of the basin map: what the title asks.

use ch16_lab::basin::{BasinScene, BasinStart, Minimum};
use ch16_slam2d::icp::IcpWorkspace;
use widget_kit::model::Activity;
use widget_kit::scene::{Layer, Stroke, Tone};
use widget_kit::ticks::signed;
use widget_kit::values::Values;

use super::BasinExplorer;
use super::basins::{COLUMNS, REGISTRATIONS_PER_PIECE};
use super::settings::{config, start, variant};
use crate::pose_handle::turn_handle;

/// Angle between two turns, as on the map, °.
const STEP_DEG: f64 = 360.0 / (COLUMNS - 1) as f64;
/// Width of the arc, pixels.
const WIDTH_PX: f32 = 5.0;
/// Width of its outline, pixels.
const OUTLINE_PX: f32 = 1.5;
/// Distance of its word from it, pixels.
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

/// An arc over the turns that end right, and a word at its middle.
pub fn arc(explorer: &BasinExplorer) -> Vec<Layer> {
    let from = start(&explorer.values);
    let at = |heading_deg: f64| {
        let guess = explorer.scene.guess(&BasinStart {
            heading_deg,
            ..from
        });
        let turn = turn_handle(&guess);
        [turn.x, turn.y]
    };
    let ends = explorer.turns.0.iter().enumerate();
    let right = ends.filter(|(_, minimum)| **minimum == Minimum::Right);
    let right: Vec<_> = right.map(|(turn, _)| turn).collect();
    let arcs: Vec<_> = right
        .iter()
        .map(|turn| [-0.5, 0.5].map(|side| at(heading_deg(*turn) + side * STEP_DEG)))
        .collect();
    let middle = arcs.get(arcs.len() / 2);
    let word = middle.map(|arc| Layer::label(arc[0], home(&right), CLEAR_PX));
    // Its colour, that of the basin map, is too light without an outline.
    let arc = |tone, width_px| Layer::segments(arcs.clone(), Stroke::Solid, tone, width_px);
    let arc = [
        arc(Tone::Ink, WIDTH_PX + 2.0 * OUTLINE_PX),
        arc(Tone::Class(0), WIDTH_PX),
    ];
    word.into_iter().chain(arc).collect()
}

/// The turns that end right in words, with their range if it has no gap.
fn home(right: &[usize]) -> String {
    match right {
        [first, .., last] if last - first + 1 == right.len() => {
            let [low, high] = [*first, *last].map(|turn| signed(heading_deg(turn), 0));
            format!("home from {low}° to {high}°")
        }
        _ => "gets home".to_owned(),
    }
}
