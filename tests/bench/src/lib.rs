//! The workloads that `docs/performance.md` reports, each defined once.
//!
//! The same list runs natively (the binary of this crate), as WebAssembly in a browser (the
//! exports below) and under an instruction counter. Every workload returns a digest of what it
//! computed: so nothing is optimized away, and both builds can be seen to compute the same.

pub mod chapter;
pub mod frames;
pub mod measure;

/// One workload.
pub struct Workload {
    /// Name on the command line: `lap`.
    pub id: &'static str,
    /// What one run does.
    pub what: &'static str,
    /// How many times a run does it: a figure is divided by this.
    pub repetitions: u32,
    /// The most that it may take, where the project has set itself a limit.
    pub limit: Option<Limit>,
    /// Prepares it; the closure is one run and returns its digest.
    pub prepare: fn() -> Run,
}

/// One run of a workload, prepared.
pub type Run = Box<dyn FnMut() -> u64>;

/// The most that one repetition of a workload may take, in milliseconds.
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

/// Mixes a number into a digest (FNV-1a over its eight bytes).
#[must_use]
pub fn mix(digest: u64, bits: u64) -> u64 {
    bits.to_le_bytes().iter().fold(digest, |digest, byte| {
        (digest ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3)
    })
}

/// The digest of some numbers, by their bits.
#[must_use]
pub fn digest(values: impl IntoIterator<Item = f64>) -> u64 {
    const OFFSET: u64 = 0xcbf2_9ce4_8422_2325;
    let bits = values.into_iter().map(f64::to_bits);
    bits.fold(OFFSET, mix)
}

#[cfg(target_arch = "wasm32")]
mod browser {
    use wasm_bindgen::prelude::wasm_bindgen;

    #[wasm_bindgen]
    extern "C" {
        #[wasm_bindgen(js_namespace = performance)]
        fn now() -> f64;
    }

    /// Measures every workload; the answer is the JSON that the native binary prints.
    #[wasm_bindgen]
    #[must_use]
    pub fn measure_all(seconds_each: f64) -> String {
        let measured: Vec<_> = crate::workloads()
            .iter()
            .map(|workload| crate::measure::measure(workload, 1e3 * seconds_each, &now))
            .collect();
        serde_json::to_string(&measured).unwrap_or_default()
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
            assert_eq!(first(), second(), "{} differs from run to run", workload.id);
        }
    }

    #[test]
    fn a_digest_depends_on_every_bit() {
        assert_ne!(digest([1.0, 2.0]), digest([2.0, 1.0]));
        assert_ne!(digest([0.0]), digest([-0.0]));
    }
}
