//! The strain of every edge of the graph: which edges give way, and by how much.

use ch16_lab::lap::{EdgeStrain, RecordedEdge, edge_strain};
use ch16_slam2d::graph::EdgeKind;
use pr_geom::math;
use widget_kit::chart::axis_from_zero;
use widget_kit::scene::{Aspect, Axis, Layer, LegendEntry, Mark, Panel, Stroke, Tone, Weight};

use super::loop_style::LoopStyle;
use crate::w16_2_full_lap::model::moment::LapState;
use crate::w16_2_full_lap::model::panel;
use crate::w16_2_full_lap::model::pick::GraphPart;

/// Smallest upper end of the axis: a Gaussian residual seldom exceeds it.
const MIN_TOP: f64 = 3.0;

/// Margin beyond the first and the last keyframe.
const ROOM_NODES: f64 = 0.8;

/// The part of the graph that an edge is.
pub fn part_of(moment: &LapState, edge: &RecordedEdge) -> GraphPart {
    let is_own = moment.own.is_some_and(|own| own.edge == *edge);
    match edge.kind {
        EdgeKind::Odometry => GraphPart::Edge(edge.from),
        EdgeKind::Loop if is_own => GraphPart::Own,
        EdgeKind::Loop => GraphPart::Loop(edge.to),
    }
}

/// Position of an edge in the plot: above its newer keyframe, at √χ².
pub fn strain_mark(strain: &EdgeStrain) -> [f64; 2] {
    [strain.to as f64, math::sqrt(strain.chi2)]
}

/// The strain of each edge, as standard deviations of its measurement.
pub fn strain(moment: &LapState) -> Panel {
    let of = |poses| move |edge: &RecordedEdge| (edge.kind, strain_mark(&edge_strain(edge, poses)));
    let now: Vec<_> = moment.edges_with_own().map(of(&moment.nodes)).collect();
    let before: Vec<_> = if moment.own.is_some_and(|own| own.is_closed()) {
        moment.edges().map(of(&moment.old_nodes)).collect()
    } else {
        Vec::new()
    };
    let highest = now.iter().chain(&before).map(|(_, at)| at[1]);
    let y = axis_from_zero("√χ² (σ)", highest.fold(MIN_TOP, math::max));
    let marks = |all: &[(EdgeKind, [f64; 2])], kind: EdgeKind| -> Vec<[f64; 2]> {
        let chosen = all.iter().filter(|(of, _)| *of == kind);
        chosen.map(|(_, at)| *at).collect()
    };
    let stems = |points: &[[f64; 2]]| points.iter().map(|at| [[at[0], 0.0], *at]).collect();
    let odometry = marks(&now, EdgeKind::Odometry);
    let loops = marks(&now, EdgeKind::Loop);
    let look = &LoopStyle::ACCEPTED;
    let mut layers = vec![
        Layer::segments(stems(&odometry), Stroke::Solid, Tone::Posterior, 1.5),
        Layer::points(odometry, Mark::Square, Tone::Posterior, 2.5),
        Layer::segments(stems(&loops), look.stroke, look.tone, 1.5),
        Layer::points(loops, look.mark, look.tone, 4.5),
    ];
    let mut legend = vec![
        LegendEntry::mark(
            "edge to the previous keyframe",
            Tone::Posterior,
            Mark::Square,
        ),
        LegendEntry::mark("loop", look.tone, look.mark),
    ];
    if !before.is_empty() {
        let all = before.into_iter().map(|(_, at)| at).collect();
        layers.push(Layer::points(all, Mark::Circle, Tone::Prior, 2.5));
        legend.push(LegendEntry::mark(
            "before your loop",
            Tone::Prior,
            Mark::Circle,
        ));
    }
    for part in [moment.picked, moment.hovered].into_iter().flatten() {
        let found = moment
            .edges_with_own()
            .find(|edge| part_of(moment, edge) == part);
        if let Some(edge) = found {
            let at = strain_mark(&edge_strain(edge, &moment.nodes));
            layers.push(Layer::points(vec![at], Mark::Circle, Tone::Ink, 7.0));
            let text = format!("{} to {}", edge.to, edge.from);
            layers.push(Layer::label(at, text, 10.0));
        }
    }
    let newest = moment.nodes.len() - 1;
    Panel {
        id: panel::STRAIN,
        title: "Strain of each edge".to_owned(),
        weight: Weight::Side,
        aspect: Aspect::Free,
        x: Axis::new(
            "newer keyframe",
            -ROOM_NODES,
            newest.max(1) as f64 + ROOM_NODES,
        ),
        y,
        layers,
        legend,
        color_bar: None,
    }
}
