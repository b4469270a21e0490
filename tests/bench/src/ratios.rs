//! The table of what WebAssembly takes of the native time.

use slam2d_bench::workloads;

use crate::measured::Measured;
use crate::report::{NOTHING, bold_beyond};

/// The table in Markdown, a row for each workload that was measured.
pub fn table(measured: &Measured) -> String {
    let mut lines = vec![
        "| workload | Chromium / native | limit | Node / native |".to_owned(),
        "|---|--:|--:|--:|".to_owned(),
    ];
    for workload in workloads() {
        let Some(entry) = measured.of(workload.id) else {
            continue;
        };
        let chromium = entry.chromium.ratio_to(&entry.native);
        let most = workload.most_of_native;
        lines.push(format!(
            "| {} | {} | {} | {:.2} |",
            workload.what,
            bold_beyond(format!("{chromium:.2}"), chromium, most),
            most.map_or(NOTHING.to_owned(), |most| format!("{most:.2}")),
            entry.node.ratio_to(&entry.native),
        ));
    }
    lines.push(String::new());
    lines.push(measured.machine_words());
    lines.join("\n")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measured::tests::{entry, measured};

    #[test]
    fn a_ratio_beyond_its_limit_is_bold() {
        let table = table(&measured(
            1.0,
            vec![
                entry("lap", [10.0, 15.0, 17.0], [""; 3]),
                entry("normals", [1.0, 2.0, 2.5], [""; 3]),
            ],
        ));
        let rows: Vec<_> = table
            .lines()
            .filter_map(|row| row.split_once(" | "))
            .collect();
        assert_eq!(rows[1].1, "**1.70** | 1.60 | 1.50 |");
        assert_eq!(rows[2], ("| normals of 720 points", "2.50 | – | 2.00 |"));
    }
}
