//! The time series of a run: one sample per tick.

use ch16_lab::lap::{LapRecord, TickReport};

/// The samples of a run; entry 0 is the start.
pub struct History {
    /// The correspondence threshold τ, m.
    pub tau_m: Vec<f64>,
    /// Position error of dead reckoning, m.
    pub odometry_error_m: Vec<f64>,
    /// Position error of the estimate, m.
    pub estimate_error_m: Vec<f64>,
    /// Map self-disagreement, m; NaN before the return path.
    pub disagreement_m: Vec<f64>,
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
            tau_m: samples(record.config.slam.chapter.threshold.initial_m, &|r| {
                r.registration.tau_m
            }),
            odometry_error_m: samples(0.0, &|r| r.metrics.odometry_error_m),
            estimate_error_m: samples(0.0, &|r| r.metrics.estimate_error_m),
            disagreement_m: samples(f64::NAN, &|r| {
                r.metrics.map_disagreement_m.unwrap_or(f64::NAN)
            }),
        }
    }
}
