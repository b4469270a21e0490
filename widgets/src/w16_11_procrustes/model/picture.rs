//! The panels: the points, the trace over the angle, and a map under both results.

use ch16_lab::procrustes::Handedness;
use pr_geom::{Point2, math};
use pr_sim::World;
use widget_kit::scene::{
    Aspect, Axis, Layer, LegendEntry, Mark, Panel, Scene, Stroke, Tone, Weight,
};

use super::texts::whole_degrees;
use super::{ProcrustesTrace, panel};
use crate::w16_11_procrustes::spec::{TURN, WHOLE_TURN_DEG};

/// Smallest half width of the view of the points, m.
const MIN_REACH_M: f64 = 1.8;
/// A pair of this length has the warmest thread, m.
const LONG_M: f64 = 1.5;
/// An R in one line, which shows whether it is mirrored, in halves of its height.
const LETTER: [[f64; 2]; 10] = [
    [-0.5, -1.0],
    [-0.5, 1.0],
    [0.15, 1.0],
    [0.5, 0.8],
    [0.6, 0.5],
    [0.5, 0.2],
    [0.15, 0.0],
    [-0.5, 0.0],
    [0.05, 0.0],
    [0.6, -1.0],
];
/// Half the height of the R, m.
const LETTER_M: f64 = 0.45;
/// Degrees between two points of a curve.
const CURVE_STEP_DEG: u32 = 4;

pub fn scene(trace: &ProcrustesTrace) -> Scene {
    let best = trace.problem.best(Handedness::Turn);
    let (kind, unchecked) = trace.problem.unchecked();
    let aligned = map(
        panel::MAP_TURN,
        "By svd_align",
        Handedness::Turn,
        best.theta_rad,
    );
    let mut unchecked = map(panel::MAP_UNCHECKED, "Unchecked", kind, unchecked.theta_rad);
    if trace.asks {
        unchecked.title = "Unchecked: det ?".to_owned();
        unchecked.layers = vec![Layer::Question("turn or mirror image?".to_owned())];
    }
    Scene {
        panels: vec![points(trace), curves(trace), aligned, unchecked],
    }
}

fn tone(kind: Handedness) -> Tone {
    match kind {
        Handedness::Turn => Tone::Posterior,
        Handedness::Mirror => Tone::Series(1),
    }
}

fn mark(kind: Handedness) -> Mark {
    match kind {
        Handedness::Turn => Mark::Square,
        Handedness::Mirror => Mark::Triangle,
    }
}

/// The R that is painted on the source, under a matrix.
fn letter(trace: &ProcrustesTrace, kind: Handedness, theta_rad: f64) -> Vec<[f64; 2]> {
    let middle = trace.problem.source_mean;
    let put = |[x, y]: [f64; 2]| {
        let at = Point2::new(middle.x + LETTER_M * x, middle.y + LETTER_M * y);
        let moved = trace.problem.moved(kind, theta_rad, at);
        [moved.x, moved.y]
    };
    LETTER.map(put).to_vec()
}

/// The best of all matrices, its R and its name at `above`, once the reader has acted and nothing turns any more.
fn winner(trace: &ProcrustesTrace, above: [f64; 2]) -> Vec<Layer> {
    if trace.asks || trace.playback.is_playing() {
        return Vec::new();
    }
    let (kind, best) = trace.problem.unchecked();
    let best = best.theta_rad;
    let source = trace.pairs.source.iter();
    let moved = source.map(|p| trace.problem.moved(kind, best, *p));
    let name = match kind {
        Handedness::Turn => "best fit: rotated",
        Handedness::Mirror => "best fit: mirrored",
    };
    vec![
        Layer::line(
            moved.map(|p| [p.x, p.y]).collect(),
            Stroke::Dashed,
            tone(kind),
            2.0,
        ),
        Layer::line(letter(trace, kind, best), Stroke::Solid, tone(kind), 4.0),
        Layer::label(above, name.to_owned(), 0.0),
    ]
}

fn points(trace: &ProcrustesTrace) -> Panel {
    let (problem, kind) = (&trace.problem, trace.tried());
    let moved: Vec<[f64; 2]> = (trace.pairs.source.iter())
        .map(|p| {
            let moved = problem.moved(kind, trace.theta_rad(), *p);
            [moved.x, moved.y]
        })
        .collect();
    let target: Vec<[f64; 2]> = trace.pairs.target.iter().map(|q| [q.x, q.y]).collect();
    // In steps of half a metre, so that a drag seldom moves the axes.
    let mean = problem.target_mean;
    let middle = [mean.x, mean.y].map(|value| (2.0 * value).round() / 2.0);
    let far = |at: &[f64; 2]| math::norm2(at[0] - middle[0], at[1] - middle[1]) + 0.4;
    let reach = (target.iter().chain(&moved).map(far)).fold(MIN_REACH_M, math::max);
    let reach = (2.0 * reach).ceil() / 2.0;
    let axis = |i: usize| Axis::hidden(middle[i] - reach, middle[i] + reach);
    let line = |points: &[[f64; 2]], stroke, tone, width_px| {
        Layer::line(points.to_vec(), stroke, tone, width_px)
    };
    let pairs = moved.iter().zip(&target).map(|(p, q)| [*p, *q]);
    let mut layers = vec![
        line(&target, Stroke::Dotted, Tone::Measurement, 1.5),
        Layer::Threads {
            threads: pairs.collect(),
            reach: LONG_M,
        },
    ];
    layers.push(line(
        &letter(trace, kind, trace.theta_rad()),
        Stroke::Solid,
        tone(kind),
        6.0,
    ));
    layers.extend(winner(trace, [middle[0], middle[1] + 0.95 * reach]));
    layers.extend([
        line(&moved, Stroke::Solid, tone(kind), 2.0),
        Layer::points(moved.clone(), mark(kind), tone(kind), 4.5),
    ]);
    layers.extend(target.iter().map(|at| Layer::Handle {
        at: *at,
        tone: Tone::Measurement,
        label: "drag the target point",
    }));
    Panel {
        id: panel::POINTS,
        title: String::new(),
        weight: Weight::Main,
        aspect: Aspect::Equal,
        x: axis(0),
        y: axis(1),
        layers,
        legend: vec![
            LegendEntry::mark("target, to be dragged", Tone::Measurement, Mark::Circle),
            match kind {
                Handedness::Turn => LegendEntry::mark("source, rotated", tone(kind), mark(kind)),
                Handedness::Mirror => {
                    LegendEntry::mark("source, mirrored and rotated", tone(kind), mark(kind))
                }
            },
        ],
        color_bar: None,
    }
}

