//! Recorded logs on the command line: their summary, and the errors of a run.

use std::fs;
use std::path::{Path, PathBuf};

use crate::corridor::{corridor, text, write};
use crate::simulated::building_log;
use crate::support::{assert_rejected, json, slam2d};
use ch16_lab::buildings::Kind;
use robot_io::settings::SETTINGS;
use serde_json::Value;
use tempfile::TempDir;

#[test]
fn a_log_is_mapped_and_graded_against_relations() {
    let folder = TempDir::new().unwrap();
    let log = corridor(&folder, 40);
    // The robot drove 3.9 m from the first scan to the last.
    let relations = write(&folder, "relations", "100 139 3.9 0 0 0 0 0\n");
    let (log, relations) = (text(&log), text(&relations));
    let out = folder.path().join("out/deep");
    let run = json(&[
        "run",
        log,
        "-o",
        text(&out),
        "--relations",
        relations,
        "--json",
    ]);
    assert_eq!(run["scans"], 40);
    assert!(run["keyframes"].as_u64().unwrap() > 3);
    assert!(run["cpu_s"].as_f64().unwrap() > 0.0);
    for tenth in ["first", "last"] {
        let ticks = &run["ticks"][tenth];
        let ms = |figure: &str| ticks[figure].as_f64().unwrap();
        assert!(ms("median_ms") > 0.0 && ms("median_ms") <= ms("worst_ms"));
    }
    let error_m = run["relations"]["trans"]["mean"].as_f64().unwrap();
    // Odometry alone is off by 0.39 m; the wall at the end corrects it.
    assert!(error_m < 0.1, "{error_m}");
    let report = fs::read_to_string(out.join("report.txt")).unwrap();
    assert!(report.starts_with("40 scans, "), "{report}");
    let keyframes = run["quality"]["keyframes"].as_array().unwrap();
    assert_eq!(keyframes.len() as u64, run["keyframes"].as_u64().unwrap());
    let last = &keyframes[keyframes.len() - 1]["covariance"];
    assert!(last[0][0].as_f64().unwrap() > 0.0);
    let trajectory = out.join("trajectory.tum");
    let trajectory = text(&trajectory);
    let graded = json(&["evaluate", trajectory, "--relations", relations, "--json"]);
    // The file stores headings as quaternions, which rounds the last digit of an angle.
    assert_eq!(graded["n"], run["relations"]["n"]);
    for (part, figures) in graded.as_object().unwrap() {
        for (figure, value) in figures.as_object().into_iter().flatten() {
            let [expected, again] =
                [&run["relations"][part][figure], value].map(|v| v.as_f64().unwrap());
            assert!(
                (expected - again).abs() <= 1e-12 * expected.abs(),
                "{part}.{figure}: {expected} {again}"
            );
        }
    }
    let fields: Vec<&String> = graded.as_object().unwrap().keys().collect();
    assert_eq!(fields, ["n", "rot2", "rot_deg", "trans", "trans2"]);
    let carried = json(&[
        "evaluate",
        trajectory,
        "--relations",
        relations,
        "--log",
        log,
        "--json",
    ]);
    assert_eq!(carried, graded, "every scan has its own pose already");
    let truth = json(&[
        "evaluate", trajectory, "--truth", trajectory, "--align", "se2", "--json",
    ]);
    assert!(truth["ate"]["max"].as_f64().unwrap() < 1e-9);
}

