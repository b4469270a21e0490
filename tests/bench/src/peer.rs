//! The table of the port in JavaScript: the chapter's system in plain JavaScript, in Node.

use std::env::current_exe;
use std::process::{Command, Stdio};

use serde::Deserialize;
use slam2d_bench::workloads;

use crate::measured::median;
use crate::report::time;

/// The port, which checks itself beside the reference figures before it is timed.
const PORT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/peer/main.mjs");

/// What the port prints.
#[derive(Deserialize)]
struct Printed {
    runtime: String,
    workloads: Vec<Timed>,
}

/// Milliseconds of each round.
#[derive(Deserialize)]
struct Timed {
    id: String,
    native: Vec<f64>,
    javascript: Vec<f64>,
}

/// Runs the port by turns with this program and sets the medians beside each other.
///
/// # Errors
/// One sentence where Node fails.
pub fn table() -> Result<String, String> {
    let ours = current_exe().map_err(|error| format!("this program's own path: {error}"))?;
    let output = Command::new("node")
        .arg(PORT)
        .arg(ours)
        .stderr(Stdio::inherit())
        .output()
        .map_err(|error| format!("node: {error}"))?;
    if !output.status.success() {
        return Err(format!("node {PORT}: {}", output.status));
    }
    let printed: Printed =
        serde_json::from_slice(&output.stdout).map_err(|error| format!("node {PORT}: {error}"))?;
    Ok(lines(&printed))
}

fn lines(printed: &Printed) -> String {
    let mut lines = vec![
        format!(
            "| workload | ours, native | JavaScript, {} | ratio |",
            printed.runtime
        ),
        "|---|--:|--:|--:|".to_owned(),
    ];
    let all = workloads();
    for timed in &printed.workloads {
        let Some(workload) = all.iter().find(|workload| workload.id == timed.id) else {
            continue;
        };
        let ratios = timed.javascript.iter().zip(&timed.native);
        lines.push(format!(
            "| {} | {} | {} | {:.0} |",
            workload.what,
            time(median(timed.native.iter().copied())),
            time(median(timed.javascript.iter().copied())),
            median(ratios.map(|(theirs, ours)| theirs / ours)),
        ));
    }
    lines.join("\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_row_has_both_medians_and_the_ratio_of_the_middle_round() {
        let printed = r#"{"runtime": "Node v20.0.0", "workloads": [{
            "id": "lap", "native": [10.0, 20.0, 11.0], "javascript": [600.0, 800.0, 610.0]
        }]}"#;
        let lines = lines(&serde_json::from_str(printed).unwrap());
        assert!(
            lines.starts_with("| workload | ours, native | JavaScript, Node v20.0.0 | ratio |")
        );
        assert!(
            lines.ends_with("all metrics | 11.0 ms | 610 ms | 55 |"),
            "{lines}"
        );
    }
}
