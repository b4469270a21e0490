//! The panels: the map with path and loops, and the plots over the keyframes.

mod charts;
mod invitation;
mod visitor;
mod wheels;

use log_messages::Stage;
use pr_geom::{SE2, math, sort_numbers};
use widget_kit::scene::{
    Aspect, Axis, Bounds, ColorBar, Layer, LegendEntry, Mark, Panel, Scene, Stroke, Tone, Weight,
};

use super::log_state::LogState;
use super::wheels::poses as wheel_poses;
use super::{OwnRobot, panel};
use crate::w16_10_own_robot::spec::{COLOUR, Colour, LOOPS, MARKED, ShownLoops};
use crate::xy::xy;
use charts::{fit, sure};
use visitor::{OTHER, other_log};
use wheels::wheels;

/// The view before there is a map, m.
const EMPTY: Bounds = Bounds {
    min: [0.0, 0.0],
    max: [15.0, 10.0],
};
/// Aspect ratio of the map, which is fixed to avoid moving what is below.
const RATIO: f64 = 1.5;
/// Margin around the observed area, m.
const MARGIN_M: f64 = 0.5;
/// Number of colours along the path.
const SHADES: usize = 24;
/// Quantile at which values are clamped: a single outlier would hide the others.
const SCALE_QUANTILE: f64 = 0.98;

/// The whole picture.
pub fn scene(robot: &OwnRobot) -> Scene {
    Scene {
        panels: vec![map(robot), fit(robot), sure(robot)],
    }
}

fn map(own: &OwnRobot) -> Panel {
    let robot = &own.robot;
    let by_wheels = wheel_poses(robot);
    let bounds = match robot.progress.stage {
        Stage::Empty => invitation::BOUNDS,
        _ => bounds(robot, &by_wheels),
    };
    let axis = |i: usize| Axis::hidden(bounds.min[i], bounds.max[i]);
    let mut layers: Vec<Layer> = robot.map.iter().cloned().map(Layer::Raster).collect();
    let mut color_bar = None;
    if robot.keyframes.is_empty() {
        layers.extend(without_map(own));
    } else {
        // No walls, but a plan with its scale.
        layers.push(Layer::Walls(Vec::new()));
        layers.extend(links(own));
        let (shades, bar) = way(own);
        layers.extend(shades);
        layers.extend(wheels(own, &by_wheels, &bounds));
        color_bar = bar;
        layers.extend(here(own));
        layers.extend(other_log(own));
    }
    Panel {
        id: panel::MAP,
        title: match robot.progress.stage {
            Stage::Empty => "Your robot’s log becomes a map".to_owned(),
            _ => format!("Map of {}", short(&robot.name)),
        },
        weight: Weight::Main,
        aspect: Aspect::Equal,
        x: axis(0),
        y: axis(1),
        layers,
        legend: legend(own, by_wheels.iter().any(Option::is_some)),
        color_bar,
    }
}

/// Shortens a name for a narrow picture.
fn short(name: &str) -> String {
    if name.chars().count() <= 28 {
        return name.to_owned();
    }
    let start: String = name.chars().take(27).collect();
    format!("{start}…")
}

fn legend(own: &OwnRobot, has_wheels: bool) -> Vec<LegendEntry> {
    let mut legend = Vec::new();
    if own.robot.keyframes.is_empty() {
        return legend;
    }
    legend.push(if has_wheels {
        LegendEntry::line("wheels alone", Tone::Prediction, Stroke::Dashed)
    } else {
        LegendEntry::mark("keyframe shown", Tone::Posterior, Mark::Square)
    });
    if own.robot.has_scans {
        legend.push(LegendEntry::mark(
            "its scan",
            Tone::Measurement,
            Mark::Cross,
        ));
    }
    if own
        .robot
        .scan
        .as_ref()
        .is_some_and(|scan| !scan.sweep.is_empty())
    {
        let measured = LegendEntry::mark("before deskewing", Tone::Strained, Mark::Dot);
        legend.push(measured);
    }
    let shown = own.values.get(&LOOPS);
    if own.robot.links.iter().any(|link| shown.include(link)) {
        legend.push(LegendEntry::line("loop", Tone::Revisit, Stroke::Solid));
    }
    if shown == ShownLoops::All
        && own
            .robot
            .links
            .iter()
            .any(|link| !link.decision.is_in_graph())
    {
        legend.push(LegendEntry::line(
            "rejected",
            Tone::Series(2),
            Stroke::Dotted,
        ));
    }
    if own.link().is_some() {
        let chosen = LegendEntry::line("listed loop", Tone::Series(1), Stroke::Solid);
        legend.push(chosen);
    }
    if own.place().is_some() {
        let way = LegendEntry::line("the other log, localized", OTHER, Stroke::Solid);
        let doubted = LegendEntry::line("doubtful", OTHER, Stroke::Dotted);
        legend.extend([way, doubted]);
    }
    if !own.doubts().is_empty() {
        legend.push(LegendEntry::mark("look into", Tone::Strained, Mark::Circle));
    }
    legend
}

