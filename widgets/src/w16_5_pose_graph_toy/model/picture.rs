//! The panels: poses connected by springs, a bar for each spring, χ² over the steps.

use ch16_slam2d::graph::{EdgeKind, EdgeView};
use pr_geom::{SE2, math};
use widget_kit::chart::{Series, TimeChart, axis_from_zero};
use widget_kit::scene::{
    Aspect, Axis, Bounds, Layer, LegendEntry, Mark, Panel, Scene, Stroke, Tone, Weight,
};

use crate::xy::xy;

use super::interaction::{bow_m, turn_handle};
use super::{PoseGraphToy, panel};

use crate::w16_5_pose_graph_toy::spec::{PINNED, STIFFNESS};

/// Margin around the poses, m.
const MARGIN_M: f64 = 0.3;
/// Smallest size of the map, m.
const MIN_SIZE_M: [f64; 2] = [2.4, 1.9];
/// Windings of a spring.
const WINDINGS: usize = 7;
/// Distance of the name of the pinned pose below it, m.
const PINNED_BELOW_M: f64 = 0.22;
/// Half the width of a spring, m.
const SPRING_M: f64 = 0.06;

pub fn scene(toy: &PoseGraphToy) -> Scene {
    Scene {
        panels: vec![graph(toy), bars(toy), steps(toy)],
    }
}

fn tone(edge: &EdgeView) -> Tone {
    match edge.edge.kind {
        EdgeKind::Odometry => Tone::Prediction,
        EdgeKind::Loop => Tone::Measurement,
    }
}

fn graph(toy: &PoseGraphToy) -> Panel {
    let poses = toy.poses();
    let start = &toy.course.moments[0].poses;
    let mut layers = Vec::new();
    let mut legend = vec![
        LegendEntry::line("odometry", Tone::Prediction, Stroke::Solid),
        LegendEntry::line("loop", Tone::Measurement, Stroke::Solid),
        LegendEntry::marked_line("missing", Tone::Ink, Mark::Plus, Stroke::Dotted),
    ];
    if toy.step() > 0 {
        layers.extend(trails(toy));
        let before = start.iter().map(xy).collect();
        layers.push(Layer::points(before, Mark::Circle, Tone::Prior, 5.0));
        legend.push(LegendEntry::mark("before", Tone::Prior, Mark::Circle));
    }
    let mut costs = Vec::new();
    for (edge, chi2) in toy.course.edges.iter().zip(&toy.shown().edge_chi2) {
        let (from, to) = (&poses[edge.from.index()], &poses[edge.to.index()]);
        let bow_m = match edge.edge.kind {
            EdgeKind::Odometry => 0.0,
            EdgeKind::Loop => bow_m(toy.values.get(&STIFFNESS)),
        };
        let points = spring([from.x(), from.y()], [to.x(), to.y()], bow_m);
        costs.push(Layer::label(
            points[points.len() / 2],
            short(toy, *chi2),
            10.0,
        ));
        layers.push(Layer::Line {
            points,
            stroke: Stroke::Solid,
            tone: tone(edge),
            // A stiff spring is a thick one.
            width_px: (0.7 + 1.6 * math::sqrt(edge.edge.information[(0, 0)])) as f32,
        });
        let wanted = *from * edge.edge.measurement;
        let missing = [[to.x(), to.y()], [wanted.x(), wanted.y()]];
        layers.push(Layer::segments(
            vec![missing],
            Stroke::Dotted,
            Tone::Ink,
            2.0,
        ));
        layers.push(Layer::points(vec![missing[1]], Mark::Plus, Tone::Ink, 5.0));
    }
    layers.extend(poses.iter().flat_map(node));
    layers.extend(poses.iter().enumerate().map(|(k, pose)| {
        let pinned = k == 0 && toy.values.get(&PINNED);
        let name = (k + 1).to_string();
        let text = if pinned {
            format!("{name}, pinned")
        } else {
            name
        };
        if pinned {
            // Below the pose: its springs leave it to the side and upwards.
            Layer::Text {
                at: [pose.x(), pose.y() - PINNED_BELOW_M],
                text,
                tone: Tone::Ink,
            }
        } else {
            Layer::label([pose.x(), pose.y()], text, 12.0)
        }
    }));
    layers.extend(costs);
    let [x, y] = axes(toy);
    Panel {
        id: panel::GRAPH,
        title: format!(
            "Step {} of {}: χ² {}",
            toy.step(),
            toy.course.last(),
            short(toy, toy.shown().chi2)
        ),
        weight: Weight::Main,
        aspect: Aspect::Equal,
        x,
        y,
        layers,
        legend,
        color_bar: None,
    }
}

fn node(pose: &SE2) -> Vec<Layer> {
    let tip = turn_handle(pose);
    vec![
        Layer::segments(
            vec![[[pose.x(), pose.y()], [tip.x, tip.y]]],
            Stroke::Solid,
            Tone::Posterior,
            2.0,
        ),
        Layer::points(vec![[tip.x, tip.y]], Mark::Dot, Tone::Posterior, 4.0),
        Layer::Handle {
            at: [pose.x(), pose.y()],
            tone: Tone::Posterior,
            label: "pull the pose and let go; its tip turns it",
        },
    ]
}

fn words(at: [f64; 2], text: &str) -> Layer {
    Layer::Text {
        at,
        text: text.to_owned(),
        tone: Tone::Ink,
    }
}

