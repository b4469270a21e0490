//! A loop of known work that says how fast the machine is just now.
//!
//! The medians of a shared machine say as much of its other work as of this code. So each run
//! measures in every round, beside the workloads, a loop that nobody will ever make faster: eight
//! chains of integers, look-ups in 64 kB and sums. Eight keep the core's units busy, as the workloads
//! do: another thread on the same core shows, which a single chain would hardly notice.

use crate::{Run, Workload, prepared};

/// Steps of one run.
const STEPS: u32 = 50_000;

/// What one step takes on the quiet machine on which the limits were set, in milliseconds.
pub const REFERENCE_MS: f64 = 4.8e-6;

/// A machine is quiet up to this multiple of the reference.
pub const QUIET: f64 = 1.15;

/// Name of the loop where it stands among the workloads.
pub const ID: &str = "calibration";

/// Entries of the table: 64 kB of `f64`.
const ENTRIES: usize = 8192;

/// Chains that do not wait for each other.
const CHAINS: usize = 8;

/// The loop, one step of all chains a repetition.
#[must_use]
pub fn workload() -> Workload {
    Workload {
        id: ID,
        what: "a step of the calibration loop",
        repetitions: STEPS,
        limit: None,
        most_of_native: None,
        prepare,
    }
}

fn prepare() -> Box<dyn Run> {
    prepared(
        vec![1.0; ENTRIES],
        |entries| work(entries),
        |entries, digest| digest.add_all(entries),
    )
}

fn work(entries: &mut [f64]) {
    entries.fill(1.0);
    let mut states: [u32; CHAINS] = std::array::from_fn(|chain| chain as u32);
    let mut sums = [0.0; CHAINS];
    for _ in 0..STEPS {
        for (state, sum) in states.iter_mut().zip(&mut sums) {
            // The generator of Numerical Recipes: its upper bits are the better ones.
            *state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            let entry = &mut entries[(*state >> 19) as usize];
            *sum = 0.5 * (*sum + *entry);
            *entry = *sum;
        }
    }
}