/// The observed area and the wheels' path around it, rounded to whole metres so that a growing map seldom moves.
fn bounds(robot: &LogState, by_wheels: &[Option<SE2>]) -> Bounds {
    let mut bounds = Bounds {
        min: [f64::INFINITY; 2],
        max: [f64::NEG_INFINITY; 2],
    };
    let corners = robot.map.iter();
    let corners = corners.flat_map(|map| [map.bounds.min, map.bounds.max]);
    let places = robot.keyframes.iter().map(|k| [k.pose[0], k.pose[1]]);
    for at in corners.chain(places) {
        for (i, at) in at.into_iter().enumerate() {
            if at.is_finite() {
                bounds.min[i] = bounds.min[i].min(at);
                bounds.max[i] = bounds.max[i].max(at);
            }
        }
    }
    if !bounds.size().iter().all(|size| size.is_finite()) {
        return EMPTY;
    }
    // However far the wheels' path leads, the view is at most twice as large as the map.
    let [width, height] = bounds.size();
    let beyond = 0.5 * math::max(width, height);
    let [min, max] = [bounds.min, bounds.max];
    for pose in by_wheels.iter().flatten() {
        for (i, at) in xy(pose).into_iter().enumerate() {
            bounds.min[i] = math::max(bounds.min[i].min(at), min[i] - beyond);
            bounds.max[i] = math::min(bounds.max[i].max(at), max[i] + beyond);
        }
    }
    let low = bounds.min.map(|low| (low - MARGIN_M).floor());
    let high = bounds.max.map(|high| (high + MARGIN_M).ceil());
    let height = math::max(high[1] - low[1], (high[0] - low[0]) / RATIO);
    let middle = [0, 1].map(|i| 0.5 * (low[i] + high[i]));
    let half = [0.5 * RATIO * height, 0.5 * height];
    Bounds {
        min: core::array::from_fn(|i| middle[i] - half[i]),
        max: core::array::from_fn(|i| middle[i] + half[i]),
    }
}

/// What stands for a map until there is one: an invitation, or words.
fn without_map(own: &OwnRobot) -> Vec<Layer> {
    let words = match own.robot.progress.stage {
        Stage::Empty => return own.invitation.get_or_init(invitation::layers).clone(),
        Stage::Failed => "There is no map yet.",
        _ => "The log is read.",
    };
    vec![Layer::Question(words.to_owned())]
}

fn at(robot: &LogState, keyframe: usize) -> Option<[f64; 2]> {
    let pose = robot.keyframes.get(keyframe)?.pose;
    Some([pose[0], pose[1]])
}

fn links(own: &OwnRobot) -> Vec<Layer> {
    let robot = &own.robot;
    let chosen = own.link();
    let segments = |is_in_graph: bool| {
        let shown = own.values.get(&LOOPS);
        let links = robot.links.iter().filter(|link| shown.include(link));
        let links = links.filter(|link| link.decision.is_in_graph() == is_in_graph);
        links
            .filter_map(|link| Some([at(robot, link.new)?, at(robot, link.old)?]))
            .collect()
    };
    let mut layers = vec![
        Layer::Segments {
            segments: segments(false),
            stroke: Stroke::Dotted,
            tone: Tone::Series(2),
            width_px: 1.25,
        },
        Layer::Segments {
            segments: segments(true),
            stroke: Stroke::Solid,
            tone: Tone::Revisit,
            width_px: 1.25,
        },
    ];
    let ends = chosen.and_then(|link| {
        let link = &robot.links[link];
        Some([at(robot, link.new)?, at(robot, link.old)?])
    });
    if let Some(ends) = ends {
        layers.push(Layer::Segments {
            segments: vec![ends],
            stroke: Stroke::Solid,
            tone: Tone::Series(1),
            width_px: 3.0,
        });
        let ends = Layer::points(ends.to_vec(), Mark::Triangle, Tone::Series(1), 4.0);
        layers.push(ends);
    }
    layers
}

