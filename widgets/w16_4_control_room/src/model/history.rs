//! The course of a run: one sample a tick, for plots and for export.

use ch16_lab::lap::{LapRecord, TickReport};
use kit::chart::{Series, TimeChart};
use kit::model::{Table, TablePlace};
use kit::scene::{Mark, Panel, Tone};

use super::log::Event;

/// The panels whose horizontal axis is the time.
pub const OVER_TIME: [&str; 2] = ["tau", "errors"];

/// Events that the table beside the picture shows.
const SHOWN_EVENTS: usize = 8;

/// The samples of a run; entry 0 is the start.
pub struct History {
    tau_m: Vec<f64>,
    odometry_error_m: Vec<f64>,
    estimate_error_m: Vec<f64>,
    disagreement_m: Vec<f64>,
}

impl History {
    /// The samples of a finished lap.
    pub fn new(record: &LapRecord) -> Self {
        let reports = &record.lap.reports;
        let samples = |first: f64, value: &dyn Fn(&TickReport) -> f64| {
            core::iter::once(first)
                .chain(reports.iter().map(value))
                .collect()
        };
        Self {
            tau_m: samples(record.config.slam.threshold.initial_m, &|r| {
                r.registration.tau_m
            }),
            odometry_error_m: samples(0.0, &|r| r.metrics.odometry_error_m),
            estimate_error_m: samples(0.0, &|r| r.metrics.estimate_error_m),
            disagreement_m: samples(f64::NAN, &|r| {
                r.metrics.map_disagreement_m.unwrap_or(f64::NAN)
            }),
        }
    }

    /// The correspondence threshold over time.
    pub fn threshold_plot(&self, now: usize) -> Panel {
        self.chart("tau", "Correspondence threshold τ", "τ (m)", now)
            .panel(&[Series {
                label: "τ of each registration",
                values: &self.tau_m,
                tone: Tone::Ink,
                mark: Mark::Dot,
            }])
    }

    /// The errors over time.
    pub fn error_plot(&self, now: usize) -> Panel {
        self.chart("errors", "Position error", "error (m)", now)
            .panel(&[
                Series {
                    label: "odometry",
                    values: &self.odometry_error_m,
                    tone: Tone::Prediction,
                    mark: Mark::Triangle,
                },
                Series {
                    label: "estimate",
                    values: &self.estimate_error_m,
                    tone: Tone::Posterior,
                    mark: Mark::Square,
                },
            ])
    }

    /// All samples, for the export.
    pub fn table(&self, reports: &[TickReport]) -> Table {
        let head = [
            "tick",
            "tau (m)",
            "pairs",
            "rmse (m)",
            "iterations",
            "odometry error (m)",
            "estimate error (m)",
            "map disagreement (m)",
        ];
        let rows = reports.iter().map(|report| {
            let matched = &report.registration.matched;
            let tick = report.tick;
            vec![
                tick.to_string(),
                self.tau_m[tick].to_string(),
                matched.inliers.to_string(),
                matched.rmse_m.to_string(),
                matched.iterations.to_string(),
                self.odometry_error_m[tick].to_string(),
                self.estimate_error_m[tick].to_string(),
                finite(self.disagreement_m[tick]),
            ]
        });
        Table {
            id: "control-room-over-time",
            title: "The run, tick by tick".to_owned(),
            columns: head.map(str::to_owned).to_vec(),
            rows: rows.collect(),
            place: TablePlace::ExportOnly,
        }
    }

    fn chart<'a>(
        &self,
        id: &'static str,
        title: &'a str,
        y_label: &'a str,
        now: usize,
    ) -> TimeChart<'a> {
        TimeChart {
            id,
            title,
            x_label: "tick",
            last: self.tau_m.len() - 1,
            y_label,
            now,
        }
    }
}

/// The newest events up to a tick, newest first.
pub fn event_table(events: &[Event], now: usize) -> Table {
    let past = &events[..events.partition_point(|event| event.tick <= now)];
    Table {
        id: "control-room-log",
        title: "Event log, newest first".to_owned(),
        columns: ["tick", "part", "event"].map(str::to_owned).to_vec(),
        rows: past.iter().rev().take(SHOWN_EVENTS).map(row).collect(),
        place: TablePlace::Shown,
    }
}

/// All events, for the export.
pub fn full_log(events: &[Event]) -> Table {
    Table {
        id: "control-room-events",
        title: "Event log".to_owned(),
        columns: ["tick", "part", "event"].map(str::to_owned).to_vec(),
        rows: events.iter().map(row).collect(),
        place: TablePlace::ExportOnly,
    }
}

fn row(event: &Event) -> Vec<String> {
    vec![
        event.tick.to_string(),
        event.part.to_owned(),
        event.text.clone(),
    ]
}

/// The number, or nothing where there is none.
fn finite(value: f64) -> String {
    if value.is_finite() {
        value.to_string()
    } else {
        String::new()
    }
}
