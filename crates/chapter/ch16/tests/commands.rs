//! Runs the command and compares it with the reference files.

use std::path::Path;
use std::process::{Command, Stdio};

use crate::support::{assert_rejected, ch16, json};
use ch16_lab::basin::{BasinScene, BasinStart};
use ch16_lab::lap::{LapConfig, LapRunner};
use ch16_lab::terrain::{SceneKind, Terrain, TerrainScene, TerrainSettings};
use ch16_slam2d::icp::{IcpVariant, IcpWorkspace};
use robot_io::session::Session;
use serde_json::Value;
use slam2d_tests::assert_close;

/// Asserts that `actual` has every field of `expected`, numbers within `tolerance`.
fn assert_covers(path: &str, actual: &Value, expected: &Value, tolerance: f64) {
    match (actual, expected) {
        (Value::Object(actual), Value::Object(expected)) => {
            for (key, expected) in expected {
                let path = format!("{path}.{key}");
                let actual = actual
                    .get(key)
                    .unwrap_or_else(|| panic!("{path} is missing"));
                assert_covers(&path, actual, expected, tolerance);
            }
        }
        (Value::Array(actual), Value::Array(expected)) => {
            assert_eq!(actual.len(), expected.len(), "{path}");
            for (k, (actual, expected)) in actual.iter().zip(expected).enumerate() {
                assert_covers(&format!("{path}[{k}]"), actual, expected, tolerance);
            }
        }
        (Value::Number(actual), Value::Number(expected)) => {
            let (actual, expected) = (actual.as_f64().unwrap(), expected.as_f64().unwrap());
            assert_close(path, actual, expected, tolerance);
        }
        _ => assert_eq!(actual, expected, "{path}"),
    }
}

#[test]
#[should_panic(expected = "missing")]
fn a_missing_field_is_noticed() {
    let expected = serde_json::json!({"a": 1, "b": 2});
    assert_covers("", &serde_json::json!({"a": 1}), &expected, 1e-6);
}

/// The library's figures are tested against the reference; the command has to print them of the right lap.
#[test]
fn lap_prints_the_librarys_record_of_its_seed_noise_and_loops() {
    for (seed, noise, loops) in [("1", "0.25", true), ("6", "2", true), ("6", "2", false)] {
        let mut arguments = vec!["lap", "--seed", seed, "--noise", noise, "--json"];
        let mut config =
            LapConfig::with_seed_and_noise(seed.parse().unwrap(), noise.parse().unwrap());
        if !loops {
            arguments.push("--no-loops");
            config = config.without_loops();
        }
        let (printed, record) = (json(&arguments), LapRunner::new().run(&config));
        let at = arguments.join(" ");
        // Zero: one computation, and JSON keeps every bit.
        let summary = serde_json::to_value(record.lap.summary).unwrap();
        assert_covers(&at, &printed, &summary, 0.0);
        let graph = serde_json::to_value(record.lap.graph_summary).unwrap();
        assert_covers(&at, &printed, &graph, 0.0);
        assert_eq!(
            printed["digest"],
            format!("{:016x}", record.digest()),
            "{at}"
        );
        let poses = serde_json::to_value(record.lap.poses(record.ticks())).unwrap();
        assert_eq!(printed["keyframe_poses"], poses, "{at}");
        assert_eq!(
            printed["events"].as_array().unwrap().len(),
            record.lap.graph_summary.loop_attempts
        );
        assert_eq!(
            printed["per_tick"].as_array().unwrap().len(),
            record.ticks()
        );
    }
}

/// The page and the command have one definition of home: the position and the heading.
#[test]
fn basin_reports_used_up_iterations_as_an_outcome_of_its_own() {
    let run = |limit: &str| {
        let arguments = [
            "basin",
            "--dx",
            "0",
            "--dy",
            "0",
            "--heading-deg",
            "35",
            "--max-iterations",
            limit,
            "--json",
        ];
        json(&arguments)["runs"][0].clone()
    };
    // basin.json: 0.116 m and 25.3° off after 30 iterations.
    let short = run("30");
    assert_eq!(short["ending"], "not_converged");
    assert_eq!(short["stop"]["iteration_limit"]["max_iterations"], 30);
    let patient = run("200");
    assert_eq!(patient["ending"], "right");
    assert!(patient["stop"]["small_step"].is_object(), "{patient}");
}

