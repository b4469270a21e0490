//! The distances of all pairs as stacks of dots, and the threshold. Once the reader has acted, the same places are above
//! and all others below.

use pr_geom::order_by;
use widget_kit::scene::{Aspect, Axis, Layer, Mark, Panel, Stroke, Tone, Weight};

use super::super::settings::distance_label;
use super::super::{PlaceRecognition, panel};
use super::{NOW, OTHER, SAME, empty};

/// Number of stacks.
const STACKS: usize = 48;
/// Height of the plot that the dots share, in pixels, and the limits of their radius.
const HEIGHT_PX: f64 = 120.0;
const RADIUS_PX: [f64; 2] = [0.8, 3.2];
/// Height of the upper half over that of its dots.
const NAME_ROOM: f64 = 1.6;

/// One pair.
pub struct Dot {
    /// Its keyframes.
    pub nodes: [usize; 2],
    /// Its position in the plot.
    pub at: [f64; 2],
    is_same: bool,
    is_called: bool,
}

/// The graded pairs of the lap so far.
pub fn dots(been: &PlaceRecognition) -> Vec<Dot> {
    let Some(places) = &been.places else {
        return Vec::new();
    };
    let (detector, known) = (been.detector(), been.known());
    let threshold = been.threshold(detector);
    let width = stack_width(places.largest(detector));
    let mut heights = [[0.0; STACKS]; 2];
    let pairs: Vec<_> = places
        .study
        .graded()
        .filter(|pair| pair.nodes[1] <= known)
        .collect();
    let nearest_first = order_by(pairs.len(), &|at| pairs[at].distances[detector]);
    let mut dot = |pair: &ch16_lab::places::PlacePair| {
        let distance = pair.distances[detector];
        let stack = ((distance / width) as usize).min(STACKS - 1);
        let is_above = been.asks || pair.is_same;
        let height: &mut f64 = &mut heights[usize::from(is_above)][stack];
        *height += 1.0;
        let up = if is_above { 1.0 } else { -1.0 };
        Dot {
            nodes: pair.nodes,
            at: [(stack as f64 + 0.5) * width, up * *height],
            is_same: pair.is_same,
            is_called: distance <= threshold,
        }
    };
    nearest_first.into_iter().map(|at| dot(pairs[at])).collect()
}

fn stack_width(largest: f64) -> f64 {
    largest.max(f64::MIN_POSITIVE) / STACKS as f64
}

pub fn panel(been: &PlaceRecognition) -> Panel {
    let mut panel = Panel {
        weight: Weight::Half,
        aspect: Aspect::Free,
        x: Axis::new(distance_label(been.detector()), 0.0, 1.0),
        y: Axis::hidden(-1.0, 1.0),
        ..empty(
            panel::SCORES,
            if been.asks {
                "Each dot pairs two views: of the same place?"
            } else {
                "Left of the line: called the same place"
            },
        )
    };
    let Some(places) = &been.places else {
        return panel;
    };
    let detector = been.detector();
    let (largest, threshold) = (places.largest(detector), been.threshold(detector).max(0.0));
    let dots = dots(been);
    let reach = |up: f64| dots.iter().map(|dot| up * dot.at[1]).fold(4.0, f64::max) + 1.5;
    // The name of the upper half stands above its dots.
    let (low, high) = (-reach(-1.0), NAME_ROOM * reach(1.0));
    panel.x = Axis::new(distance_label(detector), 0.0, 1.02 * largest);
    panel.y = Axis::hidden(low, high);
    let radius_px = (0.45 * HEIGHT_PX / (high - low)).clamp(RADIUS_PX[0], RADIUS_PX[1]) as f32;
    for is_same in [true, false] {
        let tone = match is_same {
            _ if been.asks => Tone::Ink,
            true => SAME,
            false => OTHER,
        };
        for is_called in [false, true] {
            let mark = if is_called { Mark::Dot } else { Mark::Circle };
            let here = dots
                .iter()
                .filter(|dot| (dot.is_same, dot.is_called) == (is_same, is_called));
            panel.layers.push(Layer::points(
                here.map(|dot| dot.at).collect(),
                mark,
                tone,
                radius_px,
            ));
        }
    }
    let pair = been.pair();
    let chosen = dots.iter().find(|dot| Some(dot.nodes) == pair);
    panel.layers.extend([
        Layer::segments(
            vec![[[0.0, 0.0], [1.02 * largest, 0.0]]],
            Stroke::Solid,
            Tone::Faint,
            1.5,
        ),
        Layer::points(
            chosen.map(|dot| dot.at).into_iter().collect(),
            Mark::Circle,
            NOW,
            6.0,
        ),
        Layer::segments(
            vec![[[threshold, low], [threshold, high]]],
            Stroke::Solid,
            Tone::Ink,
            2.5,
        ),
        Layer::Handle {
            at: [threshold, 0.0],
            tone: Tone::Ink,
            label: "drag the threshold",
        },
    ]);
    if !been.asks {
        for (name, end) in [("the same place", high), ("different places", low)] {
            let at = [0.93 * largest, 0.85 * end];
            panel.layers.push(Layer::label(at, name.to_owned(), 0.0));
        }
    }
    panel
}
