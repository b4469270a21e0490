//! The plots over time: errors, map disagreement, and the χ² of each attempt with the gate.

use ch16_lab::lap::RecordedLoopAttempt;
use widget_kit::chart::{Series, TimeChart, axis_from_zero};
use widget_kit::scene::{Aspect, Axis, Layer, LegendEntry, Mark, Panel, Stroke, Tone, Weight};

use super::loop_style::LoopStyle;
use crate::w16_2_full_lap::model::moment::LapState;
use crate::w16_2_full_lap::model::panel;
use crate::w16_2_full_lap::model::runs::Runs;
use crate::w16_2_full_lap::model::texts::ends;

/// The panels whose horizontal axis is the time.
pub const OVER_TIME: [&str; 3] = ["errors", "disagreement", panel::GATE];

/// Ticks beyond the last one on the time axis, so that a mark at the end is complete.
const ROOM_TICKS: f64 = 5.0;

/// Upper end of the χ² axis in multiples of the gate; larger values are drawn at the edge.
const GATES_SHOWN: f64 = 3.0;

/// Distance of text from its mark, in pixels.
const LABEL_CLEAR_PX: f32 = 8.0;

/// Position error over time of the three estimates.
pub fn errors(moment: &LapState) -> Panel {
    let (runs, tick) = (moment.runs, moment.tick);
    let odometry = Series {
        label: "odometry",
        values: &runs.odometry_errors_m,
        tone: Tone::Prediction,
        mark: Mark::Triangle,
    };
    let series = [
        odometry,
        front_end(&runs.front_end.errors_m),
        graph(&runs.graph.errors_m),
    ];
    let title = "Position error over time";
    let panel = chart(runs, tick, "errors", title, "error (m)").panel(&series);
    with_room_at_the_end(until(moment, panel))
}

/// Distance between the map of the outward path and that of the return path, over time.
pub fn disagreement(moment: &LapState) -> Panel {
    let (runs, tick) = (moment.runs, moment.tick);
    let series = [
        front_end(&runs.front_end.disagreement_m),
        graph(&runs.graph.disagreement_m),
    ];
    let title = "Map disagreement over time";
    let chart = chart(runs, tick, "disagreement", title, "rms distance (m)");
    with_room_at_the_end(until(moment, chart.panel(&series)))
}

/// A plot without the future; its axes do not change during playback.
fn until(moment: &LapState, mut panel: Panel) -> Panel {
    for layer in &mut panel.layers {
        if let Layer::Line { points, .. } = layer {
            points.retain(|point| point[0] <= moment.seen_until as f64);
        }
    }
    panel
}

fn front_end(values: &[f64]) -> Series<'_> {
    Series {
        label: "front end alone",
        values,
        tone: Tone::Prior,
        mark: Mark::Circle,
    }
}

fn graph(values: &[f64]) -> Series<'_> {
    Series {
        label: "pose graph",
        values,
        tone: Tone::Posterior,
        mark: Mark::Square,
    }
}

fn chart<'a>(
    runs: &Runs,
    tick: usize,
    id: &'static str,
    title: &'a str,
    y_label: &'a str,
) -> TimeChart<'a> {
    TimeChart {
        id,
        title,
        x_label: "tick",
        last: runs.ticks(),
        y_label,
        now: tick,
    }
}

/// χ² of each attempt so far with the gate: accepted ones are solid, rejected ones hollow.
pub fn gate(moment: &LapState) -> Panel {
    let (runs, tick) = (moment.runs, moment.tick);
    let attempts = runs.attempts_until(moment.seen_until);
    let gate = runs.gate_chi2();
    let chart = chart(runs, tick, panel::GATE, "χ² of each loop tried", "χ²");
    let y = gate_axis(moment);
    let of = |accepted: bool| {
        let chosen = attempts.iter().filter(move |a| a.accepted() == accepted);
        chosen
            .map(|a| [a.tick as f64, a.verification.gate.chi2.min(y.max)])
            .collect::<Vec<_>>()
    };
    let mut layers = vec![
        chart.now_line(y.max),
        Layer::line(
            vec![[0.0, gate], [runs.ticks() as f64 + ROOM_TICKS, gate]],
            Stroke::Dotted,
            Tone::Ink,
            1.5,
        ),
        look(&LoopStyle::ACCEPTED, of(true)),
        look(&LoopStyle::REJECTED, of(false)),
    ];
    layers.extend(labels(attempts, y.max));
    with_room_at_the_end(Panel {
        id: chart.id,
        title: chart.title.to_owned(),
        weight: Weight::Side,
        aspect: Aspect::Free,
        x: chart.x_axis(),
        y,
        layers,
        legend: vec![
            LegendEntry::mark(
                "accepted",
                LoopStyle::ACCEPTED.tone,
                LoopStyle::ACCEPTED.mark,
            ),
            LegendEntry::mark(
                "rejected",
                LoopStyle::REJECTED.tone,
                LoopStyle::REJECTED.mark,
            ),
            LegendEntry::line(&format!("gate {gate:.3}"), Tone::Ink, Stroke::Dotted),
        ],
        color_bar: None,
    })
}

fn look(look: &LoopStyle, at: Vec<[f64; 2]>) -> Layer {
    Layer::points(at, look.mark, look.tone, 5.5)
}

/// `29 to 7` near each mark, with the number if the mark is at the edge; left out if there is no space,
/// because the table has it.
fn labels(attempts: &[RecordedLoopAttempt], top: f64) -> impl Iterator<Item = Layer> + '_ {
    attempts.iter().map(move |attempt| {
        let chi2 = attempt.verification.gate.chi2;
        let text = if chi2 > top {
            format!("{}: {chi2:.0}", ends(attempt))
        } else {
            ends(attempt)
        };
        Layer::label([attempt.tick as f64, chi2.min(top)], text, LABEL_CLEAR_PX)
    })
}

/// Position of an attempt in the plot of the gate.
pub fn gate_mark(moment: &LapState, attempt: &RecordedLoopAttempt) -> [f64; 2] {
    let top = gate_axis(moment).max;
    [attempt.tick as f64, attempt.verification.gate.chi2.min(top)]
}

/// The χ² axis of the whole lap, which does not change during playback.
fn gate_axis(moment: &LapState) -> Axis {
    let gate = moment.runs.gate_chi2();
    let attempts = moment.runs.graph.attempts().iter();
    let highest = attempts
        .map(|attempt| attempt.verification.gate.chi2)
        .fold(gate, f64::max)
        .min(GATES_SHOWN * gate);
    axis_from_zero("χ²", highest)
}

fn with_room_at_the_end(mut panel: Panel) -> Panel {
    panel.x.max += ROOM_TICKS;
    panel
}
