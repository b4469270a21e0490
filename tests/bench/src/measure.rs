//! The median of many runs, with the clock as an argument.

use serde::Serialize;

use crate::{Workload, calibration, workloads};

/// A sample lasts at least this long: browsers round their clocks to a tenth of a millisecond.
const SAMPLE_MS: f64 = 8.0;

/// Fewest samples that a median is taken of.
const MIN_SAMPLES: usize = 5;

/// What was measured of one workload.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Measured {
    /// Name of the workload.
    pub id: &'static str,
    /// What one run does.
    pub what: &'static str,
    /// Median of one repetition, in milliseconds.
    pub median_ms: f64,
    /// The fastest sample, in milliseconds.
    pub least_ms: f64,
    /// Number of samples.
    pub samples: usize,
    /// Digest of the first run, in hexadecimal.
    pub digest: String,
}

/// Runs a workload for about `budget_ms` and returns its median; `now_ms` is the clock.
pub fn measure(workload: &Workload, budget_ms: f64, now_ms: &dyn Fn() -> f64) -> Measured {
    let mut run = (workload.prepare)();
    run.once();
    let digest = run.digest();
    let mut time = |runs: u32| {
        let start = now_ms();
        for _ in 0..runs {
            run.once();
        }
        now_ms() - start
    };
    let mut runs = 1;
    while time(runs) < SAMPLE_MS {
        runs *= 2;
    }
    let started = now_ms();
    let mut samples = Vec::new();
    while samples.len() < MIN_SAMPLES || now_ms() - started < budget_ms {
        samples.push(time(runs) / f64::from(runs) / f64::from(workload.repetitions));
    }
    samples.sort_by(f64::total_cmp);
    Measured {
        id: workload.id,
        what: workload.what,
        median_ms: samples[samples.len() / 2],
        least_ms: samples[0],
        samples: samples.len(),
        digest: format!("{digest:016x}"),
    }
}

/// Measures every workload, and before, amid and after them the calibration loop.
pub fn measure_all(budget_ms: f64, now_ms: &dyn Fn() -> f64) -> Vec<Measured> {
    let mut all = workloads();
    for place in [0, all.len() / 2 + 1, all.len() + 2] {
        all.insert(place, calibration::workload());
    }
    let measured = all.iter();
    measured
        .map(|workload| measure(workload, budget_ms, now_ms))
        .collect()
}

#[cfg(test)]
mod tests {
    use std::cell::Cell;

    use ch16_slam2d::digest::Digest;

    use super::*;
    use crate::prepared;

    #[test]
    fn the_median_is_that_of_one_repetition() {
        // A clock that every look moves by 20 ms: each sample lasts 20 ms.
        let clock = Cell::new(0.0);
        let now = || {
            clock.set(clock.get() + 20.0);
            clock.get()
        };
        let workload = Workload {
            id: "nothing",
            what: "nothing",
            repetitions: 4,
            limit: None,
            prepare: || prepared((), |()| {}, |(), digest| digest.add_bits(7)),
        };
        let measured = measure(&workload, 100.0, &now);
        assert_eq!(measured.median_ms, 5.0);
        assert!(measured.samples >= MIN_SAMPLES);
        let mut digest = Digest::new();
        digest.add_bits(7);
        assert_eq!(measured.digest, format!("{:016x}", digest.value()));
    }
}