#[test]
fn failed_window_searches_have_neither_score_nor_chi2() {
    let folder = TempDir::new().unwrap();
    let log = folder.path().join("alike.log");
    let log = text(&log);
    building_log(Kind::Alike, 101, Path::new(log));
    let run = json(&["run", log, "--json"]);
    let tried = run["quality"]["tried"].as_array().unwrap();
    let in_vain: Vec<&Value> = tried
        .iter()
        .filter(|link| {
            let reason = link["reason"].as_str().unwrap_or_default();
            reason.starts_with("no pose within ")
        })
        .collect();
    assert!(!in_vain.is_empty());
    for link in in_vain {
        assert!(link["score"].is_null() && link["chi2"].is_null(), "{link}");
    }
    // Accepted loops have both, and so do the links of the final graph.
    let links = run["quality"]["links"].as_array().unwrap();
    assert!(links.len() > 100, "{}", links.len());
    for link in links {
        assert!(link["score"].as_f64().unwrap() >= 0.6 && link["chi2"].is_number());
    }
}

#[test]
fn without_odometry_the_scans_alone_are_followed() {
    let folder = TempDir::new().unwrap();
    let log = corridor(&folder, 30);
    let relations = write(&folder, "relations", "100 129 2.9 0 0 0 0 0\n");
    let arguments = [
        "run",
        text(&log),
        "--no-odometry",
        "--relations",
        text(&relations),
        "--json",
    ];
    let error_m = json(&arguments)["relations"]["trans"]["mean"]
        .as_f64()
        .unwrap();
    assert!(error_m < 0.1, "{error_m}");
}

#[test]
fn odometry_that_never_moves_is_reported() {
    let folder = TempDir::new().unwrap();
    let whole = fs::read_to_string(corridor(&folder, 40)).unwrap();
    let still: Vec<String> = whole
        .lines()
        .zip(100..)
        .map(|(line, stamp_s)| {
            let scan: Vec<&str> = line.split(' ').take(92).collect();
            format!("{} 0 0 0 0 0 0 {stamp_s} h 0", scan.join(" "))
        })
        .collect();
    let log = write(&folder, "still.clf", &still.join("\n"));
    let warnings = |more: &[&str]| {
        let output = slam2d(&[&["run", text(&log)], more].concat());
        assert!(output.status.success());
        String::from_utf8(output.stderr).unwrap()
    };
    let message = warnings(&[]);
    assert!(
        message.contains("odometry stands still while the scans move by 3."),
        "{message}"
    );
    assert_eq!(warnings(&["--no-odometry"]), "");
}

#[test]
fn the_content_of_a_log_is_summarized() {
    let folder = TempDir::new().unwrap();
    let info = json(&["info", text(&corridor(&folder, 5)), "--json"]);
    assert_eq!(
        (&info["scans"], &info["most_beams"]),
        (&Value::from(5), &Value::from(90))
    );
    assert_eq!(info["records"]["FLASER"], 5);
    assert!((info["odometry_path_length_m"].as_f64().unwrap() - 0.44).abs() < 1e-9);
}

#[test]
fn malformed_lines_are_reported_and_the_rest_is_mapped() {
    let folder = TempDir::new().unwrap();
    let whole = fs::read_to_string(corridor(&folder, 6)).unwrap();
    let mut lines: Vec<&str> = whole.lines().collect();
    lines[2] = "FLASER 90 1 2 three";
    let cut = &lines[5][..200];
    lines[5] = cut;
    let log = write(&folder, "broken.clf", &lines.join("\n"));
    let output = slam2d(&["run", text(&log), "--json"]);
    assert!(output.status.success());
    let stderr = String::from_utf8(output.stderr).unwrap();
    assert!(
        stderr.contains("one line was skipped; the first is line 3: "),
        "{stderr}"
    );
    assert!(
        stderr.contains("the last line, 6, is incomplete"),
        "{stderr}"
    );
    let run: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(run["scans"], 4);
}

