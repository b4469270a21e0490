//! The chart over the iterations: what the robot sees, and how far it is from the truth.

use widget_kit::chart::{Series, TimeChart};
use widget_kit::scene::{Layer, Mark, Panel, Stroke, Tone};

use super::texts::error_m;
use super::{BasinExplorer, panel};

/// The chart.
pub fn curve(explorer: &BasinExplorer) -> Panel {
    let trace = &explorer.run.trace;
    let truth = explorer.scene.truth();
    let rmse: Vec<f64> = trace.iter().map(|state| state.rmse_m).collect();
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

/// Draws the truth with dashes.
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
