//! The doctor's report, and the output of a run besides its map.

use std::fs;

use serde_json::Value;
use tempfile::TempDir;

use crate::logs::{corridor, text};
use crate::support::{assert_refused, json, slam2d};

#[test]
fn the_doctor_reports_each_part_of_a_recording_with_a_symbol() {
    let folder = TempDir::new().unwrap();
    let log = corridor(&folder, 40);
    let output = slam2d(&["doctor", text(&log)]);
    assert!(output.status.success());
    let screen = String::from_utf8(output.stdout).unwrap();
    assert!(screen.starts_with("✗ corridor.clf\n✓ file "), "{screen}");
    for part in ["sensor", "odometry", "mounting", "clocks"] {
        assert!(screen.contains(&format!(" {part} ")), "{screen}");
    }
    // The corridor's odometry is a tenth too long.
    assert!(
        screen.contains("odometry measures 1.10 m per metre"),
        "{screen}"
    );
    let report = json(&["doctor", text(&log), "--json"]);
    assert_eq!(
        (&report["sensor"]["scans"], &report["verdict"]),
        (&Value::from(40), &Value::from("wrong"))
    );
    assert_refused(&["doctor", "/absent"], "/absent: ");
}

#[test]
fn a_run_leaves_the_map_and_a_report_under_the_file_s_name() {
    let folder = TempDir::new().unwrap();
    let log = corridor(&folder, 40);
    let out = folder.path().join("out");
    let run = slam2d(&["run", text(&log), "-o", text(&out)]);
    assert!(run.status.success());
    for name in ["map.pgm", "map.png", "map.yaml"] {
        assert!(out.join(name).is_file(), "{name}");
    }
    let report = fs::read_to_string(out.join("report.html")).unwrap();
    assert!(
        report.contains("<title>Map of corridor.clf</title>"),
        "the title is a name, not a path"
    );
}
