//! The doctor's report, and the output of a run besides its map.

use std::fs;

use serde_json::Value;
use tempfile::TempDir;

use crate::corridor::{corridor, corridor_with, text};
use crate::support::{assert_rejected, slam2d};

#[test]
fn the_doctor_reports_each_part_of_a_recording_with_a_symbol() {
    let folder = TempDir::new().unwrap();
    let log = corridor(&folder, 40);
    let output = slam2d(&["doctor", text(&log)]);
    assert_eq!(output.status.code(), Some(1));
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
    let report = slam2d(&["doctor", text(&log), "--json"]);
    let report: Value = serde_json::from_slice(&report.stdout).unwrap();
    assert_eq!(
        (&report["sensor"]["scans"], &report["verdict"]),
        (&Value::from(40), &Value::from("wrong"))
    );
    assert_rejected(&["doctor", "/absent"], "/absent: ");
}

#[test]
fn the_doctor_s_exit_code_tells_scripts_whether_to_map() {
    let folder = TempDir::new().unwrap();
    let code = |words: &str| {
        let log = folder.path().join("x.jsonl");
        fs::write(&log, words).unwrap();
        slam2d(&["doctor", text(&log)]).status.code()
    };
    let frame = |range_m: f64| {
        format!(
            r#"{{"stamp_s":1.0,"odometry":[0,0,0],"first_angle_rad":0.0,"angle_step_rad":0.1,"ranges_m":[{range_m},{range_m}]}}"#
        )
    };
    assert_eq!(code(&frame(0.0)), Some(2), "nothing is seen");
    assert_eq!(
        code(&frame(2.0)),
        Some(1),
        "one scan does not check the mounting"
    );
    assert_eq!(code("no log"), Some(2));
}

#[test]
fn the_doctor_names_a_pause_but_not_a_slow_recording() {
    let folder = TempDir::new().unwrap();
    let screen = |stamps_s: &[u32]| {
        let frame = |stamp_s: &u32| {
            format!(
                r#"{{"stamp_s":{stamp_s},"odometry":[0,0,0],"first_angle_rad":0.0,"angle_step_rad":0.1,"ranges_m":[2,2]}}"#
            ) + "\n"
        };
        let log = folder.path().join("x.jsonl");
        fs::write(&log, stamps_s.iter().map(frame).collect::<String>()).unwrap();
        String::from_utf8(slam2d(&["doctor", text(&log)]).stdout).unwrap()
    };
    let paused: Vec<u32> = (0..30).chain(93..120).collect();
    let said = screen(&paused);
    assert!(
        said.contains("there is no scan for 64 s before 93.00 s"),
        "{said}"
    );
    let slow: Vec<u32> = (0..30).map(|number| 60 * number).collect();
    assert!(!screen(&slow).contains("there is no scan"));
}

#[test]
fn the_doctor_names_a_path_that_is_longer_by_odometry_than_on_the_map() {
    let folder = TempDir::new().unwrap();
    let remarks = |scale: f64| {
        let log = corridor_with(&folder, 70, scale);
        let report = slam2d(&["doctor", text(&log), "--odometry", "force", "--json"]);
        let report: Value = serde_json::from_slice(&report.stdout).unwrap();
        report["remarks"].as_array().unwrap().clone()
    };
    let said = |remark: &Value| remark["text"].as_str().unwrap().contains("on the map and");
    let found = remarks(1.6);
    let found = found.iter().find(|remark| said(remark)).unwrap();
    assert_eq!(
        (&found["part"], &found["verdict"], &found["options"][0]),
        (
            &Value::from("odometry"),
            &Value::from("wrong"),
            &Value::from("--no-odometry")
        )
    );
    assert!(!remarks(1.0).iter().any(said));
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
