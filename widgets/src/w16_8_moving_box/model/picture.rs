//! The panels: the sweeps as each method registers them, and the bias over the share of the box.

use ch16_lab::moving_box::{BoxMethods, BoxScene};
use ch16_slam2d::cloud::PointCloud;
use kit::chart::axis_from_zero;
use kit::scene::{Aspect, Axis, Layer, LegendEntry, Mark, Panel, Scene, Stroke, Tone, Weight};
use pr_geom::{Point2, SE2};

use super::curves::SEEDS;
use super::{MovingBox, panel};
use crate::w16_8_moving_box::spec::{MOST_SHARE, SHARE};

/// Tones and marks of the methods.
const TONES: [Tone; 3] = [Tone::Series(0), Tone::Series(1), Tone::Series(2)];
const MARKS: [Mark; 3] = [Mark::Triangle, Mark::Circle, Mark::Square];

pub fn scene(moving: &MovingBox) -> Scene {
    let mut panels: Vec<Panel> = (0..3).map(|method| sweeps(moving, method)).collect();
    panels.push(bias(moving));
    Scene { panels }
}

fn sweeps(moving: &MovingBox, method: usize) -> Panel {
    let shown = moving.shown(method);
    let scene = &moving.scene;
    let truth = BoxScene::truth();
    let points = |cloud: &PointCloud, mark, tone| {
        Layer::points(cloud.iter().map(|p| [p.x, p.y]).collect(), mark, tone, 2.0)
    };
    let outline = |corners: &[Point2<f64>; 4], stroke| {
        Layer::line(
            corners
                .iter()
                .chain([&corners[0]])
                .map(|c| [c.x, c.y])
                .collect(),
            stroke,
            Tone::Ink,
            1.25,
        )
    };
    let [before, after] = scene.boxes();
    let [x, y] = BoxScene::error_m(&shown.pose);
    // One legend for all three, below the last.
    let legend = [
        LegendEntry::mark("target", Tone::Measurement, Mark::Cross),
        LegendEntry::mark("source", Tone::Posterior, Mark::Square),
        LegendEntry::line("box before", Tone::Ink, Stroke::Dotted),
        LegendEntry::line("box after", Tone::Ink, Stroke::Solid),
        LegendEntry::mark("truth", Tone::Truth, Mark::Plus),
    ];
    Panel {
        id: panel::SWEEPS[method],
        title: format!(
            "{}: {:.3} m off",
            capital(BoxMethods::NAMES[method]),
            pr_geom::math::norm2(x, y)
        ),
        weight: Weight::Main,
        aspect: Aspect::Equal,
        x: Axis::hidden(-2.3, 2.3),
        y: Axis::hidden(-2.2, 2.2),
        layers: vec![
            outline(before, Stroke::Dotted),
            outline(after, Stroke::Solid),
            points(scene.target(), Mark::Cross, Tone::Measurement),
            points(
                &scene.source().transformed(&shown.pose),
                Mark::Square,
                Tone::Posterior,
            ),
            sensor(truth, Mark::Plus, Tone::Truth),
            sensor(shown.pose, Mark::Square, Tone::Posterior),
            Layer::Handle {
                at: box_middle(scene),
                tone: Tone::Ink,
                label: "drag the box",
            },
        ],
        legend: if method + 1 == panel::SWEEPS.len() {
            legend.to_vec()
        } else {
            Vec::new()
        },
        color_bar: None,
    }
}

/// The middle of the box after it was moved.
pub fn box_middle(scene: &BoxScene) -> [f64; 2] {
    let [_, after] = scene.boxes();
    let sum = |of: fn(&Point2<f64>) -> f64| after.iter().map(of).sum::<f64>();
    [0.25 * sum(|corner| corner.x), 0.25 * sum(|corner| corner.y)]
}

fn capital(name: &str) -> String {
    let mut letters = name.chars();
    let first = letters.next().into_iter().flat_map(char::to_uppercase);
    first.chain(letters).collect()
}

fn sensor(pose: SE2, mark: Mark, tone: Tone) -> Layer {
    Layer::pose(pose.to_array(), mark, tone, 5.0)
}

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
    let highest = lines.iter().flatten().map(|at| at[1]).fold(10.0, f64::max);
    let y = axis_from_zero("bias of the translation (mm)", highest);
    let mut layers = vec![Layer::line(
        vec![[share, 0.0], [share, y.max]],
        Stroke::Solid,
        Tone::Faint,
        2.5,
    )];
    for (k, line) in lines.into_iter().enumerate() {
        layers.push(Layer::points(line.clone(), MARKS[k], TONES[k], 3.0));
        layers.push(Layer::line(line, Stroke::Solid, TONES[k], 1.75));
    }
    let progress = if curves.progress() < 1.0 {
        format!(
            ", {:.0} % of {SEEDS} seeds",
            (100.0 * curves.progress()).floor()
        )
    } else {
        format!(" over {SEEDS} seeds")
    };
    Panel {
        id: panel::BIAS,
        title: format!("How far the box pulls the mean{progress}"),
        weight: Weight::Half,
        aspect: Aspect::Free,
        x: Axis::new("points on the box (%)", 0.0, MOST_SHARE),
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
