//! Before and after a closed loop in one map: left of a line the old graph, right of it the new one.

use widget_kit::scene::{Layer, Mark, Stroke, Tone};

use super::bounds::shown_bounds;
use crate::w16_2_full_lap::model::moment::LapState;
use crate::w16_2_full_lap::spec::Layers;
use crate::xy::xy;

/// Distance of a word from the line, as a share of the map's width.
const WORD_SHARE: f64 = 0.09;

/// Distance of the words from the map's upper edge, m.
const EDGE_M: f64 = 0.2;

/// Distance of the handle from it, m: on a low screen the lower half may be out of sight.
const HANDLE_M: f64 = 1.4;

/// Position of the line, if a loop was closed in this tick or a custom one is, m.
pub fn divider(moment: &LapState) -> Option<f64> {
    let bounds = shown_bounds(moment);
    (moment.has_moved() && moment.layers != Layers::Wheels)
        .then(|| bounds.min[0] + moment.wipe * bounds.size()[0])
}

/// Whether a spot is left of the line, on the side of the graph before the loop.
pub fn is_before(line: Option<f64>, at: [f64; 2]) -> bool {
    line.is_some_and(|x| at[0] < x)
}

/// The positions of the nodes on the map: each before the loop if that is left of the line, else after it.
pub fn shown_nodes(moment: &LapState) -> Vec<[f64; 2]> {
    let line = divider(moment);
    let mut shown: Vec<_> = moment.nodes.iter().map(xy).collect();
    for (at, old) in shown.iter_mut().zip(moment.old_nodes.iter().map(xy)) {
        if is_before(line, old) {
            *at = old;
        }
    }
    shown
}

/// The part of each segment on one side of the line.
pub fn clipped(
    line: Option<f64>,
    segments: Vec<[[f64; 2]; 2]>,
    before: bool,
) -> Vec<[[f64; 2]; 2]> {
    let Some(x) = line else {
        return if before { Vec::new() } else { segments };
    };
    let is_in = |at: &[f64; 2]| is_before(line, *at) == before;
    let kept = segments.into_iter().filter_map(|[a, b]| {
        let share = (x - a[0]) / (b[0] - a[0]);
        let cut = [x, a[1] + share * (b[1] - a[1])];
        match (is_in(&a), is_in(&b)) {
            (true, true) => Some([a, b]),
            (true, false) => Some([a, cut]),
            (false, true) => Some([cut, b]),
            (false, false) => None,
        }
    });
    kept.collect()
}

/// The old graph left of the line, the line, its handle and its two words.
pub fn layers(moment: &LapState) -> Vec<Layer> {
    let line = divider(moment);
    let Some(x) = line else {
        return Vec::new();
    };
    let old: Vec<_> = moment.old_nodes.iter().map(xy).collect();
    let chain = old.windows(2).map(|pair| [pair[0], pair[1]]).collect();
    let bounds = shown_bounds(moment);
    let [low, top] = [bounds.min[1], bounds.max[1]];
    let aside = WORD_SHARE * bounds.size()[0];
    let word = |x, text: &str| Layer::Text {
        at: [x, top - EDGE_M],
        text: text.to_owned(),
        tone: Tone::Ink,
    };
    vec![
        Layer::segments(clipped(line, chain, true), Stroke::Solid, Tone::Prior, 1.5),
        Layer::points(
            old.into_iter().filter(|at| is_before(line, *at)).collect(),
            Mark::Circle,
            Tone::Prior,
            3.5,
        ),
        Layer::line(vec![[x, low], [x, top]], Stroke::Solid, Tone::Ink, 2.0),
        word(x - aside, "before"),
        word(x + aside, "after"),
        Layer::Handle {
            at: [x, top - HANDLE_M],
            tone: Tone::Ink,
            label: "drag: before the loop on the left, after it on the right",
        },
    ]
}
