//! A loop of known work that says how fast the machine is just now.
//!
//! The medians of a shared machine say as much of its other work as of this code. So each run
//! measures, before, amid and after the workloads, a loop that nobody will ever make faster: integers,
//! square roots and look-ups in 64 kB, each step waiting for the one before.

use ch16_slam2d::digest::Digest;
use pr_geom::math;
use pr_sim::Rng;

use crate::{Run, Workload, prepared};

/// Steps of one run.
const STEPS: u32 = 100_000;

/// What one step takes on the quiet machine on which the limits were set, in milliseconds: the
/// fastest sample of many.
pub const REFERENCE_MS: f64 = 9.3e-6;

/// A machine is quiet up to this multiple of the reference.
pub const QUIET: f64 = 1.15;

/// Name of the loop where it stands among the workloads.
pub const ID: &str = "calibration";

/// Entries of the table: 64 kB of `f64`.
const ENTRIES: usize = 8192;

/// The loop, one step a repetition.
#[must_use]
pub fn workload() -> Workload {
    Workload {
        id: ID,
        what: "a step of the calibration loop",
        repetitions: STEPS,
        limit: None,
        prepare,
    }
}

fn prepare() -> Box<dyn Run> {
    prepared(
        vec![1.0; ENTRIES],
        work,
        |entries: &Vec<f64>, digest: &mut Digest| {
            digest.add_all(entries);
        },
    )
}

fn work(entries: &mut Vec<f64>) {
    entries.fill(1.0);
    let mut rng = Rng::new(1);
    let mut carried = 1.0;
    for _ in 0..STEPS {
        let entry = &mut entries[(rng.unit() * ENTRIES as f64) as usize % ENTRIES];
        carried = math::sqrt(0.5 * (*entry + carried) + rng.unit());
        *entry = carried;
    }
}

/// How many times the reference the slowest of some medians (ms) took; none of none.
#[must_use]
pub fn slowdown(medians_ms: impl IntoIterator<Item = f64>) -> Option<f64> {
    medians_ms
        .into_iter()
        .map(|median_ms| median_ms / REFERENCE_MS)
        .reduce(f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_slowest_look_at_the_machine_counts() {
        let slowdown = slowdown([REFERENCE_MS, 1.5 * REFERENCE_MS]);
        assert!((slowdown.unwrap() - 1.5).abs() < 1e-12);
        assert_eq!(super::slowdown([]), None);
    }
}
