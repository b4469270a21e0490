//! The panels: the two sweeps, the two basin maps, the curve over the iterations.

use ch16_lab::basin::{Minimum, OffsetAxis};
use ch16_slam2d::cloud::PointCloud;
use ch16_slam2d::icp::{IcpVariant, Pair};
use pr_geom::{Point2, SE2, math};
use widget_kit::scene::{
    Aspect, Axis, Layer, LegendEntry, Mark, Panel, Scene, Stroke, Tone, Weight,
};

use super::basins::{class, in_the_map, spot_of, start_spot};
use super::curve::curve;
use super::edge;
use super::interaction::turn_handle;
use super::paths::split_at_half_turn;
use super::settings::{axis, start, variant, variant_name};
use super::turns::arc;
use super::{BasinExplorer, panel};
use crate::sweep_bounds::sweep_bounds;
use crate::w16_1_basin_explorer::spec::{EDGE, OFFSET_SPAN_M, Phase, TAU};
use crate::xy::walls;

/// One point in this many leaves a trail.
const POINTS_PER_TRAIL: usize = 11;

/// Radius of the mark of a sensor, pixels.
const SENSOR_PX: f32 = 6.0;
/// Distance of a robot's word from its center, pixels.
const ROBOT_CLEAR_PX: f32 = 16.0;
/// Distance of a handle's word from its center, pixels.
const HANDLE_CLEAR_PX: f32 = 12.0;

/// Margin around a basin map, so that a mark at its edge is complete, ° and m.
const BASIN_ROOM: [f64; 2] = [12.0, 0.15];

/// The whole picture; of the maps that of the chosen variant comes first.
pub fn scene(explorer: &BasinExplorer) -> Scene {
    let mut maps = [
        basin(explorer, panel::POINT, IcpVariant::PointToPoint),
        basin(explorer, panel::PLANE, IcpVariant::PointToPlane),
    ];
    if variant(&explorer.values) == IcpVariant::PointToPlane {
        maps.reverse();
    }
    let [chosen, other] = maps;
    Scene {
        panels: vec![sweeps(explorer), chosen, other, curve(explorer)],
    }
}