/// The path in its colours over a line of ink, and the colour bar.
fn way(own: &OwnRobot) -> (Vec<Layer>, Option<ColorBar>) {
    let robot = &own.robot;
    let colour = own.values.get(&COLOUR);
    let values = colour.values(robot);
    let mut known: Vec<f64> = values.iter().copied().filter(|v| v.is_finite()).collect();
    sort_numbers(&mut known);
    let places: Vec<[f64; 2]> = robot
        .keyframes
        .iter()
        .map(|k| [k.pose[0], k.pose[1]])
        .collect();
    let ink = Layer::Line {
        points: places.clone(),
        stroke: Stroke::Solid,
        tone: Tone::Ink,
        width_px: 4.0,
    };
    let Some(&least) = known.first() else {
        return (vec![ink], None);
    };
    let most = match colour {
        Colour::Time => known[known.len() - 1],
        Colour::Fit => 1.0,
        _ => known[((known.len() - 1) as f64 * SCALE_QUANTILE).round() as usize],
    };
    let least = match colour {
        Colour::Fit | Colour::Sigma | Colour::Error => 0.0,
        Colour::Time => least,
    };
    let span = if most > least { most - least } else { 1.0 };
    let mut shades: Vec<Vec<[[f64; 2]; 2]>> = vec![Vec::new(); SHADES];
    for (ends, value) in places.windows(2).zip(&values[1..]) {
        if value.is_finite() {
            let level = ((value - least) / span).clamp(0.0, 1.0);
            let shade = (level * (SHADES - 1) as f64).round() as usize;
            shades[shade].push([ends[0], ends[1]]);
        }
    }
    let mut layers = vec![ink];
    for (shade, segments) in shades.into_iter().enumerate() {
        if !segments.is_empty() {
            layers.push(Layer::Segments {
                segments,
                stroke: Stroke::Solid,
                tone: Tone::Level((255 * shade / (SHADES - 1)) as u8),
                width_px: 2.5,
            });
        }
    }
    let bar = ColorBar {
        label: colour.label().to_owned(),
        min: least,
        max: least + span,
    };
    (layers, Some(bar))
}

/// The selected keyframe with its scan, the marked one, and those to check.
fn here(own: &OwnRobot) -> Vec<Layer> {
    let robot = &own.robot;
    let shown = own.keyframe();
    let mut layers = Vec::new();
    let doubts = own.doubts();
    let doubts: Vec<_> = doubts.iter().filter_map(|&k| at(robot, k)).collect();
    if !doubts.is_empty() {
        layers.push(Layer::points(doubts, Mark::Circle, Tone::Strained, 6.0));
    }
    let pose = robot.keyframes[shown].pose;
    let (sin, cos) = math::sin_cos(pose[2]);
    // The motion during the sweep moves the points off the walls.
    let scan = robot.scan.iter().filter(|scan| scan.keyframe == shown);
    for (points, mark, tone) in scan.flat_map(|scan| {
        [
            (&scan.sweep, Mark::Dot, Tone::Strained),
            (&scan.points, Mark::Cross, Tone::Measurement),
        ]
    }) {
        let placed = points
            .iter()
            .map(|[x, y]| [pose[0] + cos * x - sin * y, pose[1] + sin * x + cos * y]);
        if !points.is_empty() {
            layers.push(Layer::points(placed.collect(), mark, tone, 2.5));
        }
    }
    let marked = own.values.get(&MARKED);
    if marked > 0
        && let Some(at) = at(robot, marked)
    {
        layers.push(Layer::points(vec![at], Mark::Plus, Tone::Ink, 8.0));
    }
    if robot.progress.stage == Stage::Done {
        layers.push(Layer::Handle {
            at: [pose[0], pose[1]],
            tone: Tone::Posterior,
            label: "drag this keyframe",
        });
    }
    layers.push(Layer::pose(pose, Mark::Square, Tone::Posterior, 4.0));
    layers
}