#[test]
fn basin_prints_the_librarys_outcome_of_every_start() {
    let (dx_m, dy_m) = (0.3, -0.2);
    for (name, variant) in [
        ("point-to-point", IcpVariant::PointToPoint),
        ("point-to-plane", IcpVariant::PointToPlane),
    ] {
        let printed = json(&[
            "basin",
            "--variant",
            name,
            "--tau",
            "1.1",
            "--dx",
            "0.3",
            "--dy",
            "-0.2",
            "--heading-deg=-170:170:85",
            "--json",
        ]);
        let config = BasinScene::config(variant, 1.1);
        let (scene, mut workspace) = (BasinScene::new(), IcpWorkspace::new());
        assert_eq!(
            (&printed["variant"], &printed["tau_m"]),
            (&name.into(), &1.1.into())
        );
        assert_eq!(
            printed["source"].as_array().unwrap().len(),
            scene.source().len()
        );
        let headings_deg = [-170.0, -85.0, 0.0, 85.0, 170.0];
        assert_eq!(
            printed["runs"].as_array().unwrap().len(),
            headings_deg.len()
        );
        for (heading_deg, run) in headings_deg
            .into_iter()
            .zip(printed["runs"].as_array().unwrap())
        {
            let start = BasinStart {
                heading_deg,
                dx_m,
                dy_m,
            };
            let outcome = scene.register_from(&start, &config, &mut workspace);
            // Zero: one computation, and JSON keeps every bit.
            for expected in [serde_json::to_value(start), serde_json::to_value(outcome)] {
                assert_covers(name, run, &expected.unwrap(), 0.0);
            }
        }
    }
}

#[test]
fn terrain_prints_the_librarys_landscapes() {
    for (name, kind) in [("room", SceneKind::Room), ("corridor", SceneKind::Corridor)] {
        let printed = json(&[
            "terrain", "--scene", name, "--tau", "0.4", "--n", "5", "--json",
        ]);
        let settings = TerrainSettings {
            n: 5,
            tau_m: 0.4,
            ..TerrainSettings::default()
        };
        let scene = TerrainScene::new(kind, TerrainScene::DEFAULT_NDT_CELL_M);
        let terrain = Terrain::compute(&scene, &settings);
        let expected = serde_json::json!({
            "scene": name,
            "tau_m": 0.4,
            "n": 5,
            "points": scene.cloud().len(),
            "ndt_cells": scene.ndt().cells().len(),
            "icp_cost_m2": terrain.icp_cost_m2(),
            "ndt_score": terrain.ndt_score(),
        });
        assert_covers(name, &printed, &expected, 0.0);
    }
}

#[test]
fn table_prints_what_the_chapter_prints() {
    let output = ch16(&["table"]);
    let text = String::from_utf8(output.stdout).unwrap();
    for printed in [
        "129 ticks, 41 keyframes",
        "2.4110       0.7334            0.2389",
        "1.1826       0.6444            0.5857",
        "0.54–0.75         0.17–0.34",
        "0.85              0.89",
        "0.2377            0.0817",
    ] {
        assert!(text.contains(printed), "{printed} is not in\n{text}");
    }
}

const COLUMNS: [&str; 3] = ["odometry", "front_end", "with_loops"];
const ROWS: [&str; 8] = [
    "end_error",
    "rms",
    "last_nine_min",
    "last_nine_max",
    "max_error",
    "half_way",
    "half_way_sigma",
    "map_disagreement",
];

#[test]
fn a_million_threads_are_no_more_than_there_are_seeds() {
    let arguments = ["sweep", "--seeds", "1..=2", "--noise", "1", "--json"];
    let many = json(&[&arguments[..], &["--threads", "1000000"]].concat());
    assert_eq!(many, json(&arguments));
}

#[test]
fn a_start_moved_by_its_last_digits_makes_another_lap_of_seed_2_and_not_of_1_and_3() {
    let arguments = ["sweep", "--nudge", "--seeds", "1..=3", "--noise", "1"];
    let level = json(&[&arguments[..], &["--json"]].concat())[0].take();
    assert_eq!(level["runs"], 3);
    assert_eq!(level["changed"], 1);
    // 32 mm, although the start moved by less than 1e-15 m.
    let farthest_m = level["farthest_m"].as_f64().unwrap();
    assert_close("farthest", farthest_m, 0.032, 5e-4);
}

#[test]
fn laps_at_random_configurations_are_counted_with_those_that_are_sound() {
    let all = json(&["sweep", "--random", "--seeds", "1..=4", "--json"]);
    assert_eq!(all["laps"], 4);
    assert_eq!(all["sound"], 4);
    assert!(all["ticks"].as_u64().unwrap() > 4, "{all}");
}

