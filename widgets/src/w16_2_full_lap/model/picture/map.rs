//! The map panel: the world, the three estimates, the graph and its map.

use ch16_lab::lap::{BuiltInWorld, RecordedLoopAttempt};
use pr_geom::SE2;
use pr_sim::{Wall, World};
use widget_kit::scene::{Aspect, Axis, Layer, LegendEntry, Mark, Panel, Stroke, Tone, Weight};

use super::bounds::shown_bounds;
use super::loop_style::LoopStyle;
use super::shapes::{arc, loop_mark, xy};
use super::{floor_plan, parts, wipe};
use crate::w16_2_full_lap::model::moment::{Drawn, LapState};
use crate::w16_2_full_lap::model::panel;

/// The world at a tick.
pub fn map(moment: &LapState) -> Panel {
    let bounds = shown_bounds(moment);
    let mut layers = vec![walls(moment)];
    // A lap of another world does not belong into this one.
    if moment.drawn.is_none_or(|drawn| drawn.problem.is_none()) {
        layers.extend(lap(moment));
    }
    if let Some(drawn) = moment.drawn.filter(is_planned) {
        layers.extend(floor_plan::layers(&drawn));
    }
    if moment.runs.place() == Some(BuiltInWorld::Apartment) && moment.drawn.is_none() {
        layers.extend(rooms());
    }
    // The walls give the scale; a pencil needs coordinates.
    let axis = |label, i: usize| match moment.drawn.and_then(|drawn| drawn.tool) {
        Some(_) => Axis::new(label, bounds.min[i], bounds.max[i]),
        None => Axis::hidden(bounds.min[i], bounds.max[i]),
    };
    Panel {
        id: panel::MAP,
        title: title(moment),
        weight: Weight::Main,
        aspect: Aspect::Equal,
        x: axis("x (m)", 0),
        y: axis("y (m)", 1),
        layers,
        legend: legend(moment),
        color_bar: None,
    }
}

/// The estimates and the truth.
fn lap(moment: &LapState) -> Vec<Layer> {
    let mut layers = Vec::from(map_points(moment));
    layers.extend(paths(moment));
    layers.extend(graph(moment));
    layers.extend(robots(moment));
    layers.extend(parts::wrong_place(moment));
    layers.extend(parts::looked_at(moment));
    layers.extend(attempt_now(moment));
    layers.extend(wipe::layers(moment));
    layers
}

/// Whether the plan is shown: during editing, and if there is no lap.
fn is_planned(drawn: &Drawn) -> bool {
    drawn.tool.is_some() || drawn.problem.is_some()
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

fn paths(moment: &LapState) -> [Layer; 3] {
    let until = 0..=moment.tick;
    let path = |pose_at: &dyn Fn(usize) -> SE2, stroke, tone| {
        Layer::line(
            until.clone().map(|tick| xy(&pose_at(tick))).collect(),
            stroke,
            tone,
            1.75,
        )
    };
    [
        path(&|tick| moment.runs.truth(tick), Stroke::Dashed, Tone::Truth),
        path(
            &|tick| moment.runs.dead_reckoning(tick),
            Stroke::Solid,
            Tone::Prediction,
        ),
        path(
            &|tick| moment.runs.front_end.estimate(tick),
            Stroke::Solid,
            Tone::Prior,
        ),
    ]
}

/// Nodes, the factors between neighbours, and the factors of the loops closed so far.
fn graph(moment: &LapState) -> Vec<Layer> {
    let line = wipe::divider(moment);
    let nodes = moment.nodes.iter().map(xy);
    let nodes: Vec<_> = nodes.filter(|at| !wipe::is_before(line, *at)).collect();
    let mut layers = parts::edges(moment);
    layers.extend(moment.loops_tried().flat_map(|attempt| {
        let arc = arc(moment, attempt);
        let top = arc[arc.len() / 2];
        loop_layers(attempt, arc, top)
    }));
    layers.extend(parts::own(moment));
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
fn robots(moment: &LapState) -> Vec<Layer> {
    let tick = moment.tick;
    let others = [
        (moment.runs.truth(tick), Mark::Plus, Tone::Truth, 7.0),
        (
            moment.runs.dead_reckoning(tick),
            Mark::Triangle,
            Tone::Prediction,
            6.0,
        ),
        (
            moment.runs.front_end.estimate(tick),
            Mark::Circle,
            Tone::Prior,
            6.0,
        ),
    ];
    let mut layers: Vec<_> = others
        .iter()
        .map(|(pose, mark, tone, radius_px)| Layer::pose(pose.to_array(), *mark, *tone, *radius_px))
        .collect();
    layers.push(Layer::pose(
        moment.estimate.to_array(),
        Mark::Square,
        Tone::Posterior,
        6.0,
    ));
    // At the start all are at one place.
    if tick > 0 && !moment.drawn.as_ref().is_some_and(is_planned) {
        let names = ["truth", "odometry", "front end alone"];
        layers.extend(
            others
                .iter()
                .zip(names)
                .map(|((pose, ..), name)| Layer::label(xy(pose), name.to_owned(), 8.0)),
        );
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
    if parts::is_any_past_the_gate(moment) {
        let label = "strained: χ² past the gate";
        legend.push(LegendEntry::line(label, parts::STRAINED, Stroke::Solid));
    }
    if moment.loops_tried().any(|attempt| !attempt.accepted()) || moment.own.is_some() {
        legend.push(LoopStyle::REJECTED.entry("loop rejected"));
    }
    legend.extend([
        LegendEntry::marked_line("pose graph", Tone::Posterior, Mark::Square, Stroke::Solid),
        LegendEntry::mark("map, way out", Tone::Outbound, Mark::Dot),
        LegendEntry::mark("map, way back", Tone::Revisit, Mark::Cross),
        LoopStyle::ACCEPTED.entry("loop accepted"),
    ]);
    legend.truncate(MOST_ENTRIES);
    legend
}
