//! The panels: the two sweeps, the two basin maps, the curve over the iterations.

use ch16_lab::basin::{Minimum, OffsetAxis};
use ch16_slam2d::cloud::PointCloud;
use ch16_slam2d::icp::IcpVariant;
use kit::chart::{Series, TimeChart};
use kit::scene::{Aspect, Axis, Layer, LegendEntry, Mark, Panel, Scene, Stroke, Tone, Weight};
use pr_geom::SE2;

use super::basins::{class, spot_of};
use super::hands::turn_handle;
use super::settings::{axis, start, variant, variant_name};
use super::words::error_m;
use super::{BasinExplorer, panel};
use crate::spec::OFFSET_SPAN_M;

/// Neighbouring points of a sweep farther apart than this lie on different walls, m.
const WALL_GAP_M: f64 = 0.6;

pub fn scene(explorer: &BasinExplorer) -> Scene {
    Scene {
        panels: vec![
            sweeps(explorer),
            basin(explorer, panel::POINT, IcpVariant::PointToPoint),
            basin(explorer, panel::PLANE, IcpVariant::PointToPlane),
            curve(explorer),
        ],
    }
}

fn sweeps(explorer: &BasinExplorer) -> Panel {
    let BasinExplorer { scene, .. } = explorer;
    let shown = explorer.shown();
    let pose = shown.pose;
    let iteration = explorer.iteration();
    let turn = turn_handle(explorer);
    let links = explorer.pairs();

    let mut layers = vec![
        Layer::Segments {
            segments: links
                .iter()
                .map(|pair| {
                    [
                        [pair.source.x, pair.source.y],
                        [pair.target.x, pair.target.y],
                    ]
                })
                .collect(),
            stroke: Stroke::Solid,
            tone: Tone::Ink,
            width_px: 0.75,
        },
        Layer::Line {
            points: outline(&scene.source().transformed(&scene.truth())),
            stroke: Stroke::Dashed,
            tone: Tone::Truth,
            width_px: 1.5,
        },
        points(scene.target(), Mark::Cross, Tone::Measurement, 3.0),
    ];
    let guess = scene.guess(&start(&explorer.values));
    if iteration > 0 {
        layers.push(points(
            &scene.source().transformed(&guess),
            Mark::Circle,
            Tone::Prior,
            2.0,
        ));
    }
    layers.extend([
        points(
            &scene.source().transformed(&pose),
            Mark::Square,
            Tone::Posterior,
            2.6,
        ),
        sensor(SE2::identity(), Mark::Cross, Tone::Measurement),
        sensor(scene.truth(), Mark::Plus, Tone::Truth),
        sensor(guess, Mark::Circle, Tone::Prior),
        Layer::Segments {
            segments: vec![[[pose.x(), pose.y()], [turn.x, turn.y]]],
            stroke: Stroke::Solid,
            tone: Tone::Posterior,
            width_px: 1.5,
        },
        sensor(pose, Mark::Square, Tone::Posterior),
        Layer::Handle {
            at: [turn.x, turn.y],
            tone: Tone::Posterior,
            label: "turn the source; drag its points to move it",
        },
    ]);

    let entry = |label: &str, tone, mark, stroke| LegendEntry {
        label: label.to_owned(),
        tone,
        mark,
        stroke,
    };
    Panel {
        id: panel::SWEEPS,
        title: format!(
            "Iteration {iteration} of {}: {} pairs, rmse {:.3} m",
            explorer.last(),
            shown.pairs,
            shown.rmse
        ),
        weight: Weight::Main,
        aspect: Aspect::Equal,
        x: Axis {
            label: "x from the target's sensor (m)".to_owned(),
            min: -3.2,
            max: 3.2,
        },
        y: Axis {
            label: "y (m)".to_owned(),
            min: -2.9,
            max: 3.3,
        },
        layers,
        legend: vec![
            entry("target", Tone::Measurement, Some(Mark::Cross), None),
            entry("source now", Tone::Posterior, Some(Mark::Square), None),
            entry("first guess", Tone::Prior, Some(Mark::Circle), None),
            entry(
                "where the source belongs",
                Tone::Truth,
                None,
                Some(Stroke::Dashed),
            ),
            entry("pairs", Tone::Ink, None, Some(Stroke::Solid)),
        ],
        color_bar: None,
    }
}

/// The points of a cloud.
fn points(cloud: &PointCloud, mark: Mark, tone: Tone, radius_px: f32) -> Layer {
    Layer::Points {
        points: cloud.iter().map(|p| [p.x, p.y]).collect(),
        mark,
        tone,
        radius_px,
    }
}