#[test]
fn files_that_cannot_be_used_end_in_one_line() {
    let folder = TempDir::new().unwrap();
    let log = corridor(&folder, 3);
    let log = text(&log);
    let empty = write(&folder, "empty.clf", "");
    let prose = write(&folder, "prose.txt", "It was a dark night.\n");
    let far = write(&folder, "far", "5 6 0 0 0 0 0 0\n");
    let tum = write(&folder, "t.tum", "1 0 0 0 0 0 0 1\n2 1 0 0 0 0 0 1\n");
    let in_folder = folder.path().join("bag");
    fs::create_dir(&in_folder).unwrap();
    for (arguments, expected) in [
        (vec!["run", "/absent"], "/absent: "),
        (
            vec!["run", text(&in_folder)],
            "is a folder without a recording of ROS; pass a log",
        ),
        (vec!["run", text(&empty)], "is empty; use a recorded log"),
        (vec!["info", text(&prose)], "is not a CARMEN log; use one"),
        (
            vec!["run", log, "--relations", text(&prose)],
            "line 1: t1 must be a finite number",
        ),
        (
            vec!["run", log, "--relations", text(&far)],
            "none of the 1 relations is within",
        ),
        (
            vec!["evaluate", text(&tum)],
            "use --relations FILE or --truth FILE",
        ),
        (
            vec!["evaluate", log, "--truth", text(&tum)],
            "stamp must be a finite number",
        ),
    ] {
        assert_rejected(&arguments, expected);
    }
}

/// The corridor with several scans at each pose: a slower robot, and more bytes.
fn slow_corridor(folder: &TempDir, times: usize) -> PathBuf {
    let path = corridor(folder, 60);
    let text = fs::read_to_string(&path).unwrap();
    let mut slow = String::new();
    for (number, line) in text.lines().enumerate() {
        let (scan, _) = line.rsplit_once(" h ").unwrap();
        let (scan, _) = scan.rsplit_once(' ').unwrap();
        for step in 0..times {
            let stamp_s = number as f64 + step as f64 / times as f64;
            slow.push_str(&format!("{scan} {stamp_s} h {stamp_s}\n"));
        }
    }
    write(folder, &format!("{times}.clf"), &slow)
}

#[test]
fn memory_grows_with_the_path_and_not_with_the_log() {
    let folder = TempDir::new().unwrap();
    let run = |times: usize| {
        let log = slow_corridor(&folder, times);
        let bytes = fs::metadata(&log).unwrap().len();
        let run = json(&["run", text(&log), "--json"]);
        assert_eq!(run["scans"], 60 * times);
        (run["peak_mb"].as_f64(), bytes as f64 / 1e6)
    };
    let ((Some(small), small_mb), (Some(large), large_mb)) = (run(2), run(200)) else {
        bench_support::skip::skip(
            "memory of a run",
            "the system does not report the memory of a process",
        );
        return;
    };
    assert!(large_mb - small_mb > 7.0, "{large_mb} MB");
    // A scan keeps its pose, which is a tenth of its bytes; 2 MB is an allocator's rounding.
    let growth = large - small;
    assert!(
        growth < 0.2 * (large_mb - small_mb) + 2.0,
        "{growth} MB for {large_mb} MB of log"
    );
}

#[test]
fn the_page_of_parameters_names_exactly_those_that_there_are_with_what_they_do_and_their_units() {
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../docs/robots.md");
    let page = fs::read_to_string(page).unwrap();
    let rows: Vec<Vec<&str>> = page
        .lines()
        .skip_while(|line| !line.starts_with("| parameter |"))
        .take_while(|line| line.starts_with('|'))
        .filter_map(|line| line.strip_prefix("| `"))
        .map(|line| line.split(" | ").collect())
        .collect();
    let names: Vec<&str> = rows
        .iter()
        .map(|row| row[0].trim_end_matches('`'))
        .collect();
    let known: Vec<&str> = SETTINGS.iter().map(|parameter| parameter.name).collect();
    assert_eq!(names, known);
    for (row, parameter) in rows.iter().zip(SETTINGS) {
        assert_eq!(row.len(), 5, "{row:?}");
        assert_eq!(row[1], parameter.about);
        let unit = row[2].split_once(' ').map_or("", |(_, unit)| unit);
        assert_eq!(unit, parameter.unit, "{}", parameter.name);
    }
}