fn curves(trace: &ProcrustesTrace) -> Panel {
    let problem = &trace.problem;
    let [first, second] = problem.singular_values_m2();
    let top = if first + second > 0.0 {
        1.15 * (first + second)
    } else {
        1.0
    };
    let level = |height: f64, stroke| {
        Layer::line(
            vec![[0.0, height], [WHOLE_TURN_DEG, height]],
            stroke,
            Tone::Ink,
            1.5,
        )
    };
    let turn = trace.values.get(&TURN);
    let mut layers = vec![Layer::line(
        vec![[turn, -top], [turn, top]],
        Stroke::Solid,
        Tone::Faint,
        2.5,
    )];
    if trace.asks {
        layers = vec![Layer::Question("whose wave is higher?".to_owned())];
    } else {
        layers.push(level(first + second, Stroke::Dotted));
        layers.push(level(first - second, Stroke::Dashed));
        for kind in Handedness::ALL {
            let at = |degrees: u32| {
                let degrees = f64::from(degrees);
                [degrees, problem.trace_m2(kind, degrees.to_radians())]
            };
            layers.push(Layer::line(
                (0..=WHOLE_TURN_DEG as u32)
                    .step_by(CURVE_STEP_DEG as usize)
                    .map(at)
                    .collect(),
                Stroke::Solid,
                tone(kind),
                if kind == trace.tried() { 2.5 } else { 1.25 },
            ));
            let best = problem.best(kind);
            let place = vec![[whole_degrees(best.theta_rad), best.trace_m2]];
            layers.push(Layer::points(place, mark(kind), tone(kind), 4.5));
        }
    }
    let here = problem.trace_m2(trace.tried(), trace.theta_rad());
    layers.push(Layer::Handle {
        at: [turn, here],
        tone: tone(trace.tried()),
        label: "drag the angle along the wave",
    });
    Panel {
        id: panel::TRACE,
        title: "The trace over the angle".to_owned(),
        weight: Weight::Half,
        aspect: Aspect::Free,
        // The handle is whole at either end.
        x: Axis::new("angle tried (°)", -10.0, WHOLE_TURN_DEG + 10.0),
        y: Axis::new("tr(M W) (m²)", -top, top),
        layers,
        legend: vec![
            LegendEntry::marked_line(
                "rotations",
                tone(Handedness::Turn),
                mark(Handedness::Turn),
                Stroke::Solid,
            ),
            LegendEntry::marked_line(
                "mirror images",
                tone(Handedness::Mirror),
                mark(Handedness::Mirror),
                Stroke::Solid,
            ),
            LegendEntry::line("s₁ + s₂", Tone::Ink, Stroke::Dotted),
            LegendEntry::line("s₁ − s₂", Tone::Ink, Stroke::Dashed),
        ],
        color_bar: None,
    }
}

/// The flat's walls under a matrix, about its middle.
fn map(id: &'static str, by: &str, kind: Handedness, theta_rad: f64) -> Panel {
    let world = World::apartment();
    let bounds = world.bounds();
    let middle = bounds.min + 0.5 * (bounds.max - bounds.min);
    let matrix = kind.matrix(theta_rad);
    let put = |p: Point2<f64>| {
        let moved = matrix * (p - middle);
        [moved.x, moved.y]
    };
    let walls = world.walls().iter();
    let mut layers = vec![Layer::segments(
        walls.map(|wall| [put(wall.start), put(wall.end)]).collect(),
        Stroke::Solid,
        tone(kind),
        1.75,
    )];
    layers.extend(World::apartment_rooms().map(|room| Layer::Text {
        at: put(room.bounds.min + 0.5 * (room.bounds.max - room.bounds.min)),
        text: room.name.to_owned(),
        tone: Tone::Ink,
    }));
    // Half of the flat's diagonal, whatever the angle.
    let half = 7.6;
    let how = match kind {
        Handedness::Turn => "det +1",
        Handedness::Mirror => "det −1",
    };
    Panel {
        id,
        title: format!("{by}: {how}"),
        weight: Weight::Half,
        aspect: Aspect::Equal,
        x: Axis::hidden(-half, half),
        y: Axis::hidden(-half, half),
        layers,
        legend: Vec::new(),
        color_bar: None,
    }
}
