//! The panels: the map with its graph, the parts at work, the registration of the newest sweep, the plots over time.

pub mod parts;
mod plots;

use ch16_lab::lap::{LapRecord, RegistrationView};
use ch16_slam2d::cloud::PointCloud;
use ch16_slam2d::graph::EdgeKind;
use pr_geom::SE2;
use widget_kit::scene::{
    Aspect, Axis, Layer, LegendEntry, Mark, Panel, Scene, Stroke, Tone, Weight,
};

use super::ControlRoom;

use crate::loop_arc::loop_arc;
use crate::xy::xy;

pub use plots::OVER_TIME;

/// Half the side of the close-up, in metres.
const CLOSE_UP_M: f64 = 4.0;

/// Colour of an accepted loop.
const LOOP: Tone = Tone::Measurement;

/// The smallest correction of a keyframe that can be seen, m.
const SEEN_M: f64 = 0.02;

/// The whole picture.
pub fn scene(room: &ControlRoom) -> Scene {
    let (record, now) = (&room.record, room.tick());
    Scene {
        panels: vec![
            map(room),
            registration(record, now, room.registration.as_ref()),
            parts::parts(&record.lap.reports[..now], room.part(), room.closing),
            plots::threshold(&room.history, now),
            plots::errors(&room.history, now),
        ],
    }
}

/// The map at the current tick: grid, graph, truth and robot.
fn map(room: &ControlRoom) -> Panel {
    let (record, tick) = (&room.record, room.tick());
    let bounds = room.world.bounds();
    let truth = |tick| record.drive.truth(tick);
    let mut layers = vec![
        Layer::Raster(room.grid.raster().clone()),
        Layer::line(
            (0..=tick).map(|tick| xy(&truth(tick))).collect(),
            Stroke::Dashed,
            Tone::Truth,
            1.5,
        ),
        Layer::segments(
            edges(record, tick, EdgeKind::Odometry).collect(),
            Stroke::Solid,
            Tone::Posterior,
            1.5,
        ),
        Layer::points(
            record.lap.poses(tick).iter().map(xy).collect(),
            Mark::Square,
            Tone::Posterior,
            3.0,
        ),
    ];
    layers.extend(
        edges(record, tick, EdgeKind::Loop)
            .map(|[from, to]| Layer::line(loop_arc(from, to), Stroke::Solid, LOOP, 2.5)),
    );
    layers.extend([
        robot(&truth(tick), Mark::Plus, Tone::Truth),
        robot(&estimate(record, tick), Mark::Square, Tone::Posterior),
    ]);
    if room.now().is_some_and(parts::closes_loop) {
        layers.extend(correction(record, tick));
    }
    Panel {
        id: "map",
        title: "Occupancy grid and pose graph".to_owned(),
        weight: Weight::Main,
        aspect: Aspect::Equal,
        x: Axis::hidden(bounds.min.x, bounds.max.x),
        y: Axis::hidden(bounds.min.y, bounds.max.y),
        layers,
        legend: vec![
            LegendEntry::marked_line("truth", Tone::Truth, Mark::Plus, Stroke::Dashed),
            LegendEntry::marked_line("pose graph", Tone::Posterior, Mark::Square, Stroke::Solid),
            area("occupied", Tone::Ink),
            LegendEntry::line("loop", LOOP, Stroke::Solid),
        ],
        color_bar: None,
    }
}

/// The keyframes where they were before a loop moved them.
fn correction(record: &LapRecord, tick: usize) -> Vec<Layer> {
    let poses = record.lap.poses(tick);
    let was = record.lap.poses(tick - 1);
    let moved = was.iter().zip(poses);
    let moved = moved.filter(|(was, is)| (was.position() - is.position()).norm() > SEEN_M);
    let before: Vec<[f64; 2]> = moved.map(|(was, _)| xy(was)).collect();
    // The farther from where the robot started, the farther a keyframe has moved.
    let turned = before.iter().copied().max_by(|a, b| a[0].total_cmp(&b[0]));
    let was = turned.map(|at| Layer::label(at, "before".to_owned(), 8.0));
    let points = Layer::points(before, Mark::Circle, Tone::Prior, 3.0);
    [points].into_iter().chain(was).collect()
}

