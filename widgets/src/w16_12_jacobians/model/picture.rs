//! The panels: the graphs of all solvers, and the distance to the optimum over the steps.

use ch16_lab::jacobians::Iterate;
use pr_geom::{SE2, math};
use widget_kit::scene::{
    Aspect, Axis, Layer, LegendEntry, Mark, Panel, Scene, Stroke, Tone, Weight,
};

use super::texts::{SAME_END_M, ends_at_the_optimum};
use super::{NAMES, WrongJacobians, panel};

use crate::w16_12_jacobians::spec::{CURVE, Curve};

/// Tones and marks of the solvers.
const TONES: [Tone; 4] = [
    Tone::Series(0),
    Tone::Series(1),
    Tone::Series(2),
    Tone::Series(3),
];
const MARKS: [Mark; 4] = [Mark::Square, Mark::Circle, Mark::Triangle, Mark::Cross];
/// Margin around the poses, m.
const MARGIN_M: f64 = 0.4;
/// Height of the rows of names in the middle, m.
const ROW_M: f64 = 0.3;
/// The curves end at this power of ten: smaller values are rounding.
const LOWEST_POWER: f64 = -9.0;

pub fn scene(widget: &WrongJacobians) -> Scene {
    Scene {
        panels: vec![graphs(widget), curve(widget)],
    }
}

fn places(poses: &[SE2]) -> Vec<[f64; 2]> {
    poses.iter().map(|pose| [pose.x(), pose.y()]).collect()
}

/// Around the start and the optimum, the same for all four and constant during playback.
fn axes(widget: &WrongJacobians) -> [Axis; 2] {
    let start = &widget.solved.runs[0].iterates[0].poses;
    let poses = || start.iter().chain(&widget.solved.optimum);
    let span = |of: fn(&SE2) -> f64| {
        let low = poses().map(of).fold(f64::INFINITY, math::min) - MARGIN_M;
        let high = poses().map(of).fold(f64::NEG_INFINITY, math::max) + MARGIN_M;
        [low, high]
    };
    let spans = [span(SE2::x), span(SE2::y)];
    let half = 0.5
        * spans
            .iter()
            .map(|[low, high]| high - low)
            .fold(0.0, math::max);
    // In steps of half a metre, so that a slider seldom moves the axes.
    let axis = |[low, high]: [f64; 2]| {
        let middle = 0.5 * (low + high);
        Axis::hidden(
            (2.0 * (middle - half)).floor() / 2.0,
            (2.0 * (middle + half)).ceil() / 2.0,
        )
    };
    spans.map(axis)
}

/// The graphs of the four that differ, under the optimum.
fn graphs(widget: &WrongJacobians) -> Panel {
    let [x, y] = axes(widget);
    let line =
        |points: Vec<[f64; 2]>, stroke, tone, width_px| Layer::line(points, stroke, tone, width_px);
    let best = places(&widget.solved.optimum);
    let far = best[best.len() / 2];
    let start = places(&widget.shown(0).poses);
    let mut layers = Vec::new();
    let mut chain = |now: Vec<[f64; 2]>, tone, mark, [width_px, radius_px]: [f32; 2]| {
        layers.push(line(now.clone(), Stroke::Solid, tone, width_px));
        layers.push(Layer::points(now, mark, tone, radius_px));
    };
    let mut labels = Vec::new();
    if widget.step() == 0 {
        // One start, not four graphs over each other.
        chain(start, Tone::Ink, Mark::Square, [1.75, 4.0]);
    } else {
        for (solver, names) in apart(widget) {
            let now = places(&widget.shown(solver).poses);
            if !widget.is_over() {
                labels.push(Layer::label(now[now.len() - 1], names.join(", "), 10.0));
            }
            chain(now, TONES[solver], MARKS[solver], [4.0, 5.0]);
        }
    }
    // On top, or the chains that end there would hide it.
    layers.push(line(best, Stroke::Dotted, Tone::Ink, 2.0));
    if widget.is_over() {
        labels.extend(ends(widget));
    } else if widget.step() == 0 {
        labels.push(Layer::label(far, "optimum".to_owned(), 10.0));
    }
    layers.extend(labels);
    if let Some(at) = widget.loose_end() {
        layers.push(Layer::Handle {
            at,
            tone: Tone::Ink,
            label: "bend the chain: drag its loose end",
        });
        layers.push(Layer::label(at, "loose end".to_owned(), 14.0));
    }
    let title = match widget.step() {
        0 => "All four solvers start here".to_owned(),
        step => format!("Step {step} of {}", widget.last()),
    };
    Panel {
        id: panel::GRAPHS,
        title,
        weight: Weight::Main,
        aspect: Aspect::Equal,
        x,
        y,
        layers,
        // The names stand at the chains.
        legend: Vec::new(),
        color_bar: None,
    }
}

