//! The table of the workloads, from what was measured and counted.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use serde::Deserialize;
use serde::de::DeserializeOwned;
use slam2d_bench::calibration::{ID, QUIET, slowdown};
use slam2d_bench::{Limit, Workload, workloads};

/// One entry of what `measure` prints.
#[derive(Deserialize)]
pub struct Entry {
    /// Name of the workload.
    pub id: String,
    /// Median of one repetition, ms.
    pub median_ms: f64,
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
        lines.push(String::new());
        lines.push(self.machine_words());
        lines.join("\n")
    }

    /// Fails where a row is beyond its limit in a build that ran on a quiet machine.
    ///
    /// # Errors
    /// A line for each such row.
    pub fn judge(&self) -> Result<(), String> {
        let beyond = |build: &Build<'_>, workload: &Workload| {
            let limit = build.limit(workload)?;
            let ms = build.median_ms(workload).filter(|ms| *ms > limit)?;
            Some(format!(
                "{}: {} {}, and the limit is {}",
                workload.id,
                time(Some(ms)),
                build.name,
                time(Some(limit))
            ))
        };
        let all = workloads();
        let complaints: Vec<String> = self
            .builds()
            .iter()
            .filter(|build| build.is_quiet())
            .flat_map(|build| all.iter().filter_map(|workload| beyond(build, workload)))
            .collect();
        if complaints.is_empty() {
            Ok(())
        } else {
            Err(complaints.join("\n"))
        }
    }

    fn builds(&self) -> [Build<'_>; 2] {
        [
            Build {
                name: "natively",
                entries: &self.native,
                limit_ms: |limit| limit.native_ms,
            },
            Build {
                name: "in Chromium",
                entries: &self.wasm,
                limit_ms: |limit| limit.wasm_ms,
            },
        ]
    }

    /// What the calibration loop says of the machine.
    fn machine_words(&self) -> String {
        let words: Vec<String> = self
            .builds()
            .iter()
            .filter_map(|build| Some(format!("{:.2} times {}", build.slowdown()?, build.name)))
            .collect();
        let verdict = if self.builds().iter().all(Build::is_quiet) {
            "the machine was quiet"
        } else {
            "the machine was busy or is another one, so a time in bold is beyond its limit and no error"
        };
        format!(
            "The calibration loop took its reference time {}: {verdict}.",
            words.join(" and ")
        )
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
        let [native, wasm] = self.builds().map(|build| build.cells(workload));
        format!(
            "| {} | {native} | {wasm} | {} | {same} |",
            workload.what,
            instructions(self.instructions.get(workload.id).copied()),
        )
    }
}

/// The medians of one build.
struct Build<'a> {
    name: &'static str,
    entries: &'a [Entry],
    limit_ms: fn(&Limit) -> f64,
}

impl Build<'_> {
    fn median_ms(&self, workload: &Workload) -> Option<f64> {
        let entry = self.entries.iter().find(|entry| entry.id == workload.id);
        entry.map(|entry| entry.median_ms)
    }

    fn limit(&self, workload: &Workload) -> Option<f64> {
        workload.limit.as_ref().map(self.limit_ms)
    }

    /// Median and limit of a row; the median in bold where it is beyond the limit.
    fn cells(&self, workload: &Workload) -> String {
        let (median, limit) = (self.median_ms(workload), self.limit(workload));
        let shown = time(median);
        match (median, limit) {
            (Some(ms), Some(most)) if ms > most => format!("**{shown}** | {}", time(limit)),
            _ => format!("{shown} | {}", time(limit)),
        }
    }

    fn slowdown(&self) -> Option<f64> {
        let calibrations = self.entries.iter().filter(|entry| entry.id == ID);
        slowdown(calibrations.map(|entry| entry.median_ms))
    }

    fn is_quiet(&self) -> bool {
        self.slowdown().is_some_and(|slowdown| slowdown <= QUIET)
    }
}

/// What stands where there is no figure.
const NOTHING: &str = "–";

/// Three digits, in a unit that suits.
pub fn time(milliseconds: Option<f64>) -> String {
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

pub fn read<T: DeserializeOwned>(path: &Path) -> Result<T, String> {
    let say = |error: &dyn std::fmt::Display| format!("{}: {error}", path.display());
    let text = fs::read_to_string(path).map_err(|error| say(&error))?;
    serde_json::from_str(&text).map_err(|error| say(&error))
}

#[cfg(test)]
mod tests {
    use slam2d_bench::calibration::REFERENCE_MS;

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
            row("the same, dense map"),
            "44.0 ns | 90.0 ns | 102 ns | 150 ns | – | **no** |"
        );
        assert_eq!(row("occupancy grid"), "700 µs | – | – | – | – | – |");
        assert_eq!(table.lines().count(), 2 + workloads().len() + 2);
    }

    /// A lap that took 13 ms where 12 are allowed, on a machine this much slower than the reference.
    fn slow_lap(slowdown: f64) -> Figures {
        let entry = |id: &str, median_ms| Entry {
            id: id.to_owned(),
            median_ms,
            digest: String::new(),
        };
        let loop_ms = slowdown * REFERENCE_MS;
        Figures {
            native: vec![
                entry(ID, REFERENCE_MS),
                entry("lap", 13.0),
                entry(ID, loop_ms),
            ],
            wasm: Vec::new(),
            instructions: BTreeMap::new(),
        }
    }

    #[test]
    fn a_row_beyond_its_limit_fails_on_a_quiet_machine_and_is_marked_on_every_one() {
        let message = slow_lap(1.0).judge().unwrap_err();
        assert_eq!(message, "lap: 13.0 ms natively, and the limit is 12.0 ms");
        assert_eq!(slow_lap(1.5).judge(), Ok(()));
        for slowdown in [1.0, 1.5] {
            let table = slow_lap(slowdown).table();
            assert!(table.contains("| **13.0 ms** | 12.0 ms |"), "{table}");
        }
        let words = slow_lap(1.5).table();
        assert!(words.contains("reference time 1.50 times natively: the machine was busy"));
    }
}