/// A legend entry for the cells of one colour.
fn area(label: &str, tone: Tone) -> LegendEntry {
    LegendEntry {
        label: label.to_owned(),
        tone,
        mark: None,
        stroke: None,
    }
}

/// A tick's registration: local map, the sweep at the odometry prediction and at ICP's result.
///
/// At the start there is no registration: the first sweep is at the known pose. A loop that is closed in the
/// same tick moves the estimate afterwards.
fn registration(record: &LapRecord, tick: usize, view: Option<&RegistrationView>) -> Panel {
    let start = record.drive.truth(0);
    let (center, layers) = match view {
        Some(view) => (view.icp.pose, registration_layers(record, tick, view)),
        None => (start, first_sweep(record, &start)),
    };
    Panel {
        id: "registration",
        title: "Registration of this sweep".to_owned(),
        weight: Weight::Half,
        aspect: Aspect::Equal,
        x: Axis::hidden(center.x() - CLOSE_UP_M, center.x() + CLOSE_UP_M),
        y: Axis::hidden(center.y() - CLOSE_UP_M, center.y() + CLOSE_UP_M),
        layers,
        legend: vec![
            LegendEntry::mark("local map", Tone::Prior, Mark::Circle),
            LegendEntry::mark("as predicted", Tone::Prediction, Mark::Triangle),
            LegendEntry::mark("as registered", Tone::Measurement, Mark::Cross),
            LegendEntry::line("pairs", Tone::Ink, Stroke::Solid),
        ],
        color_bar: None,
    }
}

fn first_sweep(record: &LapRecord, start: &SE2) -> Vec<Layer> {
    let sweep = record.drive.sweep(0).cloud.transformed(start);
    vec![
        Layer::points(positions(&sweep), Mark::Cross, Tone::Measurement, 3.0),
        robot(start, Mark::Square, Tone::Posterior),
    ]
}

fn registration_layers(record: &LapRecord, tick: usize, view: &RegistrationView) -> Vec<Layer> {
    let sweep = &record.drive.sweep(tick).cloud;
    let placed = |pose: &SE2| positions(&sweep.transformed(pose));
    let pairs = view.icp.pairs.iter();
    vec![
        Layer::points(positions(&view.local_cloud), Mark::Circle, Tone::Prior, 2.0),
        Layer::segments(
            pairs
                .map(|pair| {
                    [
                        [pair.source.x, pair.source.y],
                        [pair.target.x, pair.target.y],
                    ]
                })
                .collect(),
            Stroke::Solid,
            Tone::Ink,
            1.0,
        ),
        Layer::points(
            placed(&view.prediction),
            Mark::Triangle,
            Tone::Prediction,
            3.0,
        ),
        Layer::points(placed(&view.icp.pose), Mark::Cross, Tone::Measurement, 3.0),
        robot(&view.prediction, Mark::Triangle, Tone::Prediction),
        robot(&view.icp.pose, Mark::Square, Tone::Posterior),
    ]
}

/// The estimate at the end of a tick, `world_from_body`.
fn estimate(record: &LapRecord, tick: usize) -> SE2 {
    let report = record.lap.report(tick);
    report.map_or_else(|| record.drive.truth(0), |report| report.estimate)
}

/// The ends of the edges of a kind at a tick.
fn edges(
    record: &LapRecord,
    tick: usize,
    kind: EdgeKind,
) -> impl Iterator<Item = [[f64; 2]; 2]> + '_ {
    let poses = record.lap.poses(tick);
    let edges = record.lap.edges(tick).iter();
    edges
        .filter(move |edge| edge.kind == kind)
        .map(move |edge| [xy(&poses[edge.from]), xy(&poses[edge.to])])
}

fn positions(cloud: &PointCloud) -> Vec<[f64; 2]> {
    cloud.iter().map(|point| [point.x, point.y]).collect()
}

fn robot(pose: &SE2, mark: Mark, tone: Tone) -> Layer {
    Layer::pose(pose.to_array(), mark, tone, 6.0)
}