/// Where a sensor stands and looks.
fn sensor(pose: SE2, mark: Mark, tone: Tone) -> Layer {
    Layer::Pose {
        pose: pose.to_array(),
        mark,
        tone,
        radius_px: 6.0,
    }
}

/// A sweep as lines along its walls, broken where neighbouring beams hit different ones.
fn outline(cloud: &PointCloud) -> Vec<[f64; 2]> {
    let mut line: Vec<[f64; 2]> = Vec::with_capacity(cloud.len() + 8);
    for p in cloud.iter() {
        if let Some([x, y]) = line.last()
            && (p.x - x).abs().max((p.y - y).abs()) > WALL_GAP_M
        {
            line.push([f64::NAN; 2]);
        }
        line.push([p.x, p.y]);
    }
    line
}

fn basin(explorer: &BasinExplorer, id: &'static str, of: IcpVariant) -> Panel {
    let chosen = of == variant(&explorer.values);
    let (name, other) = match axis(&explorer.values) {
        OffsetAxis::Dx => (
            "Δx (m)",
            format!("Δy {:.2} m", start(&explorer.values).dy_m),
        ),
        OffsetAxis::Dy => (
            "Δy (m)",
            format!("Δx {:.2} m", start(&explorer.values).dx_m),
        ),
    };
    let progress = explorer.basins.map(of).progress();
    let state = if progress < 1.0 {
        format!(", {:.0} % done", 100.0 * progress)
    } else {
        String::new()
    };
    let mut layers = vec![Layer::Raster(explorer.basins.raster(of))];
    layers.extend(
        explorer
            .basins
            .letters(of, &explorer.values)
            .into_iter()
            .map(|(at, minimum)| Layer::Text {
                at,
                text: minimum.letter().to_string(),
                tone: Tone::Class(class(minimum)),
            }),
    );
    let spot = spot_of(&explorer.values);
    if chosen {
        layers.push(Layer::Handle {
            at: spot,
            tone: Tone::Prior,
            label: "the current start; press anywhere to start there",
        });
    } else {
        layers.push(Layer::Points {
            points: vec![spot],
            mark: Mark::Plus,
            tone: Tone::Ink,
            radius_px: 7.0,
        });
    }
    let legend = Minimum::all().map(|minimum| LegendEntry {
        label: format!("{} {}", minimum.letter(), minimum.name()),
        tone: Tone::Class(class(minimum)),
        mark: None,
        stroke: None,
    });
    Panel {
        id,
        title: format!("Basins, {}, {other}{state}", variant_name(of)),
        weight: Weight::Half,
        aspect: Aspect::Free,
        x: Axis {
            label: "heading error of the first guess (°)".to_owned(),
            min: -180.0,
            max: 180.0,
        },
        y: Axis {
            label: name.to_owned(),
            min: -OFFSET_SPAN_M,
            max: OFFSET_SPAN_M,
        },
        layers,
        // One legend for both maps, below the second.
        legend: if of == IcpVariant::PointToPlane {
            legend.to_vec()
        } else {
            Vec::new()
        },
        color_bar: None,
    }
}

fn curve(explorer: &BasinExplorer) -> Panel {
    let trace = &explorer.run.trace;
    let truth = explorer.scene.truth();
    let rmse: Vec<f64> = trace.iter().map(|state| state.rmse).collect();
    let error: Vec<f64> = trace
        .iter()
        .map(|state| error_m(&truth, &state.pose))
        .collect();
    let series = |label, values, tone, mark| Series {
        label,
        values,
        tone,
        mark,
    };
    let chart = TimeChart {
        id: panel::CURVE,
        title: "What the robot sees, and how far it is from the truth",
        x_label: "iteration",
        last: explorer.last(),
        y_label: "m",
        now: explorer.iteration(),
    };
    let mut panel = chart.panel(&[
        series("rmse of the pairs", &rmse, Tone::Posterior, Mark::Square),
        series("error of the position", &error, Tone::Truth, Mark::Plus),
    ]);
    dash_truth(&mut panel);
    panel
}

/// Truth is dashed everywhere.
fn dash_truth(panel: &mut Panel) {
    for layer in &mut panel.layers {
        if let Layer::Line {
            tone: Tone::Truth,
            stroke,
            ..
        } = layer
        {
            *stroke = Stroke::Dashed;
        }
    }
    for entry in &mut panel.legend {
        if entry.tone == Tone::Truth {
            entry.stroke = Some(Stroke::Dashed);
        }
    }
}
