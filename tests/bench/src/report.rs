//! The table of the workloads, from their measurements and counts.

use slam2d_bench::{Workload, workloads};

use crate::counts::Counts;
use crate::measured::{Entry, Measured};

/// The entry for a missing value.
const NOTHING: &str = "–";

/// The table in Markdown, a row for each workload; `counts` are those of one repetition, and empty if
/// counting is not available.
pub fn table(measured: &Measured, counts: &Counts) -> String {
    let mut lines = vec![
        "| workload | native | limit | Chromium | limit | Chromium / native | limit | Node / native | instructions, \
         native | same bits |"
            .to_owned(),
        "|---|--:|--:|--:|--:|--:|--:|--:|--:|---|".to_owned(),
    ];
    let rows = workloads();
    lines.extend(rows.iter().map(|workload| {
        let count = counts.get(workload.id).copied();
        row(workload, measured.of(workload.id), count)
    }));
    lines.push(String::new());
    lines.push(format!("{} rounds.", measured.rounds()));
    lines.join("\n")
}

fn row(workload: &Workload, entry: Option<&Entry>, count: Option<u64>) -> String {
    let cell = |value: Option<f64>, most: Option<f64>, show: fn(f64) -> String| {
        let shown = value.map_or(NOTHING.to_owned(), |value| match most {
            Some(most) if value > most => format!("**{}**", show(value)),
            _ => show(value),
        });
        format!("{shown} | {}", most.map_or(NOTHING.to_owned(), show))
    };
    let ratio = |value: f64| format!("{value:.2}");
    let same = match entry.map(Entry::has_same_bits) {
        Some(true) => "yes",
        Some(false) => "**no**",
        None => NOTHING,
    };
    format!(
        "| {} | {} | {} | {} | {} | {} | {same} |",
        workload.what,
        cell(
            entry.map(|entry| entry.native.median_ms()),
            workload.limit.map(|limit| limit.native_ms),
            time,
        ),
        cell(
            entry.map(|entry| entry.chromium.median_ms()),
            workload.limit.map(|limit| limit.wasm_ms),
            time,
        ),
        cell(
            entry.map(|entry| entry.chromium.ratio_to(&entry.native)),
            workload.most_of_native,
            ratio,
        ),
        entry.map_or(NOTHING.to_owned(), |entry| ratio(
            entry.node.ratio_to(&entry.native)
        )),
        instructions(count),
    )
}

/// Three digits, in a suitable unit.
fn time(milliseconds: f64) -> String {
    match milliseconds {
        ms if ms >= 1.0 => format!("{} ms", three_digits(ms)),
        ms if ms >= 1e-3 => format!("{} µs", three_digits(1e3 * ms)),
        ms => format!("{} ns", three_digits(1e6 * ms)),
    }
}

/// Three digits, in thousands or millions if that is shorter.
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measured::tests::{entry, measured};

    #[test]
    fn times_have_three_digits_and_a_suitable_unit() {
        let shown = [12.345, 0.15, 90e-6, 0.999_96].map(time);
        assert_eq!(shown, ["12.3 ms", "150 µs", "90.0 ns", "1000 µs"]);
    }

    #[test]
    fn counts_have_three_digits_and_a_suitable_unit() {
        let shown = [783, 156_225, 1_083_078, 114_488_777].map(|n| instructions(Some(n)));
        assert_eq!(shown, ["783", "156 k", "1.08 M", "114 M"]);
        assert_eq!(instructions(None), "–");
    }

    #[test]
    fn a_row_shows_the_known_values_and_whether_the_digests_agree() {
        let measured = measured(vec![
            entry("lap", [10.2, 15.0, 26.0], ["0a"; 3]),
            entry("nearest", [44e-6, 60e-6, 60e-6], ["0b", "0b", "ff"]),
        ]);
        let table = table(&measured, &Counts::from([("lap".to_owned(), 114_488_777)]));
        let row = |what: &str| {
            let row = table.lines().find(|row| row.contains(what));
            row.and_then(|row| row.split_once(" | ")).unwrap().1
        };
        assert_eq!(
            row("canonical lap"),
            "10.2 ms | 12.0 ms | **26.0 ms** | 25.0 ms | **2.55** | 1.60 | 1.47 | 114 M | yes |"
        );
        assert_eq!(
            row("the same, dense map"),
            "44.0 ns | 90.0 ns | 60.0 ns | 150 ns | 1.36 | 1.50 | 1.36 | – | **no** |"
        );
        assert_eq!(row("occupancy grid"), "– | – | – | – | – | – | – | – | – |");
        assert!(table.ends_with("\n3 rounds."));
        assert_eq!(table.lines().count(), 2 + workloads().len() + 2);
    }
}
