//! The plots over time: the correspondence threshold and the errors.

use widget_kit::chart::{Series, TimeChart};
use widget_kit::scene::{Layer, Mark, Panel, Tone};

use crate::w16_4_control_room::model::history::History;

/// The panels whose horizontal axis is the time.
pub const OVER_TIME: [&str; 2] = ["tau", "errors"];

/// The correspondence threshold over time.
pub fn threshold(history: &History, now: usize) -> Panel {
    let series = Series {
        label: "τ of each registration",
        values: &history.tau_m,
        tone: Tone::Ink,
        mark: Mark::Dot,
    };
    let chart = chart(history, "tau", "Correspondence threshold τ", "τ (m)", now);
    played(chart.panel(&[series]), now)
}

/// The errors over time.
pub fn errors(history: &History, now: usize) -> Panel {
    let series = [
        Series {
            label: "odometry",
            values: &history.odometry_error_m,
            tone: Tone::Prediction,
            mark: Mark::Triangle,
        },
        Series {
            label: "estimate",
            values: &history.estimate_error_m,
            tone: Tone::Posterior,
            mark: Mark::Square,
        },
    ];
    let chart = chart(history, "errors", "Position error", "error (m)", now);
    played(chart.panel(&series), now)
}

/// Without the future; the axes are those of the whole run and do not change during playback.
fn played(mut panel: Panel, now: usize) -> Panel {
    for layer in &mut panel.layers {
        if let Layer::Line { points, .. } = layer {
            points.retain(|[tick, _]| *tick <= now as f64);
        }
    }
    panel
}

fn chart<'a>(
    history: &History,
    id: &'static str,
    title: &'a str,
    y_label: &'a str,
    now: usize,
) -> TimeChart<'a> {
    TimeChart {
        id,
        title,
        x_label: "tick",
        last: history.tau_m.len() - 1,
        y_label,
        now,
    }
}
