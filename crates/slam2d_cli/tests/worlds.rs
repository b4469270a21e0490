//! `--world`: built-in worlds and files, run as a reader runs them.

mod support;

use std::fs;

use support::{assert_refused, json};

/// The Apartment as a file, with `with` in the place of `replace`.
fn apartment(replace: &str, with: &str) -> String {
    let text = r#"{
  "walls_m": [
    [0, 0, 12, 0], [0, 9, 12, 9], [0, 0, 0, 9], [12, 0, 12, 9],
    [0, 3.8, 1.6, 3.8], [2.5, 3.8, 5.5, 3.8], [6.5, 3.8, 9.5, 3.8], [10.4, 3.8, 12, 3.8],
    [0, 5, 2.8, 5], [3.7, 5, 7.4, 5], [8.3, 5, 12, 5],
    [4, 0, 4, 3.8], [8, 0, 8, 3.8], [6, 5, 6, 9],
    [4, 1.4, 6.2, 1.4], [2, 7.6, 2, 9], [9.6, 7.4, 9.6, 9], [9.6, 7.4, 10.9, 7.4]
  ],
  "start": { "x_m": 1.35, "y_m": 4.42, "heading_deg": 0 },
  "way_points_m": [[10.6, 4.42], [1.35, 4.42]],
  "turn_at": 1
}"#;
    assert!(text.contains(replace), "{replace}");
    text.replace(replace, with)
}

#[test]
fn the_apartment_from_a_file_has_the_bits_of_the_one_that_is_built_in() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("flat.json");
    fs::write(&file, apartment("", "")).unwrap();
    let path = file.to_str().unwrap();
    let built_in = json(&["lap", "--json"]);
    for arguments in [
        ["lap", "--json", "--world", path],
        ["lap", "--json", "--world", "apartment"],
    ] {
        assert_eq!(json(&arguments), built_in);
    }
}

#[test]
fn a_lap_of_the_ring_closes_its_cycle() {
    let lap = json(&["lap", "--json", "--world", "ring"]);
    // Without loops the end of the cycle misses its start.
    let alone = json(&["lap", "--json", "--world", "ring", "--no-loops"]);
    let accepted = |event: &&serde_json::Value| event["accepted"] == true;
    let events = lap["events"].as_array().unwrap();
    assert!(events.iter().filter(accepted).count() > 0);
    let error = |lap: &serde_json::Value| lap["keyframe_rms"].as_f64().unwrap();
    assert!(error(&lap) < error(&alone));
}

#[test]
fn a_file_that_is_no_world_is_one_line_that_names_it() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("flat.json");
    let path = file.to_str().unwrap();
    for command in ["lap", "sweep"] {
        assert_refused(
            &[command, "--world", "rnig"],
            "rnig: No such file or directory (os error 2): --world takes apartment, ring or the name of a file",
        );
    }
    for (replace, with, said) in [
        (
            "turn_at",
            "turnat",
            "flat.json: line 11, column 10: unknown field `turnat`",
        ),
        (
            "10.6",
            "NaN",
            "flat.json: line 10, column 21: expected value; the file has to be JSON",
        ),
        (
            "[10.6, 4.42]",
            "[10.6, 2]",
            "flat.json: the straight way from the start to way point 1 comes within 0.00 m of wall",
        ),
        (
            "4.42, \"h",
            "4.95, \"h",
            "flat.json: the start is 0.05 m from wall 9: keep it 0.3 m from every wall",
        ),
    ] {
        fs::write(&file, apartment(replace, with)).unwrap();
        assert_refused(&["lap", "--world", path], said);
    }
}