#[test]
fn sweep_counts_every_run_once_and_does_not_depend_on_threads() {
    let arguments = ["sweep", "--seeds", "1..=3", "--noise", "1,4", "--json"];
    let levels = json(&arguments);
    let one_thread = json(&[&arguments[..], &["--threads", "1"]].concat());
    assert_eq!(levels, one_thread);
    assert_eq!(levels.as_array().unwrap().len(), 2);
    for level in levels.as_array().unwrap() {
        assert_eq!(level["runs"], 3);
        let shares = level["loop_shares"].as_array().unwrap();
        let total: f64 = shares.iter().map(|share| share.as_f64().unwrap()).sum();
        assert_close("shares", total, 1.0, 1e-12);
        let entries = level["entries"].as_array().unwrap();
        assert_eq!(entries.len(), 18);
        for column in ["front_end", "with_loops"] {
            let medians = level["along_the_way"][column].as_array().unwrap();
            assert_eq!((medians.len(), medians[0].as_f64()), (21, Some(0.0)));
        }
        // Ids as in the figures of the page, not display names.
        for entry in entries {
            let [column, row] = ["column", "row"].map(|key| entry[key].as_str().unwrap());
            assert!(COLUMNS.contains(&column) && ROWS.contains(&row), "{entry}");
        }
    }
    // Seeds 1, 2, 3 at noise 1 close 2, 3 and 2 loops (lap.json).
    assert_eq!(levels[0]["accepted_loops"], 7);
}

#[test]
fn register_finds_the_motion_between_two_files() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, shift: (f64, f64)| {
        let point = |k: i32| {
            let along = 0.05 * f64::from(k % 60);
            let (x, y) = if k < 60 { (along, 0.0) } else { (0.0, along) };
            format!("{},{}\n", x - shift.0, y - shift.1)
        };
        let path = folder.path().join(name);
        std::fs::write(&path, (0..120).map(point).collect::<String>()).unwrap();
        path.to_string_lossy().into_owned()
    };
    let (map, scan) = (
        write("map.csv", (0.0, 0.0)),
        write("scan.csv", (0.11, -0.07)),
    );
    for method in ["p2l", "p2p"] {
        let found = json(&[
            "register", &map, &scan, "--method", method, "--tau", "0.5", "--repeat", "3", "--json",
        ]);
        // 1e-3: registration stops at a step of 1e-4, and p2p creeps along the walls.
        for (k, expected) in [0.11, -0.07, 0.0].into_iter().enumerate() {
            let tolerance = if method == "p2l" { 1e-3 } else { 0.05 };
            assert_close(
                method,
                found["pose"][k].as_f64().unwrap(),
                expected,
                tolerance,
            );
        }
        assert!(found["us"].as_f64().unwrap() > 0.0);
        assert!(found["us_build"].as_f64().unwrap() > 0.0);
    }
}

#[test]
fn register_says_in_words_why_it_ended() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, x: f64| {
        let path = folder.path().join(name);
        let wall = |k: i32| format!("{x},{}\n", 0.05 * f64::from(k));
        std::fs::write(&path, (0..60).map(wall).collect::<String>()).unwrap();
        path.to_string_lossy().into_owned()
    };
    let (map, near, far) = (
        write("map.csv", 0.0),
        write("near.csv", 0.1),
        write("far.csv", 9.0),
    );
    let printed = |scan: &str| {
        let output = ch16(&["register", &map, scan]);
        assert!(output.status.success());
        String::from_utf8(output.stdout).unwrap()
    };
    // No point of a wall measures the direction along it.
    let text = printed(&near);
    let along = "not converged: no pair measures motion along 90° of the map";
    assert!(text.contains(along), "{text}");
    let text = printed(&far);
    assert!(text.contains("too few pairs within tau: 0,"), "{text}");
    assert!(!text.contains("inf") && !text.contains('{'), "{text}");
}

#[test]
fn a_bad_line_is_named_with_its_file() {
    let folder = tempfile::tempdir().unwrap();
    let bad = folder.path().join("bad.csv");
    std::fs::write(&bad, "1,2\n3,nan\n").unwrap();
    let bad = bad.to_string_lossy();
    assert_rejected(&["register", &bad, &bad], "bad.csv: line 2: ");
}

