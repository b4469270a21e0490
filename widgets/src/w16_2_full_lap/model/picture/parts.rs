//! The selected part of the graph and the custom loop, on the map.

use ch16_lab::lap::{OwnLoop, RecordedEdge, edge_strain};
use kit::scene::{Layer, Mark, Stroke, Tone};
use pr_geom::math;

use super::loop_style::LoopStyle;
use super::shapes::{arc, xy};
use crate::w16_2_full_lap::model::found::{Found, find};
use crate::w16_2_full_lap::model::moment::Moment;
use crate::w16_2_full_lap::model::pick::Part;
use crate::w16_2_full_lap::model::words::{ends, part_label};

/// Distance of text from its mark, in pixels.
const CLEAR_PX: f32 = 12.0;

/// Line widths of edges by their strain √χ²: the upper limit in standard deviations, and the width in pixels.
const WIDTHS: [(f64, f32); 4] = [(1.0, 1.0), (2.0, 3.0), (4.0, 5.0), (f64::INFINITY, 7.5)];

/// The edges between neighbours; wide if a custom loop strains them.
pub fn edges(moment: &Moment) -> Vec<Layer> {
    let strained = moment.own.is_some_and(OwnLoop::is_closed);
    let nodes: Vec<_> = moment.nodes.iter().map(xy).collect();
    let ends = |edge: &RecordedEdge| [nodes[edge.from], nodes[edge.to]];
    let neighbours = || moment.edges().filter(|edge| edge.to == edge.from + 1);
    let mut widths = vec![Vec::new(); WIDTHS.len()];
    for edge in neighbours() {
        let sigmas = math::sqrt(edge_strain(edge, &moment.nodes).chi2);
        let class = WIDTHS.iter().position(|(most, _)| sigmas <= *most);
        let class = class.filter(|_| strained).unwrap_or(0);
        widths[class].push(ends(edge));
    }
    let layers = widths.into_iter().zip(WIDTHS);
    layers
        .filter(|(segments, _)| !segments.is_empty())
        .map(|(segments, (_, width_px))| {
            Layer::segments(segments, Stroke::Solid, Tone::Posterior, width_px)
        })
        .collect()
}

/// The selected part and the one under the pointer: with a ring or wide, and a label.
pub fn looked_at(moment: &Moment) -> Vec<Layer> {
    let mut layers = Vec::new();
    if let Some(node) = moment.tied.filter(|node| *node < moment.nodes.len()) {
        let at = xy(&moment.nodes[node]);
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

fn part_layers(moment: &Moment, part: Part, is_picked: bool) -> Vec<Layer> {
    let mut layers = Vec::new();
    let line = |points| Layer::line(points, Stroke::Solid, Tone::Ink, 3.0);
    let at = match find(moment, part) {
        Some(Found::Keyframe(node)) => {
            let at = xy(&moment.nodes[node]);
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
            let (a, b) = (xy(&moment.nodes[edge.from]), xy(&moment.nodes[edge.to]));
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

/// The custom loop: like those of the lap, and wider.
pub fn own(moment: &Moment) -> Vec<Layer> {
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
