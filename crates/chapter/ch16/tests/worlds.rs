//! Other matchers and other worlds on the command line.

use std::fs;

use pr_sim::Course;
use serde_json::Value;

use crate::support::{assert_rejected, json};

/// An empty room of 6 m × 5 m with a pillar, and a path through it.
const ROOM: &str = r#"{
    "walls_m": [[0, 0, 6, 0], [6, 0, 6, 5], [6, 5, 0, 5], [0, 5, 0, 0], [2, 2, 2.4, 2], [2.4, 2, 2.4, 2.6]],
    "start": {"x_m": 1, "y_m": 1, "heading_deg": 0},
    "way_points_m": [[5, 1], [5, 4], [1, 4], [1, 1]]
}"#;

#[test]
fn every_matcher_drives_the_lap_and_only_the_chapters_has_its_digest() {
    let chapter = json(&["lap", "--json"]);
    let point_to_point = json(&["lap", "--matcher", "p2p", "--json"]);
    assert_eq!(chapter["digest"], point_to_point["digest"]);
    for matcher in ["p2l", "ndt"] {
        let lap = json(&["lap", "--matcher", matcher, "--json"]);
        assert_ne!(lap["digest"], chapter["digest"]);
        let ends =
            ["keyframe_end_error_m", "odometry_end_error_m"].map(|end| lap[end].as_f64().unwrap());
        assert!(ends[0] < 0.7 * ends[1], "{matcher}: {ends:?}");
    }
}

#[test]
fn the_ring_and_a_world_of_ones_own_are_driven() {
    let on_the_ring = ["lap", "--world", "ring", "--matcher", "ndt", "--json"];
    let ring = json(&on_the_ring);
    assert!(ring["ticks"].as_u64().unwrap() > 150);
    let ends =
        ["keyframe_end_error_m", "odometry_end_error_m"].map(|end| ring[end].as_f64().unwrap());
    assert!(ends[0] < ends[1]);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("room.json");
    fs::write(&path, ROOM).unwrap();
    let room = json(&["lap", "--world", path.to_str().unwrap(), "--json"]);
    assert!(room["keyframe_end_error_m"].as_f64().unwrap() < 0.8);
    // Loops are closed in this world, so the information of the edges affects χ².
    let chapter = [&on_the_ring[..], &["--information", "chapter"]].concat();
    assert_ne!(json(&chapter)["chi2"], ring["chi2"]);
}

#[test]
fn the_apartment_from_a_file_is_driven_as_the_built_in_one() {
    let course = Course::apartment();
    let start = course.start();
    let walls = course.world().walls().iter();
    let file = serde_json::json!({
        "walls_m": walls
            .map(|wall| [wall.start.x, wall.start.y, wall.end.x, wall.end.y])
            .collect::<Vec<_>>(),
        "start": {"x_m": start.x(), "y_m": start.y(), "heading_deg": start.theta().to_degrees()},
        "way_points_m": course.way_points().iter().map(|p| [p.x, p.y]).collect::<Vec<_>>(),
        "turn_at": course.turn().map(|turn| turn + 1),
    });
    assert_eq!(
        Course::from_json(file.to_string().as_bytes()).unwrap(),
        course
    );
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("apartment.json");
    fs::write(&path, file.to_string()).unwrap();
    let from_file = json(&["lap", "--world", path.to_str().unwrap(), "--json"]);
    let built_in = json(&["lap", "--json"]);
    let ticks = |lap: &Value| lap["per_tick"].as_array().unwrap().clone();
    assert_eq!(ticks(&from_file).len(), ticks(&built_in).len());
    for (file, built_in) in ticks(&from_file).iter().zip(ticks(&built_in)) {
        assert_eq!(file["truth"], built_in["truth"]);
        assert_eq!(file["dead_reckoning"], built_in["dead_reckoning"]);
    }
}

#[test]
fn a_sweep_of_the_ring_gives_the_laps_of_the_ring() {
    let sweep = |world| {
        let arguments = [
            "sweep",
            "--seeds",
            "1..=2",
            "--noise",
            "1",
            "--matcher",
            "ndt",
        ];
        json(&[&arguments[..], &["--world", world, "--json"]].concat())
    };
    let ring = sweep("ring");
    assert_ne!(ring, sweep("apartment"));
    let samples = ring[0]["samples"].as_array().unwrap();
    assert_eq!(samples.len(), 2);
    for sample in samples {
        let seed = sample["seed"].to_string();
        let lap = [
            "lap",
            "--world",
            "ring",
            "--matcher",
            "ndt",
            "--seed",
            &seed,
        ];
        assert_eq!(
            sample["digest"],
            json(&[&lap[..], &["--json"]].concat())["digest"]
        );
    }
}

#[test]
fn a_world_that_cannot_be_driven_is_one_sentence() {
    let folder = tempfile::tempdir().unwrap();
    for (name, text, part) in [
        ("empty", "", "empty.json: "),
        ("other", &ROOM.replace("start", "begin"), "other.json: "),
        (
            "bare",
            &ROOM.replace("[[5, 1], [5, 4], [1, 4], [1, 1]]", "[]"),
            "bare.json: ",
        ),
    ] {
        let path = folder.path().join(format!("{name}.json"));
        fs::write(&path, text).unwrap();
        assert_rejected(&["lap", "--world", path.to_str().unwrap()], part);
    }
    assert_rejected(&["lap", "--world", "nowhere.json"], "nowhere.json");
    assert_rejected(&["sweep", "--world", "nowhere.json"], "nowhere.json");
    assert_rejected(&["lap", "--matcher", "best"], "best");
    assert_rejected(
        &["lap", "--world", "moon"],
        "expected apartment, ring, twins, corridor, hall or a .json file",
    );
}
