//! Tests of the command line.

#[allow(dead_code, reason = "the tests of slam2d use the rest")]
#[path = "../../../robots/slam2d/tests/corridor.rs"]
mod corridor;
mod support;

use std::fs;
use std::path::Path;

use bench_support::skip::skip;
use tempfile::TempDir;

use corridor::{corridor, text, write};
use support::{assert_rejected, json, slam2d_dev};

#[test]
fn a_command_without_a_subcommand_is_rejected() {
    assert_rejected(&[], "a subcommand is required");
}

#[test]
fn the_log_of_a_building_has_its_true_path_beside_it() {
    let folder = TempDir::new().unwrap();
    let log = folder.path().join("ring.log");
    let drawn = slam2d_dev(&["buildings", "--seeds", "101", "--log", text(&log)]);
    assert!(drawn.status.success());
    let lines = |path: &Path| fs::read_to_string(path).unwrap().lines().count();
    assert!(lines(&log) > 100);
    assert_eq!(lines(&log), lines(&folder.path().join("ring.tum")));
}

#[test]
fn a_folder_of_logs_is_mapped_under_every_disturbance() {
    let folder = TempDir::new().unwrap();
    corridor(&folder, 40);
    // From the first scan to the 25th the robot drove 2.4 m.
    write(&folder, "corridor.relations", "106 130 2.4 0 0 0 0 0\n");
    let folder = text(folder.path());
    let outcomes = json(&["logs", folder, "--disturbed", "--json"]);
    let outcomes = outcomes.as_array().unwrap();
    assert_eq!(outcomes.len(), 13);
    for outcome in outcomes {
        let within = outcome["within_95"].as_f64().unwrap();
        // One relation is inside or outside.
        assert!(within == 0.0 || within == 1.0, "{outcome}");
    }
    let named = |name: &str| {
        let mut outcomes = outcomes.iter();
        outcomes.find(|outcome| outcome["disturbance"] == name)
    };
    // The end of the corridor is in view; the odometry is off by 0.24 m, and by 0.36 m with wheels 5 % too long.
    for name in ["none", "reversed", "wheels +5 %", "scans alone"] {
        let outcome = named(name).unwrap();
        assert!(outcome["error_m"].as_f64().unwrap() < 0.1, "{outcome}");
    }
}

#[test]
fn a_folder_of_logs_is_driven_forward_and_back() {
    let folder = TempDir::new().unwrap();
    corridor(&folder, 40);
    // From the first scan to the 25th the robot drove 2.4 m.
    write(&folder, "corridor.relations", "106 130 2.4 0 0 0 0 0\n");
    let folder = text(folder.path());
    let rows = json(&["logs", folder, "--repeat", "4", "--json"]);
    let [once, often, noisy_once, noisy] = rows.as_array().unwrap().as_slice() else {
        panic!("{rows}");
    };
    let scans = |row: &serde_json::Value| row["scans"].as_u64().unwrap();
    assert_eq!((scans(once), scans(often)), (40, 160));
    assert!(scans(noisy_once) < 40 && scans(noisy) < 160);
    for row in [once, often, noisy_once, noisy] {
        for error_m in row["error_m"].as_array().unwrap() {
            // As under the other disturbances; null if a noisy drive lost one of the two scans.
            assert!(error_m.as_f64().is_none_or(|m| m < 0.1), "{row}");
        }
    }
    for error_m in often["error_m"].as_array().unwrap() {
        assert!(error_m.as_f64().is_some(), "{often}");
    }
}

#[test]
fn one_command_maps_every_file_with_its_error_or_a_sentence() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../../shared/data/field");
    if !folder.exists() {
        skip(
            "files that people have",
            "they are not in ../shared/data/field, beside the repository",
        );
        return;
    }
    let output = slam2d_dev(&["recordings", "--field", text(&folder)]);
    let table = String::from_utf8(output.stdout).unwrap();
    let page = fs::read_to_string("../../../docs/recordings.md").unwrap();
    for row in table.trim().lines() {
        assert!(page.contains(row), "not in docs/recordings.md: {row}");
        let cells: Vec<&str> = row.split('|').map(str::trim).collect();
        assert!(
            cells[2] != "rejected" || cells[4].contains("; "),
            "no remedy: {row}"
        );
    }
    assert!(table.lines().count() > 30, "{table}");
}
