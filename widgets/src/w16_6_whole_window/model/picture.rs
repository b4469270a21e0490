//! The panels: the sweeps, the positions of the window, the bounds over the heading.

mod bounds;
mod places;

pub use bounds::box_at;

use ch16_slam2d::cloud::PointCloud;
use pr_geom::SE2;
use widget_kit::scene::{
    Aspect, Axis, Layer, LegendEntry, Mark, Panel, Scene, Stroke, Tone, Weight,
};

use super::interaction::turn_handle;
use super::texts::grouped;
use super::{WholeWindow, panel};
use crate::sweep_bounds::sweep_bounds;
use crate::xy::{walls, xy};

/// Space around the sweeps, m.
const MARGIN_M: f64 = 0.1;

pub fn scene(window: &WholeWindow) -> Scene {
    Scene {
        panels: vec![sweeps(window), places::panel(window), bounds::panel(window)],
    }
}

fn sweeps(window: &WholeWindow) -> Panel {
    let scene = &window.scene;
    let guess = window.guess();
    let pose = window.shown_pose();
    let turn = turn_handle(&guess);
    let best = scene.source().transformed(&pose);
    let mut layers = vec![
        walls(scene.walls()),
        Layer::Seen {
            from: xy(&pose),
            points: best.iter().map(|point| [point.x, point.y]).collect(),
            tone: Tone::Posterior,
        },
        points(scene.target(), Mark::Cross, Tone::Measurement, 3.0),
    ];
    layers.extend(places::boxes_now(window));
    if window.step() < window.boxes_taken() {
        layers.extend(places::looked_at(window));
    }
    if let Some(icp) = icp_now(window) {
        let sweep = scene.source().transformed(&icp);
        let off_deg = icp.between(&scene.truth()).theta().to_degrees().abs();
        layers.extend([
            points(&sweep, Mark::Dot, Tone::Series(2), 2.2),
            icp_path(window),
            sensor(icp, Mark::Dot, Tone::Series(2)),
            Layer::label(xy(&icp), format!("ICP alone: {off_deg:.0}° off"), 12.0),
        ]);
    }
    layers.extend([
        points(&best, Mark::Square, Tone::Posterior, 2.6),
        sensor(scene.truth(), Mark::Plus, Tone::Truth),
        sensor(guess, Mark::Circle, Tone::Prior),
        Layer::segments(
            vec![[xy(&guess), [turn.x, turn.y]]],
            Stroke::Solid,
            Tone::Prior,
            1.5,
        ),
        Layer::Handle {
            at: [turn.x, turn.y],
            tone: Tone::Prior,
            label: "turn the start; drag its sensor to move it",
        },
        Layer::label(xy(&scene.truth()), "truth".to_owned(), 8.0),
    ]);
    if window.step() == 0 {
        layers.push(Layer::label([turn.x, turn.y], "turn".to_owned(), 10.0));
    }
    if window.raced().is_some() {
        layers.push(sensor(pose, Mark::Square, Tone::Posterior));
    }
    let [x, y] = frame(window);
    let counts = window.search_task.window.moments()[window.step()].counts;
    Panel {
        id: panel::SWEEPS,
        title: format!(
            "{} scores for {} poses",
            grouped(counts.scored()),
            grouped(counts.window)
        ),
        weight: Weight::Main,
        aspect: Aspect::Equal,
        x,
        y,
        layers,
        legend: legend(window),
        color_bar: None,
    }
}

/// What is on the picture now, and stays in its place.
fn legend(window: &WholeWindow) -> Vec<LegendEntry> {
    let is_open = window.step() < window.boxes_taken();
    vec![
        if is_open {
            LegendEntry::line("it may be here", Tone::Series(0), Stroke::Solid)
        } else {
            LegendEntry::mark("first sweep", Tone::Measurement, Mark::Cross)
        },
        if window.step() > 0 {
            LegendEntry::line("thrown away", places::THROWN_AWAY, Stroke::Solid)
        } else {
            LegendEntry::mark("start", Tone::Prior, Mark::Circle)
        },
        LegendEntry::mark("best so far", Tone::Posterior, Mark::Square),
        if window.raced().is_some() {
            LegendEntry::mark("ICP alone", Tone::Series(2), Mark::Dot)
        } else {
            LegendEntry::mark("first sweep", Tone::Measurement, Mark::Cross)
        },
    ]
}

/// The pose of ICP alone in the race; before it nothing tells where it ends.
fn icp_now(window: &WholeWindow) -> Option<SE2> {
    let path = &window.search_task.alone.path;
    window.raced().map(|step| path[step])
}

/// The path of ICP alone as far as it is.
fn icp_path(window: &WholeWindow) -> Layer {
    let path = &window.search_task.alone.path;
    let done = path.iter().take(window.raced().map_or(0, |step| step + 1));
    let positions = done.map(xy).collect();
    Layer::line(positions, Stroke::Solid, Tone::Series(2), 2.0)
}

/// Axes that hold the target, and the source at any heading about the truth.
fn frame(window: &WholeWindow) -> [Axis; 2] {
    let scene = &window.scene;
    sweep_bounds(scene, &[scene.truth()], None)
        .map(|[low, high]| Axis::hidden(low - MARGIN_M, high + MARGIN_M))
}

/// Pose of a sensor.
pub fn sensor(pose: SE2, mark: Mark, tone: Tone) -> Layer {
    Layer::pose(pose.to_array(), mark, tone, 6.0)
}

fn points(cloud: &PointCloud, mark: Mark, tone: Tone, radius_px: f32) -> Layer {
    let points = cloud.iter().map(|p| [p.x, p.y]).collect();
    Layer::points(points, mark, tone, radius_px)
}
