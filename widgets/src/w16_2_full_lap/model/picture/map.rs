//! The map panel: the world, the three estimates, the graph and its map.

use ch16_lab::lap::{BuiltInWorld, RecordedLoopAttempt};
use pr_geom::SE2;
use pr_sim::{Wall, World};
use widget_kit::scene::{Aspect, Axis, Layer, LegendEntry, Mark, Panel, Stroke, Tone, Weight};

use super::bounds::shown_bounds;
use super::loop_style::LoopStyle;
use super::shapes::{arc, loop_mark};
use super::{floor_plan, parts, wipe};
use crate::w16_2_full_lap::model::moment::{Drawn, LapState};
use crate::w16_2_full_lap::model::panel;
use crate::w16_2_full_lap::model::runs::Runs;
use crate::w16_2_full_lap::spec::Layers;
use crate::xy::xy;

/// The world at a tick.
pub fn map(moment: &LapState) -> Panel {
    let bounds = shown_bounds(moment);
    let mut layers = vec![walls(moment)];
    if has_lap(moment) {
        layers.extend(lap(moment));
    }
    if let Some(drawn) = moment.drawn.filter(is_planned) {
        layers.extend(floor_plan::layers(&drawn));
    }
    if moment.runs.place() == Some(BuiltInWorld::Apartment) && moment.drawn.is_none() {
        layers.extend(rooms());
    }
    let axis = |i: usize| Axis::hidden(bounds.min[i], bounds.max[i]);
    Panel {
        id: panel::MAP,
        title: title(moment),
        weight: Weight::Main,
        aspect: Aspect::Equal,
        x: axis(0),
        y: axis(1),
        layers,
        legend: legend(moment),
        color_bar: None,
    }
}

/// The estimates and the truth, as far as the reader wants to see them.
fn lap(moment: &LapState) -> Vec<Layer> {
    let mut layers = Vec::new();
    let has_map = moment.layers != Layers::Wheels;
    let has_loops = has_map && moment.layers != Layers::Map;
    if has_map {
        layers.extend(map_points(moment));
    }
    let others = others(moment);
    layers.extend(others.iter().map(|other| path(moment, other)));
    if has_map {
        layers.extend(graph(moment, has_loops));
    }
    layers.extend(robots(moment, others));
    if has_loops {
        layers.extend(parts::off(moment));
        layers.extend(parts::looked_at(moment));
        layers.extend(attempt_now(moment));
    }
    layers.extend(wipe::layers(moment));
    layers
}

/// Whether the plan is shown: during editing, and if there is no lap.
fn is_planned(drawn: &Drawn) -> bool {
    drawn.tool.is_some() || drawn.problem.is_some()
}

/// Whether the lap is shown: not that of another world, nor over a plan before it begins.
fn has_lap(moment: &LapState) -> bool {
    moment
        .drawn
        .is_none_or(|drawn| drawn.problem.is_none() && (moment.tick > 0 || !is_planned(&drawn)))
}

/// `The Apartment after tick 92`.
fn title(moment: &LapState) -> String {
    if let Some(drawn) = moment.drawn.filter(is_planned) {
        return floor_plan::title(&drawn);
    }
    let mut words = match moment.runs.driver {
        Some(yours) => format!("your {yours}"),
        None => moment.runs.place_label().to_owned(),
    };
    words[..1].make_ascii_uppercase();
    let words = format!("{words} after tick {}", moment.tick);
    let own = moment.own.map(|own| own.attempt.effect);
    let moved = own
        .or(moment.attempt.map(|attempt| attempt.effect))
        .flatten();
    // One line on a phone, so that nothing moves as a loop is closed.
    match moved {
        Some(moved) => format!("{words}: moved by {:.2} m", moved.max_shift_m),
        None => words,
    }
}

/// The walls of the drawing, even before the lap has followed.
fn walls(moment: &LapState) -> Layer {
    let ends = |wall: &Wall| [[wall.start.x, wall.start.y], [wall.end.x, wall.end.y]];
    Layer::Walls(match &moment.drawn {
        Some(drawn) => floor_plan::walls(drawn),
        None => moment.runs.world().walls().iter().map(ends).collect(),
    })
}

/// Names in the middle of each room, where no sweep has points.
fn rooms() -> impl Iterator<Item = Layer> {
    World::apartment_rooms().into_iter().map(|room| {
        let middle = [
            0.5 * (room.bounds.min.x + room.bounds.max.x),
            0.5 * (room.bounds.min.y + room.bounds.max.y),
        ];
        Layer::label(middle, room.name.to_owned(), 0.0)
    })
}

/// The sweeps of the keyframes at the graph's poses: dots from the outward path, × in the other green from
/// the return path, which makes a doubled wall visible.
fn map_points(moment: &LapState) -> [Layer; 2] {
    let turn = moment.runs.graph.turn_node();
    let mut out = Vec::new();
    let mut back = Vec::new();
    let line = wipe::divider(moment);
    let old = line.map(|_| (&moment.old_nodes, true));
    for (poses, before) in old.into_iter().chain([(&moment.nodes, false)]) {
        for (node, pose) in poses.iter().enumerate() {
            let pass = if turn.is_some_and(|turn| node > turn) {
                &mut back
            } else {
                &mut out
            };
            let sweep = moment.runs.sweep_at(node, *pose);
            pass.extend(sweep.filter(|at| wipe::is_before(line, *at) == before));
        }
    }
    [
        Layer::points(out, Mark::Dot, Tone::Outbound, 1.2),
        Layer::points(back, Mark::Cross, Tone::Revisit, 2.2),
    ]
}

