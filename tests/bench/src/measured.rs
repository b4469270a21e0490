//! What `tests/bench/measure.mjs` measured, and what it says of the machine and of the limits.

use std::fs;
use std::path::Path;

use serde::Deserialize;
use serde::de::DeserializeOwned;
use slam2d_bench::calibration::{ID, QUIET, REFERENCE_MS};
use slam2d_bench::{Workload, workloads};

use crate::report::time;

/// The turns of all workloads.
#[derive(Deserialize)]
#[serde(transparent)]
pub struct Measured {
    entries: Vec<Entry>,
}

/// The turns of one workload, by engine.
#[derive(Deserialize)]
pub struct Entry {
    /// Name of the workload.
    pub id: String,
    /// The native build.
    pub native: Turns,
    /// WebAssembly in Node.
    pub node: Turns,
    /// WebAssembly in Chromium.
    pub chromium: Turns,
}

/// The turns of one workload in one engine, one a round.
#[derive(Deserialize)]
pub struct Turns {
    ms: Vec<f64>,
    mean_ms: Vec<f64>,
    digest: String,
}

impl Turns {
    /// The median over the rounds of the fastest sample of each, ms.
    pub fn median_ms(&self) -> f64 {
        median(self.ms.iter().copied())
    }

    /// The median over the rounds of how many times the other's time this took.
    pub fn ratio_to(&self, other: &Self) -> f64 {
        median(self.ms.iter().zip(&other.ms).map(|(a, b)| a / b))
    }
}

impl Entry {
    /// Whether all engines computed the same.
    pub fn has_same_bits(&self) -> bool {
        let engines = [&self.node, &self.chromium];
        engines
            .iter()
            .all(|turns| turns.digest == self.native.digest)
    }
}

impl Measured {
    /// Reads what the script printed.
    ///
    /// # Errors
    /// One sentence that names the file that cannot be read.
    pub fn read(path: &Path) -> Result<Self, String> {
        read(path)
    }

    /// The turns of a workload.
    pub fn of(&self, id: &str) -> Option<&Entry> {
        self.entries.iter().find(|entry| entry.id == id)
    }

    /// Number of rounds.
    pub fn rounds(&self) -> usize {
        self.entries
            .first()
            .map_or(0, |entry| entry.native.ms.len())
    }

    /// How many times its reference the calibration loop took, in the median of the rounds.
    ///
    /// The mean of a turn counts, not its fastest sample: another program's time shows in it.
    fn slowdown(&self) -> f64 {
        let loops = self
            .of(ID)
            .map(|entry| median(entry.native.mean_ms.iter().copied()));
        loops.map_or(f64::INFINITY, |ms| ms / REFERENCE_MS)
    }

    fn is_quiet(&self) -> bool {
        self.slowdown() <= QUIET
    }

    /// What the calibration loop says of the machine.
    pub fn machine_words(&self) -> String {
        let verdict = if self.is_quiet() {
            "the machine was quiet"
        } else {
            "the machine was busy or is another one, so a figure in bold is beyond its limit and no error"
        };
        format!(
            "{} rounds. The calibration loop took {:.2} times its reference: {verdict}.",
            self.rounds(),
            self.slowdown()
        )
    }

    /// Fails where a row is beyond its limit on a quiet machine.
    ///
    /// # Errors
    /// A line for each such row.
    pub fn judge(&self) -> Result<(), String> {
        if !self.is_quiet() {
            return Ok(());
        }
        let complaints: Vec<String> = workloads()
            .iter()
            .filter_map(|workload| Some((workload, self.of(workload.id)?)))
            .flat_map(|(workload, entry)| complaints(workload, entry))
            .collect();
        if complaints.is_empty() {
            Ok(())
        } else {
            Err(complaints.join("\n"))
        }
    }
}