/// The path of each pose over the steps so far.
fn trails(toy: &PoseGraphToy) -> impl Iterator<Item = Layer> + '_ {
    let moments = &toy.course.moments[..=toy.step()];
    (0..toy.shown().poses.len()).map(|k| {
        Layer::line(
            moments
                .iter()
                .map(|moment| [moment.poses[k].x(), moment.poses[k].y()])
                .collect(),
            Stroke::Solid,
            Tone::Prior,
            1.25,
        )
    })
}

/// A zigzag between two points, bowed to the right by that much.
fn spring(from: [f64; 2], to: [f64; 2], bow_m: f64) -> Vec<[f64; 2]> {
    let along = [to[0] - from[0], to[1] - from[1]];
    let length = math::norm2(along[0], along[1]).max(1e-9);
    let right = [along[1] / length, -along[0] / length];
    let count = 2 * WINDINGS + 2;
    let at = |k: usize| {
        let share = k as f64 / count as f64;
        let swing = match k {
            0 | 1 => 0.0,
            k if k + 1 >= count => 0.0,
            k if k.is_multiple_of(2) => SPRING_M,
            _ => -SPRING_M,
        };
        let aside = swing + bow_m * 4.0 * share * (1.0 - share);
        core::array::from_fn(|i| from[i] + share * along[i] + aside * right[i])
    };
    (0..=count).map(at).collect()
}

/// Axes over all poses of all steps, constant during playback and while something is dragged.
pub fn axes(toy: &PoseGraphToy) -> [Axis; 2] {
    if let Some(held) = &toy.held_axes {
        return held.clone();
    }
    let mut bounds = Bounds {
        min: [f64::INFINITY; 2],
        max: [f64::NEG_INFINITY; 2],
    };
    let poses = toy.course.moments.iter().flat_map(|moment| &moment.poses);
    for pose in poses {
        let at = [pose.x(), pose.y()];
        for (i, at) in at.into_iter().enumerate() {
            bounds.min[i] = bounds.min[i].min(at);
            bounds.max[i] = bounds.max[i].max(at);
        }
    }
    let (middle, size) = (bounds.middle(), bounds.size());
    let axis = |i: usize| {
        // In steps of half a metre, so that a changed setting seldom moves the axes.
        let half = 0.5 * (size[i] + 2.0 * MARGIN_M).max(MIN_SIZE_M[i]);
        let low = (2.0 * (middle[i] - half)).floor() / 2.0;
        let high = (2.0 * (middle[i] + half)).ceil() / 2.0;
        Axis::hidden(low, high)
    };
    [axis(0), axis(1)]
}

/// A bar for the χ² of each spring, and what it was at the start.
fn bars(toy: &PoseGraphToy) -> Panel {
    let shown = toy.shown();
    let start = &toy.course.moments[0];
    let highest = start
        .edge_chi2
        .iter()
        .chain(&shown.edge_chi2)
        .copied()
        .fold(0.0, f64::max);
    // Room for a number above the highest bar.
    let y = axis_from_zero("χ²", 1.2 * highest);
    let mut layers = Vec::new();
    for (k, edge) in toy.course.edges.iter().enumerate() {
        let x = k as f64 + 1.0;
        let (now, was) = (shown.edge_chi2[k], start.edge_chi2[k]);
        layers.push(Layer::segments(
            vec![[[x, 0.0], [x, now]]],
            Stroke::Solid,
            tone(edge),
            14.0,
        ));
        layers.push(Layer::segments(
            vec![[[x - 0.3, was], [x + 0.3, was]]],
            Stroke::Dotted,
            Tone::Prior,
            2.0,
        ));
        layers.push(words([x, now + 0.09 * y.max], &short(toy, now)));
    }
    if toy.step() == 0 {
        layers = vec![Layer::Question("What will each spring pay?".to_owned())];
    }
    Panel {
        id: panel::BARS,
        title: "What each spring costs".to_owned(),
        weight: Weight::Half,
        aspect: Aspect::Free,
        x: Axis::from_names(
            "spring, from pose to pose",
            toy.course
                .edges
                .iter()
                .map(|edge| format!("{}–{}", edge.from.index() + 1, edge.to.index() + 1)),
        ),
        y,
        layers,
        legend: vec![LegendEntry::line(
            "before the first step",
            Tone::Prior,
            Stroke::Dotted,
        )],
        color_bar: None,
    }
}

/// A number with at most five characters; at the start with two decimals, which the settings have.
fn short(toy: &PoseGraphToy, value: f64) -> String {
    let decimals = match value {
        0.0..1.0 if toy.step() > 0 => 3,
        0.0..10.0 => 2,
        _ => 1,
    };
    format!("{value:.decimals$}")
}

fn steps(toy: &PoseGraphToy) -> Panel {
    let moments = &toy.course.moments;
    // What is to come would give the answer away.
    let so_far = &moments[..=toy.step().min(moments.len() - 1)];
    let chi2: Vec<f64> = so_far.iter().map(|moment| moment.chi2).collect();
    let chart = TimeChart {
        id: panel::STEPS,
        title: "χ² over the steps",
        x_label: "step",
        last: toy.course.last(),
        y_label: "χ²",
        now: toy.step(),
    };
    let highest = moments.iter().map(|moment| moment.chi2).fold(0.0, f64::max);
    let drawn = chart.panel(&[Series {
        label: "χ² of the graph",
        values: &chi2,
        tone: Tone::Posterior,
        mark: Mark::Square,
    }]);
    Panel {
        y: axis_from_zero(chart.y_label, highest),
        legend: Vec::new(),
        ..drawn
    }
}