/// Where something other than the graph puts the robot.
struct Other {
    name: &'static str,
    pose_at: fn(&Runs, usize) -> SE2,
    stroke: Stroke,
    mark: Mark,
    tone: Tone,
    radius_px: f32,
}

const TRUTH: Other = Other {
    name: "truth",
    pose_at: Runs::truth,
    stroke: Stroke::Dashed,
    mark: Mark::Plus,
    tone: Tone::Truth,
    radius_px: 7.0,
};
const ODOMETRY: Other = Other {
    name: "odometry",
    pose_at: Runs::dead_reckoning,
    stroke: Stroke::Solid,
    mark: Mark::Triangle,
    tone: Tone::Prediction,
    radius_px: 6.0,
};
const FRONT_END: Other = Other {
    name: "front end alone",
    pose_at: |runs, tick| runs.front_end.estimate(tick),
    stroke: Stroke::Solid,
    mark: Mark::Circle,
    tone: Tone::Prior,
    radius_px: 6.0,
};

/// What is shown beside the graph.
fn others(moment: &LapState) -> &'static [Other] {
    match moment.layers {
        Layers::Wheels => &[TRUTH, ODOMETRY],
        Layers::Map | Layers::Loops => &[],
        Layers::Truth => &[TRUTH],
        Layers::All => &[TRUTH, ODOMETRY, FRONT_END],
    }
}

fn path(moment: &LapState, other: &Other) -> Layer {
    let at = (0..=moment.tick).map(|tick| xy(&(other.pose_at)(moment.runs, tick)));
    Layer::line(at.collect(), other.stroke, other.tone, 1.75)
}

/// Nodes, the factors between neighbours, and the factors of the loops closed so far.
fn graph(moment: &LapState, has_loops: bool) -> Vec<Layer> {
    let line = wipe::divider(moment);
    let nodes = moment.nodes.iter().map(xy);
    let nodes: Vec<_> = nodes.filter(|at| !wipe::is_before(line, *at)).collect();
    let mut layers = parts::edges(moment);
    if has_loops {
        layers.extend(moment.loops_tried().flat_map(|attempt| {
            let arc = arc(moment, attempt);
            let top = arc[arc.len() / 2];
            loop_layers(attempt, arc, top)
        }));
        layers.extend(parts::own(moment));
    }
    layers.push(Layer::points(nodes, Mark::Square, Tone::Posterior, 3.0));
    layers
}

/// An accepted loop is solid and green, a rejected one dotted, grey and hollow.
fn loop_layers(attempt: &RecordedLoopAttempt, arc: Vec<[f64; 2]>, top: [f64; 2]) -> [Layer; 2] {
    let look = LoopStyle::from_attempt(attempt);
    [
        Layer::line(arc, look.stroke, look.tone, 2.5),
        Layer::points(vec![top], look.mark, look.tone, 4.5),
    ]
}

/// The label of the loop tried in this tick.
fn attempt_now(moment: &LapState) -> Vec<Layer> {
    let Some(attempt) = moment.attempt else {
        return Vec::new();
    };
    let headline = moment.runs.graph.lap().loop_headline(attempt);
    vec![Layer::label(loop_mark(moment, attempt), headline, 8.0)]
}

/// The robot's current pose by each estimate, named where the legend does not.
fn robots(moment: &LapState, others: &[Other]) -> Vec<Layer> {
    let pose = |other: &Other| (other.pose_at)(moment.runs, moment.tick);
    let robot = |pose: SE2, mark, tone, px| Layer::pose(pose.to_array(), mark, tone, px);
    let mut layers: Vec<_> = others
        .iter()
        .map(|other| robot(pose(other), other.mark, other.tone, other.radius_px))
        .collect();
    if moment.layers != Layers::Wheels {
        layers.push(robot(moment.estimate, Mark::Square, Tone::Posterior, 6.0));
    }
    // At the start all are at one place.
    if moment.tick > 0 && !moment.drawn.as_ref().is_some_and(is_planned) {
        let name = |other: &Other| Layer::label(xy(&pose(other)), other.name.to_owned(), 8.0);
        layers.extend(others.iter().map(name));
    }
    layers
}

/// Most entries of a legend.
const MOST_ENTRIES: usize = 4;

fn legend(moment: &LapState) -> Vec<LegendEntry> {
    let mut legend = Vec::new();
    if moment.drawn.as_ref().is_some_and(is_planned) {
        legend.push(floor_plan::legend());
    }
    // The robots have their names beside them.
    if moment.layers == Layers::Wheels || !has_lap(moment) {
        return legend;
    }
    let has_loops = moment.layers != Layers::Map;
    if parts::is_any_past_the_gate(moment) {
        let label = "strained: χ² past the gate";
        legend.push(LegendEntry::line(label, parts::STRAINED, Stroke::Solid));
    }
    let is_any_rejected = moment.loops_tried().any(|attempt| !attempt.accepted());
    if has_loops && (is_any_rejected || moment.own.is_some()) {
        legend.push(LoopStyle::REJECTED.entry("loop rejected"));
    }
    legend.extend([
        LegendEntry::marked_line("pose graph", Tone::Posterior, Mark::Square, Stroke::Solid),
        LegendEntry::mark("map, outbound", Tone::Outbound, Mark::Dot),
        LegendEntry::mark("map, return", Tone::Revisit, Mark::Cross),
    ]);
    if has_loops {
        legend.push(LoopStyle::ACCEPTED.entry("loop accepted"));
    }
    legend.truncate(MOST_ENTRIES);
    legend
}
