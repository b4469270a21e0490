//! Boxes as bars over the heading, as high as their bounds.

use ch16_lab::whole_window::SeenBox;
use ch16_slam2d::search::{BoxFate, PoseBox};
use widget_kit::scene::{Aspect, Axis, Layer, LegendEntry, Panel, Stroke, Tone, Weight};

use super::super::texts::{grouped, heading_error_deg};
use super::super::{LookedAt, WholeWindow, panel};

pub fn panel(window: &WholeWindow) -> Panel {
    let search = &window.search_task.window;
    let step = window.step();
    let moment = &search.moments()[step];
    let bar = |seen: &SeenBox| bar(window, seen);
    let waiting = search.boxes().iter().filter(|seen| seen.waits_after(step));
    let dropped = search.boxes().iter().filter(|seen| is_dropped(seen, step));
    let segments =
        |segments: Vec<_>, tone, width_px| Layer::segments(segments, Stroke::Solid, tone, width_px);
    let mut layers = vec![
        segments(dropped.map(bar).collect(), Tone::Ink, 2.0),
        segments(waiting.map(bar).collect(), Tone::Series(0), 2.5),
    ];
    if let Some(looked_at) = &window.looked_at {
        let its_bar = vec![bar(&search.boxes()[looked_at.seen])];
        layers.push(segments(its_bar, Tone::Series(3), 5.0));
        layers.push(Layer::line(
            scores(window, looked_at),
            Stroke::Solid,
            Tone::Series(3),
            2.0,
        ));
    }
    let level = |score: f64, tone| {
        Layer::line(
            vec![[-180.0, score], [180.0, score]],
            Stroke::Dotted,
            tone,
            1.75,
        )
    };
    layers.extend(moment.best.map(|best| level(best.score, Tone::Posterior)));
    layers.extend(
        moment
            .runner_up
            .map(|next| level(next.score, Tone::Series(1))),
    );
    Panel {
        id: panel::BOUNDS,
        title: format!(
            "{} poses, {} scored",
            grouped(moment.counts.window),
            grouped(moment.counts.scored())
        ),
        weight: Weight::Half,
        aspect: Aspect::Free,
        x: Axis::new("heading, from the truth (°)", -180.0, 180.0),
        y: Axis::new("score", 0.0, 1.04),
        layers,
        legend: vec![
            LegendEntry::line("waiting box", Tone::Series(0), Stroke::Solid),
            LegendEntry::line(
                "box inspected, over its true scores",
                Tone::Series(3),
                Stroke::Solid,
            ),
            LegendEntry::line("dropped", Tone::Ink, Stroke::Solid),
            LegendEntry::line("best score so far", Tone::Posterior, Stroke::Dotted),
        ],
        color_bar: None,
    }
}

/// A box as a bar over its headings, at least one step wide.
fn bar(window: &WholeWindow, seen: &SeenBox) -> [[f64; 2]; 2] {
    let search = window.search_task.window.search();
    let step_deg = 360.0 / search.headings().max(1) as f64;
    let [low, high] = seen.poses.heading_rad;
    let middle = heading_error_deg(window, 0.5 * (low + high));
    let half = (0.5 * (high - low).to_degrees()).max(step_deg);
    let bound = seen.poses.bound;
    [[middle - half, bound], [middle + half, bound]]
}

/// The true scores of a box over its headings.
fn scores(window: &WholeWindow, looked_at: &LookedAt) -> Vec<[f64; 2]> {
    let scores = looked_at.scores.iter();
    let mut line: Vec<[f64; 2]> = Vec::with_capacity(looked_at.scores.len());
    for [heading_rad, score] in scores {
        let at = heading_error_deg(window, *heading_rad);
        if line.last().is_some_and(|last| (at - last[0]).abs() > 180.0) {
            line.push([f64::NAN; 2]);
        }
        line.push([at, *score]);
    }
    line
}

/// Whether a box was dropped by that step.
pub fn is_dropped(seen: &SeenBox, step: usize) -> bool {
    let is_past = seen.until.is_some_and(|until| until <= step);
    is_past && seen.fate == Some(BoxFate::Pruned)
}

/// The box at a spot of a panel, waiting or dropped: from above the smallest one, over the headings the bar that is
/// next in height.
pub fn box_at(window: &WholeWindow, panel: &str, at: [f64; 2]) -> Option<usize> {
    let step = window.step();
    let boxes = window.search_task.window.boxes().iter().enumerate();
    let is_in = |[low, high]: [f64; 2], value: f64| (low..=high).contains(&value);
    let distance = |seen: &SeenBox| match panel {
        panel::PLACES => {
            let PoseBox { x_m, y_m, .. } = seen.poses;
            let is_here = is_in(x_m, at[0]) && is_in(y_m, at[1]);
            (is_here && seen.waits_after(step)).then(|| (x_m[1] - x_m[0]) * (y_m[1] - y_m[0]))
        }
        panel::BOUNDS => {
            let [from, to] = bar(window, seen);
            let is_here = is_in([from[0], to[0]], at[0]);
            let is_drawn = seen.waits_after(step) || is_dropped(seen, step);
            (is_here && is_drawn).then(|| (seen.poses.bound - at[1]).abs())
        }
        _ => None,
    };
    let near = boxes.filter_map(|(k, seen)| Some((k, distance(seen)?)));
    near.min_by(|a, b| a.1.total_cmp(&b.1)).map(|(k, _)| k)
}
