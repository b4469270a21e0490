//! The measurements of `tests/bench/measure.mjs`.

use std::fs;
use std::path::Path;

use serde::Deserialize;
use serde::de::DeserializeOwned;

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

/// The turns of one workload in one engine, one per round.
#[derive(Deserialize)]
pub struct Turns {
    ms: Vec<f64>,
    digest: String,
}

impl Turns {
    /// The median over the rounds of the fastest sample of each, ms.
    pub fn median_ms(&self) -> f64 {
        median(self.ms.iter().copied())
    }

    /// The median over the rounds of the ratio of this time to the other.
    pub fn ratio_to(&self, other: &Self) -> f64 {
        median(self.ms.iter().zip(&other.ms).map(|(a, b)| a / b))
    }
}

impl Entry {
    /// Whether all engines computed the same result.
    pub fn has_same_bits(&self) -> bool {
        let engines = [&self.node, &self.chromium];
        engines
            .iter()
            .all(|turns| turns.digest == self.native.digest)
    }
}

impl Measured {
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
}

/// The median of some values; NaN without values.
pub fn median(values: impl Iterator<Item = f64>) -> f64 {
    let mut sorted: Vec<f64> = values.collect();
    sorted.sort_by(f64::total_cmp);
    sorted.get(sorted.len() / 2).copied().unwrap_or(f64::NAN)
}

/// Reads a JSON file.
///
/// # Errors
/// One sentence with the file.
pub fn read<T: DeserializeOwned>(path: &Path) -> Result<T, String> {
    let say = |error: &dyn std::fmt::Display| format!("{}: {error}", path.display());
    let text = fs::read_to_string(path).map_err(|error| say(&error))?;
    serde_json::from_str(&text).map_err(|error| say(&error))
}

#[cfg(test)]
pub mod tests {
    use super::*;

    /// A workload's turns, equal in all of three rounds.
    pub fn entry(id: &str, [native, node, chromium]: [f64; 3], digests: [&str; 3]) -> Entry {
        let turns = |ms: f64, digest: &str| Turns {
            ms: vec![ms; 3],
            digest: digest.to_owned(),
        };
        Entry {
            id: id.to_owned(),
            native: turns(native, digests[0]),
            node: turns(node, digests[1]),
            chromium: turns(chromium, digests[2]),
        }
    }

    /// The turns of some workloads.
    pub fn measured(entries: Vec<Entry>) -> Measured {
        Measured { entries }
    }

    #[test]
    fn a_ratio_compares_the_turns_of_each_round() {
        let turns = |ms: [f64; 3]| Turns {
            ms: ms.to_vec(),
            digest: String::new(),
        };
        // The second round had background load; in the third round only one of the two turns had it.
        let (ours, native) = (turns([3.0, 9.0, 4.0]), turns([2.0, 6.0, 2.0]));
        assert_eq!(ours.ratio_to(&native), 1.5);
        assert_eq!(ours.median_ms(), 4.0);
    }
}
