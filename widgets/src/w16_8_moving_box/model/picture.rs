//! The panels: the room with the pull of each pair, and the bias over the share of the box.

use ch16_lab::moving_box::{BoxMethods, BoxScene};
use ch16_slam2d::cloud::PointCloud;
use ch16_slam2d::icp::{IcpVariant, huber_weight};
use pr_geom::{Point2, Vector2, math};
use widget_kit::chart::axis_from_zero;
use widget_kit::scene::{
    Aspect, Axis, Layer, LegendEntry, Mark, Panel, Scene, Stroke, Tone, Weight,
};

use super::curves::SEEDS;
use super::{MovingBox, panel, settings};
use crate::w16_8_moving_box::spec::{MAX_SHARE, SHARE};
use crate::xy::{walls, xy};

/// Tones and marks of the methods.
const TONES: [Tone; 3] = [Tone::Series(0), Tone::Series(1), Tone::Series(2)];
const MARKS: [Mark; 3] = [Mark::Triangle, Mark::Circle, Mark::Square];

pub fn scene(moving: &MovingBox) -> Scene {
    Scene {
        panels: vec![room(moving), bias(moving)],
    }
}

/// Errors are drawn so many times as long.
const ERRORS_LARGER: f64 = 10.0;
/// Pulls too, the largest of these with which no arrow leaves the picture.
const PULLS_LARGER: [f64; 5] = [5.0, 4.0, 3.0, 2.0, 1.0];
/// Half the width and height of the room's picture, m.
const HALF_M: [f64; 2] = [2.3, 2.2];
/// Tone of the pairs on the box.
const ON_BOX: Tone = Tone::Series(3);
/// Length of an arrow's barbs as a share of the arrow, and at most, m.
const BARB_SHARE: f64 = 0.3;
const BARB_M: f64 = 0.07;

fn room(moving: &MovingBox) -> Panel {
    let (scene, method) = (&moving.scene, moving.method());
    let pose = moving.shown(method).pose;
    let truth = BoxScene::truth();
    let points = |cloud: &PointCloud, mark, tone| {
        Layer::points(cloud.iter().map(|p| [p.x, p.y]).collect(), mark, tone, 2.0)
    };
    let outline = |corners: &[Point2<f64>; 4], stroke, width_px| {
        let corners = corners.iter().chain([&corners[0]]);
        let points = corners.map(|c| [c.x, c.y]).collect();
        Layer::line(points, stroke, Tone::Ink, width_px)
    };
    let [before, after] = scene.boxes();
    let mut layers = vec![
        walls(scene.walls()),
        outline(before, Stroke::Dotted, 1.5),
        outline(after, Stroke::Solid, 3.0),
        points(scene.target(), Mark::Cross, Tone::Measurement),
        points(
            &scene.source().transformed(&pose),
            Mark::Square,
            Tone::Posterior,
        ),
    ];
    let title = if moving.is_before() {
        "Two sweeps, and a box that moved".to_owned()
    } else {
        let larger = add_pulls(moving, &mut layers);
        add_errors(moving, &mut layers);
        format!("Pulls of all pairs ×{larger}, errors ×{ERRORS_LARGER}")
    };
    layers.push(Layer::points(
        vec![xy(&truth)],
        Mark::Plus,
        Tone::Truth,
        6.0,
    ));
    layers.push(Layer::Handle {
        at: box_middle(scene),
        tone: Tone::Ink,
        label: "drag the box",
    });
    Panel {
        id: panel::ROOM,
        title,
        weight: Weight::Main,
        aspect: Aspect::Equal,
        x: Axis::hidden(-HALF_M[0], HALF_M[0]),
        y: Axis::hidden(-HALF_M[1], HALF_M[1]),
        layers,
        legend: vec![
            LegendEntry::line("pull of a pair on the box", ON_BOX, Stroke::Solid),
            LegendEntry::line("of a pair on a wall", TONES[method], Stroke::Solid),
            LegendEntry::mark("the true position of the sensor", Tone::Truth, Mark::Plus),
        ],
        color_bar: None,
    }
}

/// Adds an arrow for the pull of each pair. Returns how many times as long they are drawn.
fn add_pulls(moving: &MovingBox, layers: &mut Vec<Layer>) -> f64 {
    // A beam that leaves through the door ends outside.
    let pulls = pulls(moving).filter(|pull| is_in_picture(pull.from));
    let pulls: Vec<Pull> = pulls.collect();
    let larger = largest(&pulls);
    for (on_box, tone) in [(false, TONES[moving.method()]), (true, ON_BOX)] {
        let pulls = pulls.iter().filter(|pull| pull.on_box == on_box);
        let arrows = pulls.flat_map(|pull| arrow(pull.from, pull.by_m * larger));
        layers.push(Layer::line(arrows.collect(), Stroke::Solid, tone, 0.75));
    }
    larger
}