#[test]
fn wrong_arguments_end_in_one_line_and_exit_code_2() {
    for (arguments, expected) in [
        (&[][..], "a subcommand is required"),
        (&["bogus"], "bogus"),
        (&["lap", "--seed", "-1"], "4294967295"),
        (&["lap", "--seed", "4294967296"], "4294967295"),
        (&["lap", "--noise", "nan"], "finite"),
        (&["lap", "--noise", "-1"], "0 to 100"),
        (&["lap", "--frob"], "--frob"),
        (&["basin", "--tau", "inf"], "finite"),
        (&["basin", "--variant", "plane"], "plane"),
        (&["basin", "--heading-deg", "0:10:0"], "does not reach"),
        (
            &["basin", "--heading-deg", "0:10:1e-9"],
            "too many headings",
        ),
        (&["terrain", "--scene", "attic"], "attic"),
        (&["terrain", "--n", "1"], "from 2 to 1001"),
        (&["terrain", "--n", "48.5"], "integer from 2 to 1001"),
        (&["terrain", "--n", "-3"], "integer from 2 to 1001"),
        (&["sweep", "--seeds", "5..5"], "empty"),
        (&["sweep", "--seeds", "0..=4294967295"], "too many"),
        (&["sweep", "--seeds", "-1..3"], "4294967295"),
        (&["sweep", "--threads", "0"], "positive integer"),
        (
            &["sweep", "--random", "--noise", "2"],
            "cannot be used with",
        ),
        (&["sweep", "--noise", "1,-2"], "0 to 100"),
        (&["register", "absent.csv", "absent.csv"], "absent.csv"),
        (&["register", "a.csv", "b.csv", "--repeat", "0"], "0"),
    ] {
        assert_rejected(arguments, expected);
    }
    assert!(!Path::new("absent.csv").exists());
}

#[test]
fn help_goes_to_standard_output() {
    let output = ch16(&["--help"]);
    assert!(output.status.success());
    let text = String::from_utf8(output.stdout).unwrap();
    for command in [
        "table", "lap", "laps", "basin", "terrain", "register", "places", "sweep",
    ] {
        assert!(text.contains(command), "{command} is not in\n{text}");
    }
}

#[test]
#[cfg(target_os = "linux")]
fn a_full_disk_is_one_line_and_exit_code_2() {
    for arguments in [&["lap", "--help"][..], &["--version"], &["table"]] {
        let full = std::fs::File::create("/dev/full").unwrap();
        let output = Command::new(env!("CARGO_BIN_EXE_ch16"))
            .args(arguments)
            .stdout(full)
            .output()
            .expect("the binary was built for this test");
        let message = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {message}");
        assert_eq!(message.lines().count(), 1, "{arguments:?}: {message}");
        assert!(message.contains("standard output"), "{message}");
    }
}

#[test]
fn a_closed_pipe_is_not_an_error() {
    let mut child = Command::new(env!("CARGO_BIN_EXE_ch16"))
        .args(["lap", "--json"])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the binary was built for this test");
    // Closed before the lap is computed; the pipe's buffer is far smaller than the output.
    drop(child.stdout.take());
    let output = child.wait_with_output().unwrap();
    assert!(output.stderr.is_empty());
    assert!(output.status.success());
}

#[cfg(not(feature = "exercises"))]
#[test]
fn a_command_without_the_exercises_says_how_to_build_one_with_them() {
    let command = "cargo run -p ch16 --features exercises -- lap --exercises";
    assert_rejected(&["lap", "--exercises"], command);
}

#[test]
fn repeated_laps_print_lines_and_write_a_session() {
    let folder = tempfile::tempdir().unwrap();
    let session = folder.path().join("laps.slam2d").display().to_string();
    let run = json(&["laps", "2", "--session", &session, "--json"]);
    let laps = run["laps"].as_array().unwrap();
    assert_eq!(laps.len(), 2);
    let bytes = std::fs::read(&session).unwrap();
    let written = Session::read(&bytes[..], &session).unwrap();
    assert_eq!(laps[1]["nodes"], written.snapshot.keyframes.len());
    assert_eq!(laps[1]["edges"], written.graph().edge_count());
    assert_eq!(laps[1]["bytes"], bytes.len());
    for (arguments, expected) in [
        (vec!["laps", "0"], "not within 1 to 10000"),
        (vec!["laps", "--session", "x"], "not provided"),
        (
            vec!["laps", "2", "--wardrobe", "1", "--world", "ring"],
            "--wardrobe applies to the Apartment only",
        ),
        (
            vec!["laps", "2", "--wardrobe", "3"],
            "is beyond the 2 laps; use a lap up to 2",
        ),
    ] {
        assert_rejected(&arguments, expected);
    }
}

#[test]
fn the_recorded_scans_of_a_lap_are_a_log_with_the_truth() {
    let folder = tempfile::tempdir().unwrap();
    let log = folder.path().join("lap.jsonl");
    let lap = json(&["lap", "--frames", log.to_str().unwrap(), "--json"]);
    let text = std::fs::read_to_string(&log).unwrap();
    let ticks = lap["ticks"].as_u64().unwrap() as usize;
    assert_eq!(text.lines().count(), ticks + 1);
    assert_eq!(text.matches("\"truth\"").count(), ticks + 1);
}
