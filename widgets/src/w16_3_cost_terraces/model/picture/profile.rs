//! The ground under the ball, from its drop along its path and straight on to the truth.

use pr_geom::math;
use widget_kit::scene::{Aspect, Axis, Layer, Panel, Stroke, Tone, Weight};

use super::{PictureState, ball, name};
use crate::w16_3_cost_terraces::model::landscape::Landscape;

/// Columns that fill the ground: they touch on the widest screen.
const COLUMNS: usize = 240;
const COLUMN_PX: f32 = 4.0;

/// Part of the axis of heights above the highest ground: room for the ball and the words.
const SKY: f64 = 0.6;

/// The lens over a ball that stuck, as shares of the axes: its half width, its smallest height and its top.
const LENS_HALF_WIDTH: f64 = 0.2;
const LENS_HEIGHT: f64 = 0.22;
const LENS_TOP: f64 = 0.84;
/// Heights in it, as shares of its own: the lowest ground, and the rim of the dent.
const LENS_FLOOR: f64 = 0.2;
const LENS_RIM: f64 = 0.65;

/// Steps in which the axes grow: they stay during most of a drag.
const AXIS_STEP_M: f64 = 0.65;
const AXIS_STEP_PERCENT: f64 = 25.0;

/// The height as a share of the whole range of the landscape, the same scale for both measures.
pub fn panel(landscape: &Landscape, moment: PictureState) -> Panel {
    let ground: Vec<[f64; 2]> = landscape
        .profile()
        .iter()
        .map(|[at, height]| [*at, 100.0 * landscape.share(*height)])
        .collect();
    let length_m = ground[ground.len() - 1][0];
    // A profile is as high as its ground: on a plain near 100 % the steps are low.
    let highest = ground.iter().map(|at| at[1]).fold(1.0, f64::max);
    let [far, high] = [
        (1.04 * length_m.max(0.05), AXIS_STEP_M),
        (highest, AXIS_STEP_PERCENT),
    ]
    .map(|(end, step)| step * (end / step).ceil());
    let step = moment.step.min(landscape.ball.steps());
    let sky = SKY * high;
    let flag = [[length_m, 0.0], [length_m, highest + 0.25 * sky]];
    let title = if step < landscape.ball.steps() {
        "From drop to truth".to_owned()
    } else if landscape.ball.is_home() {
        format!("{}’s ball is home", name(moment.measure))
    } else {
        let off_m = landscape.ball.rest_distance_m();
        format!("{}’s ball sticks {off_m:.2} m off", name(moment.measure))
    };
    let mut layers = vec![
        Layer::segments(columns(&ground), Stroke::Solid, Tone::Faint, COLUMN_PX),
        Layer::segments(vec![flag], Stroke::Dashed, Tone::Truth, 1.5),
        Layer::line(ground.clone(), Stroke::Solid, Tone::Ink, 2.0),
    ];
    layers.extend(ball(ground[step]));
    if step == landscape.ball.steps() && !landscape.ball.is_home() {
        layers.extend(lens(landscape, &ground, ground[step], [far, high + sky]));
    }
    layers.push(Layer::label(flag[1], "truth".to_owned(), 6.0));
    if step == 0 && landscape.ball.steps() > 0 {
        layers = vec![Layer::Question(
            "How deep is the pit it stops in?".to_owned(),
        )];
    }
    Panel {
        id: "path",
        title,
        weight: Weight::Side,
        aspect: Aspect::Free,
        x: Axis::new("from the drop (m)", 0.0, far),
        y: Axis::hidden(0.0, high + sky),
        layers,
        legend: Vec::new(),
        color_bar: None,
    }
}

/// A lens over a ball that stuck: the dent that holds it is too flat to be seen at the scale of the ground.
fn lens(
    landscape: &Landscape,
    ground: &[[f64; 2]],
    ball_at: [f64; 2],
    [far, top]: [f64; 2],
) -> Vec<Layer> {
    let around = &landscape.around;
    let [reach_m, rest] = [around[around.len() - 1][0], around[around.len() / 2][1]];
    let rises = around
        .iter()
        .map(|[at, height]| [*at, landscape.share(*height) - landscape.share(rest)]);
    let ahead = rises.clone().filter(|[at, _]| *at > 0.0);
    let rim = ahead.fold(0.0, |rim, [_, rise]| math::max(rim, rise));
    if rim <= 0.0 {
        return Vec::new();
    }
    // Between the drop and the truth, on the ground below it or under the top.
    let half = LENS_HALF_WIDTH * far;
    let truth = ground[ground.len() - 1][0];
    let middle = ball_at[0].min(truth - 1.1 * half).max(half);
    let under = ground.iter().filter(|at| (at[0] - middle).abs() <= half);
    let ceiling = LENS_TOP * top;
    let bottom = under.map(|at| at[1]).fold(ball_at[1], f64::max);
    let bottom = (bottom + 0.1 * top).min(ceiling - LENS_HEIGHT * top);
    let tall = (ceiling - bottom).min(2.0 * LENS_HEIGHT * top);
    let [left, right, ceiling] = [middle - half, middle + half, bottom + tall];
    let magnified = (LENS_RIM - LENS_FLOOR) * tall / rim;
    let seen: Vec<[f64; 2]> = rises
        .map(|[at, rise]| {
            let height = bottom + LENS_FLOOR * tall + magnified * rise;
            [middle + half * at / reach_m, height.clamp(bottom, ceiling)]
        })
        .collect();
    let bed = seen.iter().map(|at| [[at[0], bottom], *at]).collect();
    let corners = [
        [left, bottom],
        [right, bottom],
        [right, ceiling],
        [left, ceiling],
    ];
    let frame = [0, 1, 2, 3, 0].map(|corner| corners[corner]).to_vec();
    let cone = vec![[ball_at, corners[0]], [ball_at, corners[1]]];
    let mut layers = vec![
        Layer::segments(cone, Stroke::Solid, Tone::Posterior, 1.0),
        Layer::segments(bed, Stroke::Solid, Tone::Faint, COLUMN_PX),
        Layer::line(seen, Stroke::Solid, Tone::Ink, 2.0),
        Layer::line(frame, Stroke::Solid, Tone::Posterior, 1.0),
    ];
    layers.extend(ball([middle, bottom + LENS_FLOOR * tall]));
    let times = magnified / 100.0;
    layers.push(Layer::Text {
        at: [0.5 * far, ceiling + 0.5 * (1.0 - LENS_TOP) * top],
        text: format!("dent enlarged ×{times:.0}"),
        tone: Tone::Ink,
    });
    layers
}

/// Upright lines from zero to the ground, evenly apart.
fn columns(ground: &[[f64; 2]]) -> Vec<[[f64; 2]; 2]> {
    let length_m = ground[ground.len() - 1][0];
    let mut next = 1;
    (0..=COLUMNS)
        .map(|k| {
            let at = length_m * k as f64 / COLUMNS as f64;
            while next + 1 < ground.len() && ground[next][0] < at {
                next += 1;
            }
            let [from, to] = [ground[next - 1], ground[next]];
            let width = to[0] - from[0];
            let share = if width > 0.0 {
                (at - from[0]) / width
            } else {
                0.0
            };
            [
                [at, 0.0],
                [at, from[1] + share.clamp(0.0, 1.0) * (to[1] - from[1])],
            ]
        })
        .collect()
}
