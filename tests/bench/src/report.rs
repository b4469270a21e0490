//! The table of the workloads, from what was measured and counted.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use serde::Deserialize;
use serde::de::DeserializeOwned;
use slam2d_bench::{Limit, Workload, workloads};

/// One entry of what `measure` prints.
#[derive(Deserialize)]
struct Entry {
    id: String,
    median_ms: f64,
    digest: String,
}

/// Everything that the table shows, read from files.
pub struct Figures {
    native: Vec<Entry>,
    wasm: Vec<Entry>,
    /// Instructions of one repetition, by workload; empty where nothing could be counted.
    instructions: BTreeMap<String, u64>,
}

impl Figures {
    /// Reads what `measure` printed natively and in the browser, and what `count` printed.
    ///
    /// # Errors
    /// One sentence that names the file that cannot be read.
    pub fn read(native: &Path, wasm: &Path, instructions: &Path) -> Result<Self, String> {
        Ok(Self {
            native: read(native)?,
            wasm: read(wasm)?,
            instructions: read(instructions)?,
        })
    }

    /// Whether instructions were counted at all.
    pub fn are_counted(&self) -> bool {
        !self.instructions.is_empty()
    }

    /// The table in Markdown, a row for each workload.
    pub fn table(&self) -> String {
        let mut lines = vec![
            "| workload | native | limit | wasm | limit | instructions, native | same bits |"
                .to_owned(),
            "|---|--:|--:|--:|--:|--:|---|".to_owned(),
        ];
        lines.extend(workloads().iter().map(|workload| self.row(workload)));
        lines.join("\n")
    }

    fn row(&self, workload: &Workload) -> String {
        let find = |entries: &'_ [Entry]| {
            let entry = entries.iter().find(|entry| entry.id == workload.id);
            entry.map(|entry| (entry.median_ms, entry.digest.clone()))
        };
        let (native, wasm) = (find(&self.native), find(&self.wasm));
        let same = match (&native, &wasm) {
            (Some((_, a)), Some((_, b))) if a == b => "yes",
            (Some(_), Some(_)) => "**no**",
            _ => NOTHING,
        };
        let limit = |of: fn(&Limit) -> f64| time(workload.limit.as_ref().map(of));
        format!(
            "| {} | {} | {} | {} | {} | {} | {same} |",
            workload.what,
            time(native.map(|(ms, _)| ms)),
            limit(|limit| limit.native_ms),
            time(wasm.map(|(ms, _)| ms)),
            limit(|limit| limit.wasm_ms),
            instructions(self.instructions.get(workload.id).copied()),
        )
    }
}

/// What stands where there is no figure.
const NOTHING: &str = "–";

/// Three digits, in a unit that suits.
fn time(milliseconds: Option<f64>) -> String {
    match milliseconds {
        None => NOTHING.to_owned(),
        Some(ms) if ms >= 1.0 => format!("{} ms", three_digits(ms)),
        Some(ms) if ms >= 1e-3 => format!("{} µs", three_digits(1e3 * ms)),
        Some(ms) => format!("{} ns", three_digits(1e6 * ms)),
    }
}

/// Three digits, in thousands or millions where that is shorter.
fn instructions(count: Option<u64>) -> String {
    match count.map(|count| count as f64) {
        None => NOTHING.to_owned(),
        Some(count) if count >= 1e6 => format!("{} M", three_digits(1e-6 * count)),
        Some(count) if count >= 1e3 => format!("{} k", three_digits(1e-3 * count)),
        Some(count) => format!("{count:.0}"),
    }
}

fn three_digits(value: f64) -> String {
    let decimals = match value {
        value if value >= 99.95 => 0,
        value if value >= 9.995 => 1,
        _ => 2,
    };
    format!("{value:.decimals$}")
}

fn read<T: DeserializeOwned>(path: &Path) -> Result<T, String> {
    let say = |error: &dyn std::fmt::Display| format!("{}: {error}", path.display());
    let text = fs::read_to_string(path).map_err(|error| say(&error))?;
    serde_json::from_str(&text).map_err(|error| say(&error))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_have_three_digits_and_a_unit_that_suits() {
        let shown = [12.345, 0.15, 90e-6, 0.999_96].map(|ms| time(Some(ms)));
        assert_eq!(shown, ["12.3 ms", "150 µs", "90.0 ns", "1000 µs"]);
        assert_eq!(time(None), "–");
    }

    #[test]
    fn counts_have_three_digits_and_a_unit_that_suits() {
        let shown = [783, 156_225, 1_083_078, 114_488_777].map(|n| instructions(Some(n)));
        assert_eq!(shown, ["783", "156 k", "1.08 M", "114 M"]);
        assert_eq!(instructions(None), "–");
    }

    #[test]
    fn a_row_shows_what_is_known_and_whether_the_digests_agree() {
        let entry = |id: &str, median_ms, digest: &str| Entry {
            id: id.to_owned(),
            median_ms,
            digest: digest.to_owned(),
        };
        let figures = Figures {
            native: vec![
                entry("lap", 10.2, "0a"),
                entry("nearest", 44e-6, "0b"),
                entry("grid", 0.7, "0c"),
            ],
            wasm: vec![entry("lap", 21.0, "0a"), entry("nearest", 102e-6, "ff")],
            instructions: BTreeMap::from([("lap".to_owned(), 114_488_777)]),
        };
        let table = figures.table();
        let row = |what: &str| {
            let row = table.lines().find(|row| row.contains(what));
            row.and_then(|row| row.split_once(" | ")).unwrap().1
        };
        assert_eq!(
            row("canonical lap"),
            "10.2 ms | 12.0 ms | 21.0 ms | 25.0 ms | 114 M | yes |"
        );
        assert_eq!(
            row("nearest neighbour"),
            "44.0 ns | 90.0 ns | 102 ns | 150 ns | – | **no** |"
        );
        assert_eq!(row("occupancy grid"), "700 µs | – | – | – | – | – |");
        assert_eq!(table.lines().count(), 2 + workloads().len());
    }
}
