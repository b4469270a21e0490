//! The plots over time: errors, map disagreement, and the χ² of each attempt with the gate.

use ch16_lab::lap::LoopAttempt;
use kit::chart::{Series, TimeChart, axis_from_zero};
use kit::scene::{Aspect, Layer, LegendEntry, Mark, Panel, Stroke, Tone, Weight};

use crate::model::runs::Runs;
use crate::model::words::ends;

/// The panels whose horizontal axis is the time.
pub const OVER_TIME: [&str; 3] = ["errors", "disagreement", "gate"];

/// Ticks beyond the last one on the time axis: a mark at the end is shown whole.
const ROOM_TICKS: f64 = 5.0;

/// The χ² axis ends at this many gates: what is far outside is drawn at its edge.
const GATES_SHOWN: f64 = 3.0;

/// Position error over time of the three estimates.
pub fn errors(runs: &Runs, tick: usize) -> Panel {
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
    with_room_at_the_end(chart(runs, tick, "errors", title, "error (m)").panel(&series))
}

/// Distance between the map of the way out and that of the way back, over time.
pub fn disagreement(runs: &Runs, tick: usize) -> Panel {
    let series = [
        front_end(&runs.front_end.disagreement_m),
        graph(&runs.graph.disagreement_m),
    ];
    let title = "Map disagreement over time";
    let chart = chart(runs, tick, "disagreement", title, "rms distance (m)");
    with_room_at_the_end(chart.panel(&series))
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

/// χ² of each attempt with the gate: an accepted loop became part of the belief (■), a rejected one
/// stays a measurement (×).
pub fn gate(runs: &Runs, tick: usize) -> Panel {
    let attempts = runs.graph.attempts();
    let gate = runs.gate_chi2();
    let highest = attempts
        .iter()
        .map(|a| a.verification.gate.chi2)
        .fold(gate, f64::max)
        .min(GATES_SHOWN * gate);
    let chart = chart(runs, tick, "gate", "χ² of each loop tried", "χ²");
    let y = axis_from_zero(chart.y_label, highest);
    let of = |accepted: bool| {
        let chosen = attempts.iter().filter(move |a| a.accepted() == accepted);
        chosen
            .map(|a| [a.tick as f64, a.verification.gate.chi2.min(y.max)])
            .collect::<Vec<_>>()
    };
    let labels = attempts.iter().enumerate();
    let labels = labels.map(|(index, attempt)| label(index, attempt, runs.ticks(), y.max));
    let mut layers = vec![
        chart.now_line(y.max),
        Layer::Line {
            points: vec![[0.0, gate], [runs.ticks() as f64 + ROOM_TICKS, gate]],
            stroke: Stroke::Dotted,
            tone: Tone::Ink,
            width_px: 1.5,
        },
        Layer::points(of(true), Mark::Square, Tone::Posterior, 5.0),
        Layer::points(of(false), Mark::Cross, Tone::Measurement, 6.0),
    ];
    layers.extend(labels);
    with_room_at_the_end(Panel {
        id: chart.id,
        title: chart.title.to_owned(),
        weight: Weight::Side,
        aspect: Aspect::Free,
        x: chart.x_axis(),
        y,
        layers,
        legend: vec![
            LegendEntry::mark("accepted", Tone::Posterior, Mark::Square),
            LegendEntry::mark("rejected", Tone::Measurement, Mark::Cross),
            LegendEntry::line(&format!("gate {gate:.3}"), Tone::Ink, Stroke::Dotted),
        ],
        color_bar: None,
    })
}

/// `29 to 7` by turns above and below the marks, which may stand side by side; with the number
/// where the mark is at the edge.
fn label(index: usize, attempt: &LoopAttempt, last: usize, top: f64) -> Layer {
    let chi2 = attempt.verification.gate.chi2;
    let share = (chi2 / top).min(1.0);
    let above = share < 0.2 || (share < 0.8 && index.is_multiple_of(2));
    let away = if above { 0.11 } else { -0.11 };
    let text = if chi2 > top {
        format!("{}: {chi2:.0}", ends(attempt))
    } else {
        ends(attempt)
    };
    Layer::Text {
        // The words of a loop in the last ticks would leave the plot.
        at: [
            (attempt.tick as f64).min(last as f64 - ROOM_TICKS),
            (share + away) * top,
        ],
        text,
        tone: Tone::Ink,
    }
}

fn with_room_at_the_end(mut panel: Panel) -> Panel {
    panel.x.max += ROOM_TICKS;
    panel
}