/// A line for each limit that a workload exceeds.
fn complaints(workload: &Workload, entry: &Entry) -> Vec<String> {
    let mut complaints = Vec::new();
    if let Some(limit) = workload.limit {
        let builds = [
            ("natively", entry.native.median_ms(), limit.native_ms),
            ("in Chromium", entry.chromium.median_ms(), limit.wasm_ms),
        ];
        for (build, ms, most) in builds.into_iter().filter(|(_, ms, most)| ms > most) {
            complaints.push(format!(
                "{}: {} {build}, and the limit is {}",
                workload.id,
                time(ms),
                time(most)
            ));
        }
    }
    let ratio = entry.chromium.ratio_to(&entry.native);
    if let Some(most) = workload.most_of_native.filter(|most| ratio > *most) {
        complaints.push(format!(
            "{}: {ratio:.2} times the native time in Chromium, and the limit is {most:.2}",
            workload.id
        ));
    }
    complaints
}

/// The middle one of some values; no number where there are none.
pub fn median(values: impl Iterator<Item = f64>) -> f64 {
    let mut sorted: Vec<f64> = values.collect();
    sorted.sort_by(f64::total_cmp);
    sorted.get(sorted.len() / 2).copied().unwrap_or(f64::NAN)
}

/// Reads a file of JSON.
///
/// # Errors
/// One sentence that names the file.
pub fn read<T: DeserializeOwned>(path: &Path) -> Result<T, String> {
    let say = |error: &dyn std::fmt::Display| format!("{}: {error}", path.display());
    let text = fs::read_to_string(path).map_err(|error| say(&error))?;
    serde_json::from_str(&text).map_err(|error| say(&error))
}

#[cfg(test)]
pub mod tests {
    use super::*;

    /// A workload's turns, the same in every one of three rounds.
    pub fn entry(id: &str, [native, node, chromium]: [f64; 3], digests: [&str; 3]) -> Entry {
        let turns = |ms: f64, digest: &str| Turns {
            ms: vec![ms; 3],
            mean_ms: vec![ms; 3],
            digest: digest.to_owned(),
        };
        Entry {
            id: id.to_owned(),
            native: turns(native, digests[0]),
            node: turns(node, digests[1]),
            chromium: turns(chromium, digests[2]),
        }
    }

    /// The turns of some workloads, on a machine this much slower than the reference.
    pub fn measured(slowdown: f64, mut entries: Vec<Entry>) -> Measured {
        let ms = slowdown * REFERENCE_MS;
        entries.insert(0, entry(ID, [ms; 3], [""; 3]));
        Measured { entries }
    }

    #[test]
    fn a_row_beyond_its_limit_fails_on_a_quiet_machine_only() {
        let slow_lap = || vec![entry("lap", [13.0, 13.0, 24.0], [""; 3])];
        let message = measured(1.0, slow_lap()).judge().unwrap_err();
        assert_eq!(
            message,
            "lap: 13.0 ms natively, and the limit is 12.0 ms\n\
             lap: 1.85 times the native time in Chromium, and the limit is 1.60"
        );
        let busy = measured(1.5, slow_lap());
        assert_eq!(busy.judge(), Ok(()));
        let words = busy.machine_words();
        assert!(
            words.starts_with(
                "3 rounds. The calibration loop took 1.50 times its reference: the machine was busy"
            ),
            "{words}"
        );
        let no_loop = Measured {
            entries: slow_lap(),
        };
        assert_eq!(no_loop.judge(), Ok(()));
        let fast = measured(1.0, vec![entry("lap", [11.0, 17.0, 17.0], [""; 3])]);
        assert_eq!(fast.judge(), Ok(()));
    }

    #[test]
    fn a_ratio_compares_the_turns_of_each_round() {
        let turns = |ms: [f64; 3]| Turns {
            ms: ms.to_vec(),
            mean_ms: ms.to_vec(),
            digest: String::new(),
        };
        // The second round met another program; the third only in one of the two turns.
        let (ours, native) = (turns([3.0, 9.0, 4.0]), turns([2.0, 6.0, 2.0]));
        assert_eq!(ours.ratio_to(&native), 1.5);
        assert_eq!(ours.median_ms(), 4.0);
    }
}
