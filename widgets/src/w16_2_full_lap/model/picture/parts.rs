//! The selected part of the graph and the custom loop, on the map.

use ch16_lab::lap::{RecordedEdge, edge_strain};
use widget_kit::scene::{Layer, Mark, Stroke, Tone};

use super::loop_style::LoopStyle;
use super::shapes::{arc, loop_mark};
use super::wipe::{clipped, divider, shown_nodes};
use crate::w16_2_full_lap::model::found::{Found, find};
use crate::w16_2_full_lap::model::moment::{LapState, WrongPlace};
use crate::w16_2_full_lap::model::pick::GraphPart;
use crate::w16_2_full_lap::model::texts::{ends, part_label, wrong_words};
use crate::xy::xy;

/// Distance of text from its mark, in pixels.
const CLEAR_PX: f32 = 12.0;

/// Radius of the ring around a wrong place, in pixels.
const RING_PX: f32 = 18.0;

/// The colour of an edge whose χ² is past the gate.
pub const STRAINED: Tone = Tone::Strained;

/// Looks of edges by their χ²: its upper limit as a share of the gate's, the colour, and the width in pixels.
const LOOKS: [(f64, Tone, f32); 3] = [
    (0.25, Tone::Posterior, 2.0),
    (1.0, Tone::Posterior, 4.0),
    (f64::INFINITY, STRAINED, 6.0),
];

/// The edges between neighbours, each with its look; by χ² against the gate.
fn neighbours<'a>(moment: &'a LapState) -> impl Iterator<Item = (usize, &'a RecordedEdge)> {
    let chain = moment.edges().filter(|edge| edge.to == edge.from + 1);
    chain.map(|edge| {
        let share = edge_strain(edge, &moment.nodes).chi2 / moment.runs.gate_chi2();
        let look = LOOKS.iter().position(|(most, ..)| share <= *most);
        (look.unwrap_or(0), edge)
    })
}

/// Whether an edge between neighbours is strained past the gate.
pub fn is_any_past_the_gate(moment: &LapState) -> bool {
    neighbours(moment).any(|(look, _)| look == LOOKS.len() - 1)
}

/// The edges between neighbours after the loop, wider and in another colour the more they are strained.
pub fn edges(moment: &LapState) -> Vec<Layer> {
    let line = divider(moment);
    let at = |node: usize| xy(&moment.nodes[node]);
    let mut by_look = vec![Vec::new(); LOOKS.len()];
    for (look, edge) in neighbours(moment) {
        by_look[look].push([at(edge.from), at(edge.to)]);
    }
    let layers = by_look.into_iter().zip(LOOKS);
    layers
        .filter(|(segments, _)| !segments.is_empty())
        .map(|(segments, (_, tone, width_px))| {
            let segments = clipped(line, segments, false);
            Layer::segments(segments, Stroke::Solid, tone, width_px)
        })
        .collect()
}

/// The selected part and the one under the pointer: with a ring or wide, and a label.
pub fn looked_at(moment: &LapState) -> Vec<Layer> {
    let mut layers = Vec::new();
    if let Some(node) = moment.tied.filter(|node| *node < moment.nodes.len()) {
        let at = shown_nodes(moment)[node];
        layers.push(Layer::points(
            vec![at],
            Mark::Circle,
            Tone::Measurement,
            10.0,
        ));
        layers.push(Layer::label(at, format!("from {node} to …"), CLEAR_PX));
    }
    let hovered = moment.hovered.filter(|part| moment.picked != Some(*part));
    for (part, is_picked) in [(moment.picked, true), (hovered, false)] {
        if let Some(part) = part {
            layers.extend(part_layers(moment, part, is_picked));
        }
    }
    layers
}

fn part_layers(moment: &LapState, part: GraphPart, is_picked: bool) -> Vec<Layer> {
    let mut layers = Vec::new();
    let line = |points| Layer::line(points, Stroke::Solid, Tone::Ink, 3.0);
    let at = match find(moment, part) {
        Some(Found::Keyframe(node)) => {
            let at = shown_nodes(moment)[node];
            layers.push(if is_picked {
                Layer::Handle {
                    at,
                    tone: Tone::Posterior,
                    label: "drag to another keyframe: your own loop",
                }
            } else {
                Layer::points(vec![at], Mark::Circle, Tone::Ink, 7.0)
            });
            at
        }
        Some(Found::Edge(edge)) => {
            let nodes = shown_nodes(moment);
            let (a, b) = (nodes[edge.from], nodes[edge.to]);
            layers.push(line(vec![a, b]));
            [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])]
        }
        Some(Found::Loop(attempt)) => {
            let arc = arc(moment, attempt);
            let top = arc[arc.len() / 2];
            layers.push(line(arc));
            top
        }
        // It has a label in any case.
        Some(Found::Own) | None => return layers,
    };
    layers.push(Layer::label(at, part_label(moment, part), CLEAR_PX));
    layers
}

/// What a finished lap is off, at its worst keyframe and at its end. A wrong place has a ring, and is all that is named.
pub fn off(moment: &LapState) -> Vec<Layer> {
    let wrong = moment.wrong_place();
    let ringed = |at, words| {
        vec![
            Layer::points(vec![at], Mark::Circle, STRAINED, RING_PX),
            Layer::label(at, words, RING_PX),
        ]
    };
    if let Some(WrongPlace::Loop(attempt)) = &wrong {
        let words = wrong_words(&WrongPlace::Loop(attempt));
        return ringed(loop_mark(moment, attempt), words);
    }
    let Some((worst, worst_m)) = moment.farthest() else {
        return Vec::new();
    };
    let gap = |node: usize| {
        let truth = moment.runs.truth(moment.runs.graph.keyframe_tick(node));
        let ends = vec![xy(&moment.nodes[node]), xy(&truth)];
        Layer::line(ends, Stroke::Dashed, STRAINED, 2.0)
    };
    let at = |node: usize| xy(&moment.nodes[node]);
    let mut layers = vec![gap(worst)];
    if let Some(wrong) = &wrong {
        layers.extend(ringed(at(worst), wrong_words(wrong)));
        return layers;
    }
    let label = |node, words: &str, off_m: f64| {
        Layer::label(at(node), format!("{words}: {off_m:.2} m off"), RING_PX)
    };
    layers.push(label(worst, "worst", worst_m));
    let end = moment.nodes.len() - 1;
    if end != worst {
        let end_m = moment.runs.graph.summary().keyframe_end_error_m;
        layers.extend([gap(end), label(end, "end", end_m)]);
    }
    layers
}

/// The custom loop: like those of the lap, and wider.
pub fn own(moment: &LapState) -> Vec<Layer> {
    let Some(own) = moment.own else {
        return Vec::new();
    };
    let look = LoopStyle::from_attempt(&own.attempt);
    let arc = arc(moment, &own.attempt);
    let top = arc[arc.len() / 2];
    let name = format!("your loop {}", ends(&own.attempt));
    vec![
        Layer::line(arc, look.stroke, look.tone, 4.0),
        Layer::points(vec![top], look.mark, look.tone, 6.0),
        Layer::label(top, name, CLEAR_PX),
    ]
}
