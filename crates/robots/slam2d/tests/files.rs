//! Input and output files: ROS recordings, conversions, maps and reports.

use std::fs;
use std::path::{Path, PathBuf};

use crate::simulated::lap_log;
use crate::support::{assert_rejected, json, slam2d};
use ch16_lab::lap::BuiltInWorld;
use serde_json::Value;
use tempfile::TempDir;

/// A recording of the simulator's lap, see `robot_io/recordings/make.py`.
fn recording(name: &str) -> String {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../robot_io/recordings");
    folder.join(name).display().to_string()
}

fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}

fn in_folder(folder: &TempDir, name: &str) -> String {
    folder.path().join(name).display().to_string()
}

fn runs(arguments: &[&str]) -> String {
    let output = slam2d(arguments);
    let stderr = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{arguments:?}: {stderr}");
    stderr
}

#[test]
fn the_content_of_a_ros_recording_is_summarized() {
    for name in ["zstd.mcap", "lz4.bag"] {
        let info = json(&["info", &recording(name), "--json"]);
        assert_eq!(info["scans"], 24, "{name}");
        assert_eq!(info["records"]["/scan sensor_msgs/LaserScan"], 24);
        assert_eq!(info["records"]["/odom nav_msgs/Odometry"], 48);
        let about = info["about"].as_array().unwrap();
        assert_eq!(about[0], "scans come from /scan, in frame laser");
    }
    assert_rejected(
        &["info", &recording("tf.mcap"), "--scan-topic", "/front"],
        "/front is not one of /scan (sensor_msgs/LaserScan), /tf (tf2_msgs/TFMessage)",
    );
}

#[test]
fn a_run_leaves_trajectory_graph_map_and_report() {
    let folder = TempDir::new().unwrap();
    let out = in_folder(&folder, "run");
    let run = json(&["run", &recording("zstd.mcap"), "-o", &out, "--json"]);
    assert_eq!(run["scans"], 24);
    let keyframes = run["keyframes"].as_u64().unwrap();
    let file = |name: &str| fs::read_to_string(Path::new(&out).join(name)).unwrap();
    assert_eq!(file("trajectory.tum").lines().count(), 24);
    assert_eq!(
        file("graph.g2o").matches("VERTEX_SE2").count() as u64,
        keyframes
    );
    assert_eq!(file("keyframes.jsonl").lines().count() as u64, keyframes);
    let quality: Value = serde_json::from_str(&file("quality.json")).unwrap();
    assert_eq!(
        quality["keyframes"].as_array().unwrap().len() as u64,
        keyframes
    );
    let variance = |keyframe: usize| quality["keyframes"][keyframe]["covariance"][0][0].as_f64();
    assert_eq!(variance(0), Some(0.0));
    assert!(variance(1).unwrap() > 0.0);
    let report = file("report.html");
    assert!(report.contains("24 scans gave") && report.contains("class=\"wall\" d=\"M"));

    let map = in_folder(&folder, "map.yaml");
    runs(&["map", &out, "-o", &map]);
    let yaml = fs::read_to_string(&map).unwrap();
    assert!(
        yaml.contains("image: map.pgm\nmode: trinary\nresolution: 0.05\n"),
        "{yaml}"
    );
    let pgm = fs::read(folder.path().join("map.pgm")).unwrap();
    assert!(pgm.starts_with(b"P5\n"));
    for value in [0, 205, 254] {
        assert!(pgm.contains(&value), "{value}");
    }
    runs(&[
        "map",
        &out,
        "-o",
        &map,
        "--mode",
        "scale",
        "--resolution",
        "0.1",
    ]);
    let yaml = fs::read_to_string(&map).unwrap();
    assert!(
        yaml.contains("image: map.png\nmode: scale\nresolution: 0.1\n"),
        "{yaml}"
    );

    for (arguments, expected) in [
        (
            vec!["map", folder.path().to_str().unwrap(), "-o", &map],
            "has no keyframes.jsonl",
        ),
        (
            vec!["map", &out, "-o", "map.png"],
            "map.png must end in .yaml",
        ),
        (
            vec!["map", &out, "-o", &map, "--mode", "scale", "--image", "pgm"],
            "use --image png",
        ),
        (
            vec!["map", &out, "-o", &map, "--resolution", "0"],
            "not within 0.01 to 1 m",
        ),
    ] {
        assert_rejected(&arguments, expected);
    }
}