/// Adds where each method sets the sensor, with its error enlarged.
fn add_errors(moving: &MovingBox, layers: &mut Vec<Layer>) {
    let truth = BoxScene::truth();
    for (k, name) in BoxMethods::NAMES.into_iter().enumerate() {
        let [x, y] = BoxScene::error_m(&moving.shown(k).pose);
        let at = [truth.x() + ERRORS_LARGER * x, truth.y() + ERRORS_LARGER * y];
        let radius_px = if k == moving.method() { 6.0 } else { 4.0 };
        layers.push(Layer::points(vec![at], MARKS[k], TONES[k], radius_px));
        layers.push(Layer::label(at, name.to_owned(), 8.0));
    }
}

/// The pull of a pair: its residual, as the method weighs it.
struct Pull {
    from: Point2<f64>,
    by_m: Vector2<f64>,
    on_box: bool,
}

fn pulls(moving: &MovingBox) -> impl Iterator<Item = Pull> {
    let (scene, method) = (&moving.scene, moving.method());
    let config = settings::methods(&moving.values).configs()[method];
    let pairs = scene.pairs(moving.shown(method).pose, &config);
    pairs.into_iter().map(move |pair| {
        let residual = match (config.variant, pair.normal) {
            (IcpVariant::PointToPlane, Some(normal)) => normal * -pair.plane_distance_m(),
            _ => pair.target - pair.source,
        };
        Pull {
            from: pair.source,
            by_m: residual
                * huber_weight(math::norm2(residual.x, residual.y), config.huber_width_m),
            on_box: scene.is_on_box(pair.source_index),
        }
    })
}

fn is_in_picture(at: Point2<f64>) -> bool {
    at.x.abs() < HALF_M[0] - BARB_M && at.y.abs() < HALF_M[1] - BARB_M
}

/// How many times as long the pulls are drawn.
fn largest(pulls: &[Pull]) -> f64 {
    let stays = |larger: &f64| {
        pulls
            .iter()
            .all(|pull| is_in_picture(pull.from + pull.by_m * *larger))
    };
    let last = PULLS_LARGER.len() - 1;
    let found = PULLS_LARGER.iter().position(stays).unwrap_or(last);
    PULLS_LARGER[found]
}

/// An arrow with two barbs, as an open line that ends in a gap.
fn arrow(from: Point2<f64>, along: Vector2<f64>) -> [[f64; 2]; 7] {
    let tip = from + along;
    let length_m = math::norm2(along.x, along.y).max(f64::MIN_POSITIVE);
    let back = along * ((BARB_SHARE * length_m).min(BARB_M) / length_m);
    let aside = Vector2::new(-back.y, back.x) * 0.5;
    let [left, right] = [tip - back + aside, tip - back - aside];
    let at = |point: Point2<f64>| [point.x, point.y];
    [
        at(from),
        at(tip),
        [f64::NAN; 2],
        at(left),
        at(tip),
        at(right),
        [f64::NAN; 2],
    ]
}

/// The middle of the box after it was moved.
pub fn box_middle(scene: &BoxScene) -> [f64; 2] {
    let [_, after] = scene.boxes();
    let sum = |of: fn(&Point2<f64>) -> f64| after.iter().map(of).sum::<f64>();
    [0.25 * sum(|corner| corner.x), 0.25 * sum(|corner| corner.y)]
}

/// The vertical axis reaches at least this far, mm: it stays while the box is dragged.
const MIN_TOP_MM: f64 = 140.0;

/// Bias in millimetres over the share of the box.
fn bias(moving: &MovingBox) -> Panel {
    let curves = &moving.curves;
    let share = moving.values.get(&SHARE);
    let known = |method: usize| {
        curves
            .bias_m(method)
            .filter_map(|(share, bias)| Some([share, 1e3 * bias?]))
            .collect::<Vec<_>>()
    };
    let lines = [0, 1, 2].map(known);
    let highest = lines
        .iter()
        .flatten()
        .map(|at| at[1])
        .fold(MIN_TOP_MM, f64::max);
    let y = axis_from_zero("translation bias (mm)", highest);
    let mut layers = vec![Layer::line(
        vec![[share, 0.0], [share, y.max]],
        Stroke::Solid,
        Tone::Faint,
        2.5,
    )];
    if moving.is_before() {
        layers = vec![Layer::Question(
            "Which is pulled away, and how far?".to_owned(),
        )];
    } else {
        for (k, line) in lines.into_iter().enumerate() {
            layers.push(Layer::points(line.clone(), MARKS[k], TONES[k], 3.0));
            layers.push(Layer::line(line, Stroke::Solid, TONES[k], 1.75));
        }
    }
    let progress = if curves.progress() < 1.0 {
        let done = (curves.progress() * SEEDS as f64).floor();
        format!("{done:.0} of {SEEDS}")
    } else {
        SEEDS.to_string()
    };
    Panel {
        id: panel::BIAS,
        title: format!("Mean pull over {progress} trials"),
        weight: Weight::Half,
        aspect: Aspect::Free,
        x: Axis::new("points on the box (%)", 0.0, MAX_SHARE),
        y,
        layers,
        legend: BoxMethods::NAMES
            .iter()
            .enumerate()
            .map(|(k, name)| LegendEntry::marked_line(name, TONES[k], MARKS[k], Stroke::Solid))
            .collect(),
        color_bar: None,
    }
}
