//! The workloads that `docs/performance.md` reports, each defined once.
//!
//! The same list runs natively (the binary of this crate), as WebAssembly in a browser (the exports below) and
//! under an instruction counter. Every workload keeps its result. This prevents the optimizer from removing it, and
//! a digest of the result, taken outside of the timing, shows whether two builds compute the same.

pub mod chapter;
pub mod frames;
pub mod measure;
mod scans;
mod search;

use ch16_slam2d::digest::Digest;

/// One workload.
pub struct Workload {
    /// Name on the command line: `lap`.
    pub id: &'static str,
    /// Description of one run.
    pub what: &'static str,
    /// Number of repetitions in a run, by which results are divided.
    pub repetitions: u32,
    /// The time limit, if the project has one for it.
    pub limit: Option<Limit>,
    /// The limit of the ratio of WebAssembly in Chromium to native time, if there is one.
    pub most_of_native: Option<f64>,
    /// Prepares it.
    pub prepare: fn() -> Box<dyn Run>,
}

/// A workload that is ready to run.
pub trait Run {
    /// Runs the work once and keeps its result.
    fn once(&mut self);

    /// The digest of the last run's complete result, bit by bit.
    fn digest(&self) -> u64;
}

/// A run that consists of a state, the work on it, and the result read from it.
struct Prepared<S> {
    state: S,
    work: fn(&mut S),
    result: fn(&S, &mut Digest),
}

impl<S> Run for Prepared<S> {
    fn once(&mut self) {
        (self.work)(&mut self.state);
    }

    fn digest(&self) -> u64 {
        let mut digest = Digest::new();
        (self.result)(&self.state, &mut digest);
        digest.value()
    }
}

/// Prepares a run: `work` changes the state, `result` reads it.
pub(crate) fn prepared<S: 'static>(
    state: S,
    work: fn(&mut S),
    result: fn(&S, &mut Digest),
) -> Box<dyn Run> {
    Box::new(Prepared {
        state,
        work,
        result,
    })
}

/// The time limit of one repetition of a workload, in milliseconds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limit {
    /// Natively.
    pub native_ms: f64,
    /// As WebAssembly in Chromium.
    pub wasm_ms: f64,
}

/// All workloads in the order of the report.
#[must_use]
pub fn workloads() -> Vec<Workload> {
    let mut all = chapter::workloads();
    all.extend(frames::workloads());
    all
}

#[cfg(target_arch = "wasm32")]
mod browser {
    use std::cell::RefCell;

    use wasm_bindgen::prelude::wasm_bindgen;

    use crate::measure::PreparedWorkloads;

    #[wasm_bindgen]
    extern "C" {
        #[wasm_bindgen(js_namespace = performance)]
        fn now() -> f64;
    }

    thread_local!(static TURNS: RefCell<PreparedWorkloads> = RefCell::default());

    /// Runs a workload for about `budget_ms`. Returns the JSON that the native binary prints.
    #[wasm_bindgen]
    pub fn turn(id: &str, budget_ms: f64) -> Result<String, String> {
        let turn = TURNS.with_borrow_mut(|turns| turns.take(id, budget_ms, &now))?;
        serde_json::to_string(&turn).map_err(|error| error.to_string())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_workload_has_its_own_name_and_runs_twice_alike() {
        let all = workloads();
        for (index, workload) in all.iter().enumerate() {
            let twins = all[..index].iter().filter(|other| other.id == workload.id);
            assert_eq!(twins.count(), 0, "{} stands twice", workload.id);
            let (mut first, mut second) = ((workload.prepare)(), (workload.prepare)());
            first.once();
            second.once();
            let digest = first.digest();
            assert_eq!(digest, second.digest(), "{} differs", workload.id);
            let nothing = Digest::new().value();
            assert_ne!(digest, nothing, "{} keeps nothing", workload.id);
        }
    }
}