#[test]
fn the_simulator_writes_a_log_that_can_be_run() {
    let folder = TempDir::new().unwrap();
    let log = in_folder(&folder, "lap.jsonl");
    lap_log(BuiltInWorld::Apartment, Path::new(&log));
    let info = json(&["info", &log, "--json"]);
    assert_eq!(info["scans"], 130);
    assert_eq!(info["most_beams"], 120);
}

#[test]
fn a_log_in_another_format_has_the_same_frames() {
    let folder = TempDir::new().unwrap();
    let [carmen, lines, tum] = ["x.clf", "x.jsonl", "x.tum"].map(|name| in_folder(&folder, name));
    runs(&["convert", &recording("lz4.mcap"), &carmen]);
    runs(&["convert", &carmen, &lines]);
    runs(&["convert", &recording("lz4.mcap"), &tum]);
    let facts = |log: &str| {
        let info = json(&["info", log, "--json"]);
        [
            "scans",
            "most_beams",
            "median_returns",
            "odometry_path_length_m",
        ]
        .map(|name| info[name].clone())
    };
    let [scans, beams, returns, path_length_m] = facts(&recording("lz4.mcap"));
    for log in [&carmen, &lines] {
        let [other_scans, other_beams, other_returns, other_m] = facts(log);
        assert_eq!(
            (&scans, &beams, &returns),
            (&other_scans, &other_beams, &other_returns)
        );
        // 1e-9: the shortest text of a number reads back to its bits.
        assert!((path_length_m.as_f64().unwrap() - other_m.as_f64().unwrap()).abs() < 1e-9);
    }
    assert_eq!(fs::read_to_string(&tum).unwrap().lines().count(), 24);
    let poses = in_folder(&folder, "poses.json");
    runs(&["convert", &tum, &poses]);
    let poses: Value = serde_json::from_str(&fs::read_to_string(&poses).unwrap()).unwrap();
    assert_eq!(poses.as_array().unwrap().len(), 24);
}

#[test]
fn a_graph_goes_through_toro_and_json_and_solves_to_the_same() {
    let folder = TempDir::new().unwrap();
    let g2o = folder.path().join("x.g2o");
    fs::write(
        &g2o,
        "VERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 1.1 0 0\nVERTEX_SE2 2 2 0.1 0.2\n\
         EDGE_SE2 0 1 1 0 0 10 1 2 20 3 30\nEDGE_SE2 1 2 1 0 0.1 10 0 0 20 0 30\n\
         EDGE_SE2 0 2 2 0.2 0.1 10 0 0 20 0 30\nFIX 0\n",
    )
    .unwrap();
    let [toro, json_file, back] =
        ["x.graph", "x.json", "y.g2o"].map(|name| in_folder(&folder, name));
    runs(&["convert", text(&g2o), &toro]);
    runs(&["convert", &toro, &json_file]);
    runs(&["convert", &json_file, &back]);
    assert_eq!(fs::read(&back).unwrap(), fs::read(&g2o).unwrap());
    let chi2 = |file: &str| json(&["optimize", file, "--json"])["chi2"].clone();
    assert_eq!(chi2(text(&g2o)), chi2(&toro));
    let landmark = fs::read_to_string(&g2o).unwrap() + "VERTEX_XY 9 1 1\n";
    fs::write(&g2o, landmark).unwrap();
    let converted = slam2d(&["convert", text(&g2o), &toro]);
    let said = String::from_utf8(converted.stderr).unwrap();
    assert!(
        converted.status.success() && said.contains("line 8: VERTEX_XY: landmarks are not"),
        "{said}"
    );
}

#[test]
fn impossible_conversions_list_the_possible_ones() {
    let folder = TempDir::new().unwrap();
    let write = |name: &str, bytes: &[u8]| -> PathBuf {
        let path = folder.path().join(name);
        fs::write(&path, bytes).unwrap();
        path
    };
    let graph = write("x.g2o", b"VERTEX_SE2 0 0 0 0\n");
    let empty = write("empty.mcap", b"");
    let half = write("half.bag", b"#ROSBAG V2.0\nxx");
    let out = in_folder(&folder, "out.clf");
    for (input, output, expected) in [
        (
            text(&graph),
            "y.clf",
            "x.g2o cannot be converted to y.clf; convert a pose graph to .g2o",
        ),
        (
            &*recording("zstd.mcap"),
            "y.bag",
            "convert a log to .clf, .jsonl, or .tum",
        ),
        ("x.pdf", "y.clf", "use a log that slam2d run reads"),
        (
            text(&empty),
            &out,
            "empty.mcap is empty; use a recorded log",
        ),
        (
            text(&half),
            &out,
            "half.bag has no usable scan: byte 15: expected a record's header",
        ),
    ] {
        assert_rejected(&["convert", input, output], expected);
    }
    assert!(!Path::new(&out).exists(), "no output without input");
}

