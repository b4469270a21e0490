//! The table of the port in JavaScript: the chapter's system in plain JavaScript, in Node.

use std::path::Path;
use std::process::{Command, Stdio};

use serde::Deserialize;
use slam2d_bench::workloads;

use crate::report::{Entry, read, time};

/// The port, which checks itself beside the reference figures before it is timed.
const PORT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/peer/main.mjs");

/// What the port prints.
#[derive(Deserialize)]
struct Printed {
    runtime: String,
    workloads: Vec<Timed>,
}

#[derive(Deserialize)]
struct Timed {
    id: String,
    median_ms: f64,
}

/// Runs the port and sets its medians beside those that `measure` printed natively.
///
/// # Errors
/// One sentence where the file cannot be read or Node fails.
pub fn table(native: &Path) -> Result<String, String> {
    let native: Vec<Entry> = read(native)?;
    let output = Command::new("node")
        .arg(PORT)
        .stderr(Stdio::inherit())
        .output()
        .map_err(|error| format!("node: {error}"))?;
    if !output.status.success() {
        return Err(format!("node {PORT}: {}", output.status));
    }
    let printed: Printed =
        serde_json::from_slice(&output.stdout).map_err(|error| format!("node {PORT}: {error}"))?;
    Ok(lines(&native, &printed))
}

fn lines(native: &[Entry], printed: &Printed) -> String {
    let mut lines = vec![
        format!(
            "| workload | ours, native | JavaScript, {} | ratio |",
            printed.runtime
        ),
        "|---|--:|--:|--:|".to_owned(),
    ];
    let all = workloads();
    for Timed { id, median_ms } in &printed.workloads {
        let workload = all.iter().find(|workload| workload.id == id);
        let ours = native.iter().find(|entry| entry.id == *id);
        if let (Some(workload), Some(ours)) = (workload, ours) {
            lines.push(format!(
                "| {} | {} | {} | {:.0} |",
                workload.what,
                time(Some(ours.median_ms)),
                time(Some(*median_ms)),
                median_ms / ours.median_ms
            ));
        }
    }
    lines.join("\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_row_has_both_medians_and_their_ratio() {
        let native: Vec<Entry> =
            serde_json::from_str(r#"[{"id": "lap", "median_ms": 10.0, "digest": "0a"}]"#).unwrap();
        let printed =
            r#"{"runtime": "Node v20.0.0", "workloads": [{"id": "lap", "median_ms": 600.0}]}"#;
        let lines = lines(&native, &serde_json::from_str(printed).unwrap());
        assert!(
            lines.starts_with("| workload | ours, native | JavaScript, Node v20.0.0 | ratio |")
        );
        assert!(
            lines.ends_with("all metrics | 10.0 ms | 600 ms | 60 |"),
            "{lines}"
        );
    }
}