fn sweeps(explorer: &BasinExplorer) -> Panel {
    let BasinExplorer { scene, .. } = explorer;
    let shown = explorer.shown();
    let pose = shown.pose;
    let iteration = explorer.iteration();
    let turn = turn_handle(explorer);
    let links = explorer.pairs();
    let source = scene.source().transformed(&pose);
    let alone = lonely(&source, &links);

    let mut layers = vec![
        walls(scene.walls()),
        Layer::Seen {
            from: [pose.x(), pose.y()],
            points: positions(&source),
            tone: Tone::Posterior,
        },
        points(scene.target(), Mark::Dot, Tone::Measurement, 2.6),
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
    if explorer.previews_end() {
        layers.extend(preview(explorer));
    }
    let ours = explorer.driver().map(|yours| yours.ours.pose);
    layers.extend(ours.map(|end| {
        let ended = scene.source().transformed(&end);
        points(&ended, Mark::Dot, Tone::Series(1), 1.6)
    }));
    layers.extend([
        threads(&links, explorer.values.get(&TAU)),
        points(&source, Mark::Dot, Tone::Posterior, 2.8),
        Layer::points(alone.clone(), Mark::Circle, Tone::Series(0), 4.5),
        sensor(SE2::identity(), Mark::Cross, Tone::Measurement),
        sensor(guess, Mark::Circle, Tone::Prior),
        Layer::segments(
            vec![[[pose.x(), pose.y()], [turn.x, turn.y]]],
            Stroke::Solid,
            Tone::Posterior,
            1.5,
        ),
    ]);
    // The truth comes with the verdict, below the robot, which hides it where it is right.
    let is_over = iteration == explorer.last();
    let truth = scene.truth();
    layers.extend(is_over.then(|| sensor(truth, Mark::Plus, Tone::Truth)));
    layers.extend([
        sensor(pose, Mark::Square, Tone::Posterior),
        Layer::Handle {
            at: [turn.x, turn.y],
            tone: Tone::Posterior,
            label: "turn the source; drag its points to move it",
        },
    ]);

    layers.push(Layer::label(
        [turn.x, turn.y],
        "turn".to_owned(),
        HANDLE_CLEAR_PX,
    ));
    layers.push(Layer::label(
        [0.0; 2],
        "first sweep".to_owned(),
        ROBOT_CLEAR_PX,
    ));
    // Their word would jump about while the sweep moves.
    if iteration == 0 {
        let far = |at: &[f64; 2]| math::norm2(at[0] - pose.x(), at[1] - pose.y());
        let furthest = alone.into_iter().max_by(|a, b| far(a).total_cmp(&far(b)));
        let word = |at| Layer::label(at, "unmatched".to_owned(), HANDLE_CLEAR_PX);
        layers.extend(furthest.map(word));
    }
    // With the verdict it is shown how the other turns end.
    if is_over {
        if explorer.shows_turns() {
            layers.extend(arc(explorer));
        }
        let at = [truth.x(), truth.y()];
        layers.push(Layer::label(at, "truth".to_owned(), ROBOT_CLEAR_PX));
    } else if explorer.previews_end() {
        let end = explorer.run.outcome.pose;
        let at = [end.x(), end.y()];
        layers.push(Layer::label(at, "ends here".to_owned(), ROBOT_CLEAR_PX));
    }
    let [x, y] = frame(explorer);
    let entry = |label: &str, tone, mark, stroke| LegendEntry {
        label: label.to_owned(),
        tone,
        mark,
        stroke,
    };
    let mut legend = Vec::new();
    if ours.is_some() {
        let ours = entry("where ours ends", Tone::Series(1), Some(Mark::Dot), None);
        legend.push(ours);
    }
    let progress = format!("{iteration} of {}", explorer.last());
    Panel {
        id: panel::SWEEPS,
        title: match explorer.driver() {
            Some(yours) => format!(
                "Your {}, {progress}: rmse {:.1} cm",
                yours.orders.function.name(),
                100.0 * shown.rmse_m
            ),
            None => String::new(),
        },
        weight: Weight::Main,
        aspect: Aspect::Equal,
        x,
        y,
        layers,
        legend,
        color_bar: None,
    }
}

/// Axes that hold the target, the source at any heading about its sensor at the first guess and at the truth, and
/// the source at the end. They stay while the source is dragged.
pub fn frame(explorer: &BasinExplorer) -> [Axis; 2] {
    if let Some(held) = &explorer.held_frame {
        return held.clone();
    }
    let BasinExplorer { scene, .. } = explorer;
    let sensors = [scene.guess(&start(&explorer.values)), scene.truth()];
    // In steps of half a metre, so that a start beside the last one has the same axes.
    sweep_bounds(scene, &sensors, Some(&explorer.run.outcome.pose))
        .map(|[low, high]| Axis::hidden((2.0 * low).floor() / 2.0, (2.0 * high).ceil() / 2.0))
}

/// The pairs as threads, the warmest as long as a pair may be.
fn threads(pairs: &[Pair], reach: f64) -> Layer {
    let ends = |pair: &Pair| [pair.source, pair.target].map(|end| [end.x, end.y]);
    Layer::Threads {
        threads: pairs.iter().map(ends).collect(),
        reach,
    }
}

/// The result of the run as a ghost, and the path of the sensor and of some points to it.
fn preview(explorer: &BasinExplorer) -> Vec<Layer> {
    let trace = &explorer.run.trace;
    let source = explorer.scene.source();
    let end = explorer.run.outcome.pose;
    let way = |of: Point2<f64>| {
        let spots = trace.iter().map(move |state| state.pose.transform(of));
        spots.map(|spot| [spot.x, spot.y]).collect::<Vec<_>>()
    };
    let sensor = Point2::new(0.0, 0.0);
    let some = source.iter().step_by(POINTS_PER_TRAIL);
    let trails = some
        .chain(core::iter::once(sensor))
        .map(|of| Layer::line(way(of), Stroke::Dotted, Tone::Posterior, 1.25));
    let ghost = points(
        &source.transformed(&end),
        Mark::Circle,
        Tone::Posterior,
        1.6,
    );
    trails
        .chain([
            Layer::points(way(sensor), Mark::Dot, Tone::Posterior, 2.0),
            ghost,
            self::sensor(end, Mark::Circle, Tone::Posterior),
        ])
        .collect()
}

/// The points without a partner.
fn lonely(source: &PointCloud, pairs: &[Pair]) -> Vec<[f64; 2]> {
    let mut has_pair = vec![false; source.len()];
    for pair in pairs {
        has_pair[pair.source_index] = true;
    }
    let alone = source.iter().zip(has_pair).filter(|(_, paired)| !paired);
    alone.map(|(point, _)| [point.x, point.y]).collect()
}

/// The points of a cloud.
fn points(cloud: &PointCloud, mark: Mark, tone: Tone, radius_px: f32) -> Layer {
    Layer::Points {
        points: positions(cloud),
        mark,
        tone,
        radius_px,
    }
}

fn positions(cloud: &PointCloud) -> Vec<[f64; 2]> {
    cloud.iter().map(|point| [point.x, point.y]).collect()
}

/// Pose of a sensor.
fn sensor(pose: SE2, mark: Mark, tone: Tone) -> Layer {
    Layer::Pose {
        pose: pose.to_array(),
        mark,
        tone,
        radius_px: SENSOR_PX,
    }
}

fn basin(explorer: &BasinExplorer, id: &'static str, of: IcpVariant) -> Panel {
    let chosen = of == variant(&explorer.values);
    let (name, other) = match axis(&explorer.values) {
        OffsetAxis::Dx => ("Δx", format!("Δy {:.2} m", start(&explorer.values).dy_m)),
        OffsetAxis::Dy => ("Δy", format!("Δx {:.2} m", start(&explorer.values).dx_m)),
    };
    let mut layers = Vec::new();
    let covered = explorer.values.get(&EDGE) == Phase::Marking;
    if !covered {
        layers.push(Layer::Raster(explorer.basins.raster(of)));
        layers.extend(tries(explorer, of));
        layers.extend(letters(explorer, of));
    }
    layers.extend(edge::layers(explorer, of));
    let spot = spot_of(&explorer.values);
    // While the maps are covered the reader marks the edge instead of choosing a start.
    if chosen && !covered {
        layers.extend(paths(explorer));
        layers.push(Layer::Handle {
            at: spot,
            tone: Tone::Prior,
            label: "the current start; press anywhere to start there",
        });
    } else if !covered {
        layers.push(Layer::Points {
            points: vec![spot],
            mark: Mark::Plus,
            tone: Tone::Ink,
            radius_px: 7.0,
        });
    }
    // The right minimum is named in the map.
    let minima = Minimum::at_place(explorer.scene.place()).into_iter();
    let minima =
        minima.filter(|minimum| *minimum != Minimum::Right && in_the_map(*minimum) == *minimum);
    let legend = minima.filter(|_| !covered).map(|minimum| LegendEntry {
        label: format!("{} {}", minimum.letter(), short(minimum)),
        tone: Tone::Class(class(minimum)),
        mark: None,
        stroke: None,
    });
    let title = if covered {
        format!("Where is the {} edge?", variant_name(of))
    } else {
        match explorer.mapped_by(of) {
            Some(yours) => format!("Where your {yours} ends"),
            None => format!("Where {} ends", variant_name(of)),
        }
    };
    Panel {
        id,
        title,
        weight: Weight::Half,
        aspect: Aspect::Free,
        x: Axis::new(
            "first guess off by (°)",
            -180.0 - BASIN_ROOM[0],
            180.0 + BASIN_ROOM[0],
        ),
        y: Axis::new(
            &format!("{name} (m), at {other}"),
            -OFFSET_SPAN_M - BASIN_ROOM[1],
            OFFSET_SPAN_M + BASIN_ROOM[1],
        ),
        layers,
        legend: legend.collect(),
        color_bar: None,
    }
}

/// The reader's own starts over the map of a variant, each in the colour of its end.
fn tries(explorer: &BasinExplorer, of: IcpVariant) -> Vec<Layer> {
    let tries = explorer.basins.tries(of);
    let marks = tries.map(|(at, minimum)| {
        let mark = |tone, radius_px| Layer::points(vec![at], Mark::Dot, tone, radius_px);
        [mark(Tone::Ink, 5.0), mark(Tone::Class(class(minimum)), 3.5)]
    });
    marks.flatten().collect()
}

/// The letters of the minima over the map of a variant.
fn letters(explorer: &BasinExplorer, of: IcpVariant) -> impl Iterator<Item = Layer> {
    let letters = explorer.basins.letters(of, &explorer.values);
    letters.into_iter().map(|(at, minimum)| Layer::Text {
        at,
        text: match in_the_map(minimum) {
            Minimum::Right => "right".to_owned(),
            other => other.letter().to_string(),
        },
        tone: Tone::Class(class(minimum)),
    })
}

/// The paths from other starts over the map, each with a dot at its end, and that of the current start if its
/// result may be shown.
fn paths(explorer: &BasinExplorer) -> Vec<Layer> {
    let line =
        |points: Vec<[f64; 2]>, tone, width_px| Layer::line(points, Stroke::Solid, tone, width_px);
    let mut layers = Vec::new();
    let is_yours = explorer.mapped_by(variant(&explorer.values)).is_some();
    for path in explorer.paths.done().iter().filter(|_| !is_yours) {
        let end = path.spots.last().copied().into_iter().collect();
        layers.push(line(path.spots.clone(), Tone::Ink, 1.0));
        layers.push(Layer::points(end, Mark::Dot, Tone::Ink, 2.5));
    }
    let seen = if explorer.previews_end() {
        explorer.run.trace.len()
    } else {
        explorer.iteration() + 1
    };
    let along_y = axis(&explorer.values) == OffsetAxis::Dy;
    let own = explorer.run.trace[..seen].iter();
    let own = own.map(|state| start_spot(&explorer.scene.start_of(&state.pose), along_y));
    let own = split_at_half_turn(own);
    let end = own.last().copied().into_iter().collect();
    layers.push(line(own, Tone::Posterior, 2.0));
    layers.push(Layer::points(end, Mark::Square, Tone::Posterior, 4.0));
    layers
}

/// The name of a minimum in a legend, which is narrow.
fn short(minimum: Minimum) -> &'static str {
    match minimum {
        Minimum::NotConverged => "not converged",
        other => other.name(),
    }
}
