//! Boxes as bars over the heading, as high as their bounds; and the convergence of bound and best score.

use ch16_lab::whole_window::SeenBox;
use ch16_slam2d::search::BoxFate;
use kit::scene::{Aspect, Axis, Layer, LegendEntry, Panel, Stroke, Tone, Weight};

use super::super::words::heading_error_deg;
use super::super::{WholeWindow, panel};

/// Largest number of points of the gap's lines.
const GAP_POINTS: usize = 300;

pub fn panel(window: &WholeWindow) -> Panel {
    let search = &window.search_task.window;
    let step = window.step();
    let moment = &search.moments()[step];
    let bar = |seen: &SeenBox| bar(window, seen);
    let waiting = search.boxes().iter().filter(|seen| seen.waits_after(step));
    let dropped = search.boxes().iter().filter(|seen| {
        let is_past = seen.until.is_some_and(|until| until <= step);
        is_past && seen.fate == Some(BoxFate::Pruned)
    });
    let segments =
        |segments: Vec<_>, tone, width_px| Layer::segments(segments, Stroke::Solid, tone, width_px);
    let mut layers = vec![
        segments(dropped.map(bar).collect(), Tone::Ink, 2.0),
        Layer::line(surface(window), Stroke::Solid, Tone::Series(3), 1.5),
        segments(waiting.map(bar).collect(), Tone::Series(0), 2.5),
    ];
    if let Some(taken) = moment.taken {
        let taken = vec![bar(&search.boxes()[taken])];
        layers.push(segments(taken, Tone::Series(2), 5.0));
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
            "{} poses, {} looked at",
            grouped(moment.counts.window),
            grouped(moment.counts.scored())
        ),
        weight: Weight::Half,
        aspect: Aspect::Free,
        x: Axis::new("heading, from the truth (°)", -180.0, 180.0),
        y: Axis::new("score", 0.0, 1.04),
        layers,
        legend: vec![
            LegendEntry::line("box that waits", Tone::Series(0), Stroke::Solid),
            LegendEntry::line("box taken up", Tone::Series(2), Stroke::Solid),
            LegendEntry::line("dropped", Tone::Ink, Stroke::Solid),
            LegendEntry::line("best score so far", Tone::Posterior, Stroke::Dotted),
            LegendEntry::line("best true score", Tone::Series(3), Stroke::Solid),
        ],
        color_bar: None,
    }
}

/// A whole number in groups of three digits: `1,652,124`.
fn grouped(number: u64) -> String {
    let (rest, group) = (number / 1000, number % 1000);
    if rest == 0 {
        return group.to_string();
    }
    format!("{},{group:03}", grouped(rest))
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

/// The best score at each known heading, from the lowest error to the highest.
fn surface(window: &WholeWindow) -> Vec<[f64; 2]> {
    let search = window.search_task.window.search();
    let by_heading = window.search_task.surface.by_heading().iter().enumerate();
    let mut points: Vec<[f64; 2]> = by_heading
        .filter_map(|(k, score)| {
            let error = heading_error_deg(window, search.heading_rad(k));
            Some([error, (*score)?])
        })
        .collect();
    points.sort_by(|a, b| a[0].total_cmp(&b[0]));
    points
}

/// The largest bound falls, the best score rises; the search ends where they meet.
pub fn gap(window: &WholeWindow) -> Panel {
    let moments = window.search_task.window.moments();
    let every = moments.len().div_ceil(GAP_POINTS);
    let last = moments.len() - 1;
    let steps = (0..last).step_by(every).chain([last]);
    let (mut bounds, mut best) = (Vec::new(), Vec::new());
    for step in steps {
        let moment = &moments[step];
        let at = |score: Option<f64>| [step as f64, score.unwrap_or(f64::NAN)];
        bounds.push(at(moment.bound));
        best.push(at(moment.best.map(|best| best.score)));
    }
    let line = |points, tone| Layer::line(points, Stroke::Solid, tone, 1.75);
    let now = window.step() as f64;
    Panel {
        id: panel::GAP,
        title: "The largest bound falls, the best score rises".to_owned(),
        weight: Weight::Side,
        aspect: Aspect::Free,
        x: Axis::new("boxes taken up", 0.0, last.max(1) as f64),
        y: Axis::new("score", 0.0, 1.04),
        layers: vec![
            Layer::line(
                vec![[now, 0.0], [now, 1.04]],
                Stroke::Solid,
                Tone::Faint,
                2.0,
            ),
            line(bounds, Tone::Series(0)),
            line(best, Tone::Posterior),
        ],
        legend: vec![
            LegendEntry::line("largest bound that waits", Tone::Series(0), Stroke::Solid),
            LegendEntry::line("best score so far", Tone::Posterior, Stroke::Solid),
        ],
        color_bar: None,
    }
}