#[test]
fn a_topic_or_frame_that_is_not_there_is_named_with_those_that_are() {
    let recording = |name: &str| recording(name);
    for (file, option, expected) in [
        (
            "plain.mcap",
            "--odom-topic",
            "has no odom-topic /nowhere; it has /odom",
        ),
        (
            "lz4.bag",
            "--odom-topic",
            "has no odom-topic /nowhere; it has /odom",
        ),
        (
            "tf.mcap",
            "--odom-frame",
            "has no odom-frame /nowhere; it has odom",
        ),
        (
            "tf.mcap",
            "--body-frame",
            "has no body-frame /nowhere; it has ",
        ),
    ] {
        let file = recording(file);
        for command in ["run", "info"] {
            assert_rejected(&[command, &file, option, "/nowhere"], expected);
        }
    }
}

#[test]
fn a_log_is_never_written_over_by_what_it_becomes() {
    let folder = TempDir::new().unwrap();
    let log = in_folder(&folder, "a.jsonl");
    runs(&["convert", &recording("plain.mcap"), &log]);
    let before = fs::read(&log).unwrap();
    assert_rejected(&["convert", &log, &log], "is both input and output");
    let roundabout = in_folder(&folder, "./a.jsonl");
    assert_rejected(
        &["convert", &log, &roundabout],
        "choose another output file",
    );
    assert_eq!(fs::read(&log).unwrap(), before);
    // An input that cannot be read completely leaves the output unchanged, without temporary files.
    let bad = in_folder(&folder, "bad.log");
    fs::write(&bad, "hello\n").unwrap();
    assert_rejected(&["convert", &bad, &log], "is not a CARMEN log");
    assert_eq!(fs::read(&log).unwrap(), before);
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 2);
}

#[test]
fn unwritable_outputs_are_rejected_before_the_work() {
    let folder = TempDir::new().unwrap();
    let log = recording("plain.mcap");
    let taken = in_folder(&folder, "taken");
    fs::write(&taken, "mine").unwrap();
    assert_rejected(&["run", &log, "-o", &taken], "taken: not a directory");
    assert_eq!(fs::read_to_string(&taken).unwrap(), "mine");
    let below = in_folder(&folder, "taken/deep");
    assert_rejected(&["run", &log, "-o", &below], "not a directory");
    let run = in_folder(&folder, "run");
    runs(&["run", &log, "-o", &run]);
    let nowhere = in_folder(&folder, "nowhere/poses.tum");
    assert_rejected(&["localize", &run, &log, "-o", &nowhere], "No such file");
    // The checks leave no files.
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 2);
    // The folder of a run stands for its session.
    let graph = in_folder(&folder, "graph.g2o");
    runs(&["convert", &run, &graph]);
    let own = Path::new(&run).join("graph.g2o");
    assert_eq!(fs::read(&graph).unwrap(), fs::read(own).unwrap());
    let session = Path::new(&run).join("session.slam2d");
    assert_rejected(
        &["run", text(&session)],
        "is a saved session, not a log of scans",
    );
}

#[test]
fn a_log_without_returns_is_rejected() {
    let folder = TempDir::new().unwrap();
    let log = in_folder(&folder, "blind.jsonl");
    runs(&["convert", &recording("plain.mcap"), &log]);
    let lines: Vec<String> = fs::read_to_string(&log)
        .unwrap()
        .lines()
        .map(|line| {
            let mut frame: Value = serde_json::from_str(line).unwrap();
            for range in frame["ranges_m"].as_array_mut().unwrap() {
                *range = Value::from(0.0);
            }
            frame.to_string()
        })
        .collect();
    fs::write(&log, lines.join("\n")).unwrap();
    let run = in_folder(&folder, "run");
    assert_rejected(
        &["run", &log, "-o", &run],
        "no beam of any keyframe has a range",
    );
    assert!(!Path::new(&run).exists());
}
