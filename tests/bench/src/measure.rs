//! Measures workloads in turns, with the clock as an argument.
//!
//! Turns of another build or engine come in between. Background load of the machine then affects all of them
//! alike, so the ratio of two turns in one round is more reliable than that of two medians from different
//! minutes.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;

use serde::Serialize;

use crate::{Run, Workload, workloads};

/// Shortest duration of a sample: the clock of an isolated page has a resolution of 5 µs.
const SAMPLE_MS: f64 = 2.0;

/// Smallest number of samples per turn.
const MIN_SAMPLES: u32 = 3;

/// The result of one turn.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Turn {
    /// Milliseconds of one repetition, in the fastest sample of the turn.
    pub ms: f64,
    /// Digest of the first run, in hexadecimal.
    pub digest: String,
}

/// The workloads measured so far, each prepared once.
#[derive(Default)]
pub struct PreparedWorkloads {
    ready: BTreeMap<String, Ready>,
}

struct Ready {
    run: Box<dyn Run>,
    repetitions: u32,
    digest: String,
    /// Number of runs per sample.
    runs: u32,
}

impl PreparedWorkloads {
    /// Runs a workload for about `budget_ms`; `now_ms` is the clock.
    ///
    /// # Errors
    /// One sentence if there is no workload of that name.
    pub fn take(
        &mut self,
        id: &str,
        budget_ms: f64,
        now_ms: &dyn Fn() -> f64,
    ) -> Result<Turn, String> {
        let ready = match self.ready.entry(id.to_owned()) {
            Entry::Occupied(entry) => entry.into_mut(),
            Entry::Vacant(entry) => entry.insert(Ready::new(&find(id)?)),
        };
        Ok(ready.turn(budget_ms, now_ms))
    }
}

/// The names of all workloads.
#[must_use]
pub fn names() -> Vec<&'static str> {
    workloads().iter().map(|workload| workload.id).collect()
}

/// Looks up a workload by name.
///
/// # Errors
/// One sentence if there is none.
pub fn find(id: &str) -> Result<Workload, String> {
    workloads()
        .into_iter()
        .find(|workload| workload.id == id)
        .ok_or_else(|| format!("there is no workload `{id}`"))
}

impl Ready {
    fn new(workload: &Workload) -> Self {
        let mut run = (workload.prepare)();
        run.once();
        let digest = format!("{:016x}", run.digest());
        Self {
            run,
            repetitions: workload.repetitions,
            digest,
            runs: 1,
        }
    }

    fn turn(&mut self, budget_ms: f64, now_ms: &dyn Fn() -> f64) -> Turn {
        let started = now_ms();
        let mut fastest_ms = f64::INFINITY;
        let mut samples = 0;
        while samples < MIN_SAMPLES || now_ms() - started < budget_ms {
            let sample_ms = self.sample(now_ms);
            if sample_ms < SAMPLE_MS {
                self.runs *= 2;
                (fastest_ms, samples) = (f64::INFINITY, 0);
                continue;
            }
            fastest_ms = fastest_ms.min(sample_ms);
            samples += 1;
        }
        let repetitions = f64::from(self.runs) * f64::from(self.repetitions);
        Turn {
            ms: fastest_ms / repetitions,
            digest: self.digest.clone(),
        }
    }

    fn sample(&mut self, now_ms: &dyn Fn() -> f64) -> f64 {
        let start = now_ms();
        for _ in 0..self.runs {
            self.run.once();
        }
        now_ms() - start
    }
}

#[cfg(test)]
mod tests {
    use std::cell::Cell;

    use ch16_slam2d::digest::Digest;

    use super::*;
    use crate::prepared;

    #[test]
    fn a_turn_gives_the_time_of_one_repetition_in_its_fastest_sample() {
        // Every reading of the clock advances it by 20 ms, except the one that ends the first sample, by 12.
        let looks = Cell::new(0);
        let clock = Cell::new(0.0);
        let now = || {
            looks.set(looks.get() + 1);
            clock.set(clock.get() + if looks.get() == 3 { 12.0 } else { 20.0 });
            clock.get()
        };
        let mut ready = Ready::new(&Workload {
            id: "nothing",
            what: "nothing",
            repetitions: 4,
            limit: None,
            most_of_native: None,
            prepare: || prepared((), |()| {}, |(), digest| digest.add_bits(7)),
        });
        let turn = ready.turn(100.0, &now);
        assert_eq!(turn.ms, 12.0 / 4.0);
        let mut digest = Digest::new();
        digest.add_bits(7);
        assert_eq!(turn.digest, format!("{:016x}", digest.value()));
    }

    #[test]
    fn a_run_too_short_for_the_clock_is_repeated_within_a_sample() {
        thread_local!(static CLOCK: Cell<f64> = const { Cell::new(0.0) });
        let mut ready = Ready::new(&Workload {
            id: "short",
            what: "a quarter of a millisecond",
            repetitions: 1,
            limit: None,
            most_of_native: None,
            prepare: || {
                let work = |(): &mut ()| CLOCK.set(CLOCK.get() + 0.25);
                prepared((), work, |(), digest| digest.add_bits(7))
            },
        });
        let turn = ready.turn(10.0, &|| CLOCK.get());
        assert_eq!((turn.ms, ready.runs), (0.25, 8));
    }

    #[test]
    fn an_unknown_workload_is_reported() {
        let error = PreparedWorkloads::default().take("nothing", 1.0, &|| 0.0);
        assert_eq!(error, Err("there is no workload `nothing`".to_owned()));
    }
}