/// The chains that can be told apart, by their first solver, and the names of those whose poses are all within the
/// noise of an edge of it: over each other they would be one rope.
fn apart(widget: &WrongJacobians) -> Vec<(usize, Vec<&'static str>)> {
    let mut chains: Vec<(usize, Vec<&'static str>)> = Vec::new();
    for (solver, name) in NAMES.into_iter().enumerate() {
        let poses = &widget.shown(solver).poses;
        let same = chains.iter_mut().find(|(first, _)| {
            let mut pairs = poses.iter().zip(&widget.shown(*first).poses);
            pairs.all(|(a, b)| math::norm2(a.x() - b.x(), a.y() - b.y()) < SAME_END_M)
        });
        match same {
            Some((_, names)) => names.push(name),
            None => chains.push((solver, vec![name])),
        }
    }
    chains
}

/// Who ended at the optimum, and who elsewhere, each with its χ² and a line to its chain. The middle of the ring is free.
fn ends(widget: &WrongJacobians) -> Vec<Layer> {
    let optimum = places(&widget.solved.optimum);
    let middle =
        [0, 1].map(|axis| optimum.iter().map(|at| at[axis]).sum::<f64>() / optimum.len() as f64);
    let is_there = |solver: &usize| ends_at_the_optimum(widget, *solver);
    let (there, elsewhere): (Vec<_>, Vec<_>) = (0..NAMES.len()).partition(is_there);
    let least = widget.solved.least_chi2;
    let off_mm = there.iter().map(|solver| 1e3 * widget.shown(*solver).off_m);
    let within_mm = off_mm.fold(0.0, f64::max).ceil();
    let words = format!(
        "{} solvers within {within_mm} mm: χ² {least:.1}",
        there.len()
    );
    let tone = there.first().map_or(Tone::Ink, |solver| TONES[*solver]);
    let mut chains = vec![(optimum, tone, words)];
    for solver in elsewhere {
        let end = widget.shown(solver);
        let words = format!("{}: χ² {:.1}", NAMES[solver], end.chi2);
        chains.push((places(&end.poses), TONES[solver], words));
    }
    let named = |(row, (chain, tone, text)): (usize, (Vec<[f64; 2]>, Tone, String))| {
        let up = if row == 0 { -1.0 } else { 1.0 };
        let at = [middle[0], middle[1] + up * ROW_M * row.max(1) as f64];
        let end = chain
            .into_iter()
            .max_by(|a, b| (up * a[1]).total_cmp(&(up * b[1])));
        let from = [at[0], at[1] + up * 0.5 * ROW_M];
        let line = end.map(|end| Layer::segments(vec![[from, end]], Stroke::Solid, tone, 1.0));
        [line, Some(Layer::Text { at, text, tone })]
    };
    let layers = chains.into_iter().enumerate().flat_map(named);
    layers.flatten().collect()
}

/// Decades of the distance from the least one drawn, each with its unit.
fn decades() -> impl Iterator<Item = String> {
    let names = [
        "1 nm", "10 nm", "100 nm", "1 µm", "10 µm", "100 µm", "1 mm", "1 cm", "10 cm", "1 m",
    ];
    names.into_iter().map(str::to_owned)
}

/// Powers of ten over the steps: linear convergence is a straight line.
fn curve(widget: &WrongJacobians) -> Panel {
    let is_distance = widget.values.get(&CURVE) == Curve::Distance;
    let best_chi2 = widget.solved.least_chi2;
    let height = |value: f64| {
        // Zero and rounding are drawn at the lower end.
        let floor = math::exp(LOWEST_POWER * core::f64::consts::LN_10);
        let power = math::ln(math::max(value, floor)) / core::f64::consts::LN_10;
        // The names of the decades stand at 1, 2, … from the lowest.
        if is_distance {
            power - LOWEST_POWER + 1.0
        } else {
            power
        }
    };
    let of = |iterate: &Iterate| {
        height(if is_distance {
            iterate.off_m
        } else {
            iterate.chi2 - best_chi2
        })
    };
    let lines = widget.solved.runs.each_ref().map(|run| {
        let iterates = run.iterates.iter().enumerate();
        let points = iterates.map(|(step, iterate)| [step as f64, of(iterate)]);
        points.collect::<Vec<_>>()
    });
    let highest = lines.iter().flatten().map(|at| at[1]).fold(0.0, math::max);
    let y = if is_distance {
        Axis {
            max: highest.ceil().max(10.0) + 0.5,
            ..Axis::from_names("distance, a decade per line", decades())
        }
    } else {
        Axis::new(
            "power of ten of the excess χ²",
            LOWEST_POWER - 0.5,
            highest.ceil() + 0.5,
        )
    };
    let [low, top] = [y.min, y.max];
    let now = widget.step() as f64;
    let last = widget.last().max(1) as f64;
    let mut layers = vec![Layer::line(
        vec![[now, low], [now, top]],
        Stroke::Solid,
        Tone::Faint,
        2.5,
    )];
    if is_distance {
        let same = height(SAME_END_M);
        layers.push(Layer::line(
            vec![[0.0, same], [last, same]],
            Stroke::Dashed,
            Tone::Ink,
            1.25,
        ));
        // Curves would cross the words.
        if widget.step() == 0 {
            for (at, text) in [
                ([0.5 * last, same - 0.45], "noise of one edge"),
                ([0.5 * last, 0.5 * (low + same)], "play: which ends where?"),
            ] {
                layers.push(Layer::Text {
                    at,
                    text: text.to_owned(),
                    tone: Tone::Ink,
                });
            }
        }
    }
    for (solver, mut line) in lines.into_iter().enumerate() {
        // What is to come would give the answer away.
        line.truncate(widget.step() + 1);
        layers.push(Layer::points(
            line.clone(),
            MARKS[solver],
            TONES[solver],
            2.5,
        ));
        layers.push(Layer::line(line, Stroke::Solid, TONES[solver], 1.75));
    }
    let exact = &widget.solved.runs[0].iterates;
    let exact = exact.get(widget.step()).or(exact.last());
    layers.push(Layer::Handle {
        at: [now, exact.map_or(low, &of)],
        tone: Tone::Ink,
        label: "drag along the steps",
    });
    let title = if is_distance {
        "Distance to the optimum"
    } else {
        "χ² above the optimum"
    };
    Panel {
        id: panel::CURVE,
        title: title.to_owned(),
        weight: Weight::Half,
        aspect: Aspect::Free,
        // The handle is whole at the first step and at the last one.
        x: Axis::new("step", -0.05 * last, 1.05 * last),
        y,
        layers,
        legend: (0..NAMES.len())
            .map(|k| LegendEntry::marked_line(NAMES[k], TONES[k], MARKS[k], Stroke::Solid))
            .collect(),
        color_bar: None,
    }
}
