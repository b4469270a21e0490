//! The plots over time: the correspondence threshold and the errors.

use kit::chart::{Series, TimeChart};
use kit::scene::{Mark, Panel, Tone};

use super::lanes;
use crate::model::history::History;

/// The panels whose horizontal axis is the time.
pub const OVER_TIME: [&str; 3] = [lanes::ID, "tau", "errors"];

/// The correspondence threshold over time.
pub fn threshold(history: &History, now: usize) -> Panel {
    let series = Series {
        label: "τ of each registration",
        values: &history.tau_m,
        tone: Tone::Ink,
        mark: Mark::Dot,
    };
    chart(history, "tau", "Correspondence threshold τ", "τ (m)", now).panel(&[series])
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
    chart(history, "errors", "Position error", "error (m)", now).panel(&series)
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
