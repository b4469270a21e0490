//! The pointer on the graph: hit tests, taps, and loops created by dragging.

use ch16_lab::lap::edge_strain;
use pr_geom::math;
use widget_kit::model::Handle;

use super::found::find;
use super::moment::LapState;
use super::panel;
use super::pick::GraphPart;
use super::picture;
use crate::w16_2_full_lap::spec::Layers;

/// Radius within which the map reacts to a hovering pointer, m.
const HOVER_M: f64 = 0.3;

/// The same radius in a plot, as a share of its axes.
const HOVER_SHARE: f64 = 0.03;

/// A drag joins no keyframes that are at most so many apart: odometry ties them already.
const NEIGHBOURS: usize = 3;

/// The handle of a keyframe: dragging it creates a loop.
const KEYFRAME: &str = "keyframe";

/// The handle of the line between before and after.
const WIPE: &str = "wipe";

/// The part of the graph nearest to a point of a panel, within `reach` along each axis.
pub fn part_at(moment: &LapState, name: &str, at: [f64; 2], reach: [f64; 2]) -> Option<GraphPart> {
    let places = places(moment, name);
    let away = |place: &[f64; 2]| {
        math::norm2((place[0] - at[0]) / reach[0], (place[1] - at[1]) / reach[1])
    };
    let near = places
        .into_iter()
        .map(|(part, place)| (part, away(&place)))
        .filter(|(_, away)| *away <= 1.0)
        .min_by(|a, b| a.1.total_cmp(&b.1));
    near.map(|(part, _)| part)
}

/// The part under a hovering pointer.
pub fn hovered(moment: &LapState, name: &str, at: [f64; 2]) -> Option<GraphPart> {
    let reach = match name {
        panel::MAP => [HOVER_M; 2],
        _ => {
            let scene = picture::scene(moment);
            let shown = scene.panels.iter().find(|shown| shown.id == name)?;
            [&shown.x, &shown.y].map(|axis| HOVER_SHARE * (axis.max - axis.min))
        }
    };
    part_at(moment, name, at, reach)
}

/// The position of each part in a panel: of an edge at its middle, of a loop at its mark.
fn places(moment: &LapState, name: &str) -> Vec<(GraphPart, [f64; 2])> {
    let nodes = &moment.nodes;
    match name {
        // What is not shown cannot be pressed.
        panel::MAP if matches!(moment.layers, Layers::Wheels | Layers::Map) => Vec::new(),
        panel::MAP => {
            let shown = picture::shown_nodes(moment);
            let at = |node: usize| shown[node];
            let keyframes = (0..nodes.len()).map(|node| (GraphPart::Keyframe(node), at(node)));
            let mut places: Vec<_> = keyframes.collect();
            places.extend((1..nodes.len()).map(|to| {
                let (a, b) = (at(to - 1), at(to));
                let middle = [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])];
                (GraphPart::Edge(to - 1), middle)
            }));
            places.extend(moment.loops_tried().map(|attempt| {
                let part = GraphPart::Loop(attempt.verification.from_node);
                (part, picture::loop_mark(moment, attempt))
            }));
            if let Some(own) = moment.own {
                places.push((GraphPart::Own, picture::loop_mark(moment, &own.attempt)));
            }
            places
        }
        panel::STRAIN => moment
            .edges_with_own()
            .map(|edge| {
                let strain = edge_strain(edge, nodes);
                (
                    picture::part_of(moment, edge),
                    picture::strain_mark(&strain),
                )
            })
            .collect(),
        panel::GATE => {
            let tried = moment.loops_tried();
            tried
                .map(|attempt| {
                    let part = GraphPart::Loop(attempt.verification.from_node);
                    (part, picture::gate_mark(moment, attempt))
                })
                .collect()
        }
        _ => Vec::new(),
    }
}

/// Grabs the selected keyframe, the line between before and after, or another keyframe.
pub fn grab(moment: &LapState, name: &str, at: [f64; 2], reach: [f64; 2]) -> Option<Handle> {
    if name != panel::MAP {
        return None;
    }
    let selected = moment.picked.filter(|part| find(moment, *part).is_some());
    let line = || {
        let off = at[0] - picture::divider(moment)?;
        (off.abs() <= reach[0]).then_some(Handle {
            panel: panel::MAP,
            id: WIPE,
            offset: [off, 0.0],
            ..Handle::default()
        })
    };
    let any = || part_at(moment, name, at, reach);
    keyframe(moment, selected, at, reach)
        .or_else(line)
        .or_else(|| keyframe(moment, any(), at, reach))
}

/// Where a drag puts the line between before and after, as a share of the map's width.
pub fn dragged_wipe(moment: &LapState, handle: Handle, at: [f64; 2]) -> Option<f64> {
    let bounds = picture::map_bounds(moment);
    let share = (at[0] - handle.offset[0] - bounds.min[0]) / bounds.size()[0];
    let is_held = handle.panel == panel::MAP && handle.id == WIPE && share.is_finite();
    is_held.then(|| (100.0 * share.clamp(0.0, 1.0)).round() / 100.0)
}

/// The handle of a part within reach, if it is a keyframe.
fn keyframe(
    moment: &LapState,
    part: Option<GraphPart>,
    at: [f64; 2],
    reach: [f64; 2],
) -> Option<Handle> {
    let Some(GraphPart::Keyframe(node)) = part else {
        return None;
    };
    let [x, y] = picture::shown_nodes(moment)[node];
    let off = [at[0] - x, at[1] - y];
    let is_near = off[0].abs() <= reach[0] && off[1].abs() <= reach[1];
    is_near.then_some(Handle {
        panel: panel::MAP,
        id: KEYFRAME,
        index: node,
        reach: reach[0],
        ..Handle::default()
    })
}

/// The two ends of a dragged loop; `None` before it reaches another keyframe.
pub fn dragged_ends(moment: &LapState, handle: Handle, at: [f64; 2]) -> Option<[usize; 2]> {
    if handle.id != KEYFRAME {
        return None;
    }
    let Handle {
        index: from, reach, ..
    } = handle;
    let shown = picture::shown_nodes(moment);
    let away = |node: usize| {
        let [x, y] = shown[node];
        math::norm2(x - at[0], y - at[1])
    };
    let near = (0..moment.nodes.len())
        .map(|node| (node, away(node)))
        .filter(|(_, away)| *away <= reach)
        .min_by(|a, b| a.1.total_cmp(&b.1));
    let (to, _) = near?;
    // A press with little movement is not a drag, and one between neighbours is a slip.
    let has_left = from < moment.nodes.len() && away(from) > 0.5 * reach;
    (to.abs_diff(from) > NEIGHBOURS && has_left).then_some([from, to])
}
