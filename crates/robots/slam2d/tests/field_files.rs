//! Files that people have, from `../shared/data/field` beside the repository: each is mapped, or rejected in one sentence
//! that names what it is and what to do. Without that folder, these tests report it and pass.

use std::fs;
use std::path::{Path, PathBuf};

use bench_support::skip::skip;
use robot_io::trajectory::Trajectory;
use tempfile::TempDir;

use crate::support::{assert_rejected, json, slam2d};

fn field(name: &str) -> Option<String> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../../shared/data/field");
    let path = folder.join(name);
    if !path.exists() {
        skip(
            "files that people have",
            "they are not in ../shared/data/field, beside the repository",
        );
        return None;
    }
    Some(path.display().to_string())
}

/// Maps a recording, and returns the folder, the number of scans, the largest error (m) and standard error.
fn mapped(name: &str, truth: &str) -> Option<(TempDir, u64, f64, String)> {
    let (log, truth) = (field(name)?, field(truth)?);
    let folder = TempDir::new().unwrap();
    let out = folder.path().join("run").display().to_string();
    let output = slam2d(&[
        "run", &log, "--truth", &truth, "--align", "se2", "-o", &out, "--json",
    ]);
    let errors = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{name}: {errors}");
    let run: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    let error_m = run["truth"]["ate"]["max"].as_f64().unwrap();
    Some((folder, run["scans"].as_u64().unwrap(), error_m, errors))
}

#[test]
fn a_hall_of_two_hectares_has_a_map_of_the_size_asked_for() {
    let name = "bigmap/hall_150x120m";
    let Some((folder, _, error_m, _)) =
        mapped(&format!("{name}.mcap"), &format!("{name}.truth.tum"))
    else {
        return;
    };
    // In one turn the wheels slip by 0.35 m, farther than pairs of a registration's first stage reach: 0.22 m off
    // without a candidate that reaches so far.
    assert!(error_m < 0.1, "{error_m}");
    let head = |name: &str| {
        let bytes = fs::read(folder.path().join("run").join(name)).unwrap();
        String::from_utf8_lossy(&bytes[..20]).into_owned()
    };
    let pgm = head("map.pgm");
    let size: Vec<u64> = pgm
        .split_whitespace()
        .skip(1)
        .take(2)
        .map(|n| n.parse().unwrap())
        .collect();
    assert!(size[0] * size[1] > 4_194_304, "{size:?}");
}

#[test]
fn sweeps_that_fill_the_period_are_mapped_like_instantaneous_ones() {
    for (name, scans) in [
        ("rest_sweep0", 80),
        ("rest_sweep75", 80),
        ("rest_sweep100", 80),
        ("drive_no_wheels_sweep0", 224),
        ("drive_no_wheels_sweep100", 224),
        ("rest12_drive12_wheels_sweep100", 182),
    ] {
        let name = format!("deskew/{name}");
        let Some((folder, mapped_scans, error_m, said)) =
            mapped(&format!("{name}.mcap"), &format!("{name}.truth.tum"))
        else {
            return;
        };
        assert_eq!(mapped_scans, scans, "{name}");
        assert_eq!(said, "", "{name}");
        // 0.03 m: a cell of the thinned scans is 0.05 m. Deskewed by the last velocity, one drive is 0.72 m off.
        assert!(error_m < 0.03, "{name}: {error_m}");
        // 0.4 m: the noise of a robot at rest, summed; deskewed by the last velocity, one at rest moves 11.7 m.
        let true_m = path_m(Path::new(&field(&format!("{name}.truth.tum")).unwrap()));
        let path_m = path_m(&folder.path().join("run/trajectory.tum"));
        assert!((path_m - true_m).abs() < 0.4, "{name}: {path_m}");
    }
}

#[test]
fn the_wheels_of_a_robot_whose_sweep_fills_the_period_are_kept() {
    let Some(log) = field("deskew_real/create3_rplidar_20s.mcap") else {
        return;
    };
    let folder = TempDir::new().unwrap();
    for option in [None, Some("--no-odometry")] {
        let out = folder.path().join("run");
        let mut arguments = vec!["run", &log, "-o", out.to_str().unwrap()];
        arguments.extend(option);
        let run = slam2d(&arguments);
        let said = String::from_utf8_lossy(&run.stderr).into_owned();
        assert!(!said.contains("stands still"), "{said}");
        // 2.5 m by its wheels; scans with their last velocity move by 22 m.
        let path_m = path_m(&out.join("trajectory.tum"));
        assert!((2.2..2.8).contains(&path_m), "{option:?}: {path_m}");
    }
}

/// Length of a trajectory, m.
fn path_m(file: &Path) -> f64 {
    let text = fs::read(file).unwrap();
    let path = Trajectory::read_tum(&text[..], "trajectory.tum").unwrap();
    let steps = path.poses().windows(2);
    steps
        .map(|two| {
            let step = two[0].pose.between(&two[1].pose);
            step.x().hypot(step.y())
        })
        .sum()
}

#[test]
fn the_robots_own_body_is_cut_out_and_said() {
    let name = "body/body_behind_108deg";
    let Some((_, _, error_m, said)) = mapped(&format!("{name}.mcap"), &format!("{name}.truth.tum"))
    else {
        return;
    };
    assert!(error_m < 0.1, "{error_m}");
    assert!(said.contains("see the robot's own body from 0.3"), "{said}");
    // Without odometry as well.
    let (error_m, _) = mapped_alone(name);
    assert!(error_m < 0.15, "{error_m}");
}

#[test]
fn the_floor_before_a_leaning_laser_is_cut_out_and_said() {
    let name = "floor_seen/tilted_3deg";
    let Some((_, _, error_m, said)) = mapped(&format!("{name}.mcap"), &format!("{name}.truth.tum"))
    else {
        return;
    };
    // With the floor in the scans, 1.10 m.
    assert!(error_m < 0.1, "{error_m}");
    assert!(
        said.contains("the laser leans and sees the floor"),
        "{said}"
    );
    let (error_m, said) = mapped_alone(name);
    assert!(error_m < 0.15, "{error_m}");
    assert!(
        said.contains("the laser leans and sees the floor"),
        "{said}"
    );
}

/// Maps a recording from which odometry was removed, and returns the largest error (m) and standard error.
fn mapped_alone(name: &str) -> (f64, String) {
    let (log, truth) = (
        field(&format!("{name}.mcap")).unwrap(),
        field(&format!("{name}.truth.tum")).unwrap(),
    );
    let folder = TempDir::new().unwrap();
    let lines = folder.path().join("alone.jsonl");
    let alone = lines.to_str().unwrap();
    assert!(slam2d(&["convert", &log, alone]).status.success());
    let text = fs::read_to_string(&lines).unwrap();
    let without = text.lines().map(|line| {
        let mut frame: serde_json::Value = serde_json::from_str(line).unwrap();
        frame["odometry"] = serde_json::Value::Null;
        frame.to_string() + "\n"
    });
    fs::write(&lines, without.collect::<String>()).unwrap();
    let output = slam2d(&["run", alone, "--truth", &truth, "--align", "se2", "--json"]);
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    let run: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    (run["truth"]["ate"]["max"].as_f64().unwrap(), said)
}

#[test]
fn a_start_that_sees_nothing_is_skipped_until_it_sees_something() {
    let name = "starts_in_the_open/first_20_no_return_noodo";
    let Some((_, _, error_m, said)) = mapped(&format!("{name}.mcap"), &format!("{name}.truth.tum"))
    else {
        return;
    };
    assert!(error_m < 0.15, "{error_m}");
    assert!(
        said.contains("20 scans without a return before the first one"),
        "{said}"
    );
}

#[test]
fn a_run_that_is_cut_short_says_so_and_replaces_no_whole_one() {
    let Some(log) = field("../logs/mines_exp1.clf.gz") else {
        return;
    };
    let folder = TempDir::new().unwrap();
    let path = |name: &str| folder.path().join(name).display().to_string();
    let (part, run) = (path("part.clf.gz"), path("run"));
    let bytes = fs::read(&log).unwrap();
    // The log can be read up to here.
    fs::write(&part, &bytes[..bytes.len() / 4]).unwrap();
    let files = |folder: &str| -> Vec<Vec<u8>> {
        let names = ["trajectory.tum", "map.pgm", "session.slam2d", "report.html"];
        names
            .iter()
            .map(|name| fs::read(Path::new(folder).join(name)).unwrap())
            .collect()
    };
    let first_doubt = |folder: &str| {
        let text = fs::read_to_string(Path::new(folder).join("report.txt")).unwrap();
        text.lines().nth(3).unwrap().to_owned()
    };
    // Into an empty folder.
    assert_eq!(slam2d(&["run", &part, "-o", &run]).status.code(), Some(2));
    let said = "- the run was cut short after ";
    assert!(first_doubt(&run).starts_with(said), "{}", first_doubt(&run));
    // A whole run replaces it, and stays when another one is cut short.
    assert!(slam2d(&["run", &log, "-o", &run]).status.success());
    assert!(!first_doubt(&run).starts_with(said));
    let whole = files(&run);
    assert_eq!(slam2d(&["run", &part, "-o", &run]).status.code(), Some(2));
    assert!(files(&run) == whole, "the whole result was replaced");
    let beside = format!("{run}/interrupted");
    assert!(first_doubt(&beside).starts_with(said) && files(&beside) != whole);
    assert!(slam2d(&["run", &log, "-o", &run]).status.success());
    assert!(!Path::new(&beside).exists());
}

#[test]
fn folders_that_were_renamed_or_whose_recording_was_killed_are_read_whole() {
    for (folder, word) in [
        ("renamed_file", "my_drive.db3 is read in its place"),
        ("killed_recording_wal", ""),
    ] {
        let Some(path) = field(&format!("folders/{folder}")) else {
            return;
        };
        let info = json(&["info", &path, "--json"]);
        assert_eq!(info["scans"], 80, "{folder}");
        let out = TempDir::new().unwrap();
        let [lines, run] =
            ["x.jsonl", "run"].map(|name| out.path().join(name).display().to_string());
        let output = slam2d(&["convert", &path, &lines]);
        assert!(output.status.success(), "{folder}");
        assert_eq!(fs::read_to_string(&lines).unwrap().lines().count(), 80);
        let output = slam2d(&["run", &path, "-o", &run]);
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(
            output.status.success() && said.contains(word),
            "{folder}: {said}"
        );
    }
    if let Some(path) = field("folders/git_lfs_pointer") {
        assert_rejected(
            &["run", &path],
            "is a Git LFS pointer, not the file itself; fetch the file with git lfs pull",
        );
    }
}

#[test]
fn texts_of_other_programs_are_read() {
    for (name, scans, beams) in [
        ("rostopic_echo_p.csv", 20, 60),
        ("ros2_topic_echo_csv.txt", 20, 60),
        ("breezyslam.dat", 10, 682),
        ("thrun_wean.log", 20, 180),
        ("rplidar_points.csv", 3, 360),
    ] {
        let Some(path) = field(&format!("formats/{name}")) else {
            return;
        };
        let info = json(&["info", &path, "--json"]);
        assert_eq!(info["scans"], scans, "{name}");
        assert_eq!(info["most_beams"], beams, "{name}");
        // Readings of 2 to 3 m in all of them.
        let frames = TempDir::new().unwrap();
        let lines: PathBuf = frames.path().join("x.jsonl");
        let output = slam2d(&["convert", &path, lines.to_str().unwrap()]);
        assert!(output.status.success(), "{name}");
        let text = fs::read_to_string(&lines).unwrap();
        let frame: serde_json::Value = serde_json::from_str(text.lines().next().unwrap()).unwrap();
        let ranges = frame["ranges_m"].as_array().unwrap();
        let is_seen =
            |range: &&serde_json::Value| range.as_f64().is_some_and(|m| (2.0..=3.0).contains(&m));
        assert!(
            ranges.iter().filter(is_seen).count() * 10 > ranges.len() * 9,
            "{name}"
        );
    }
}

#[test]
fn files_that_are_no_log_are_named_with_the_way_to_one() {
    for (name, expected) in [
        ("formats/a.tar", "is an archive; extract it"),
        (
            "formats/cloud.pcd",
            "is a point cloud in a file, not a log of scans; publish it",
        ),
        ("formats/git_lfs.bag", "is a Git LFS pointer"),
        ("formats/map.pbstream", "is a state of Cartographer"),
        ("formats/mrpt.rawlog", "is a rawlog of MRPT"),
        (
            "formats/page.bag",
            "is a web page, not the file itself; download the file again",
        ),
        ("huge/bomb_50M_beams.mcap", "decompresses to more than"),
    ] {
        let Some(path) = field(name) else {
            return;
        };
        assert_rejected(&["run", &path], expected);
    }
}

#[test]
fn graphs_with_few_vertices_are_placed_by_their_edges() {
    let Some(path) = field("g2o/first_vertex_only.g2o") else {
        return;
    };
    let folder = TempDir::new().unwrap();
    let out = folder.path().join("out.g2o");
    let solved = json(&["optimize", &path, "--json", "-o", out.to_str().unwrap()]);
    assert_eq!(solved["nodes"], 96);
    let text = fs::read_to_string(&out).unwrap();
    let last = text.lines().last().unwrap();
    assert_eq!(last, "FIX 0", "GTSAM 4.3 reads no edge after it");
    if let Some(path) = field("g2o/se3.g2o") {
        assert_rejected(&["optimize", &path], "the graph is three-dimensional");
    }
}

/// Each recording with its options: largest error (m), and what `run` and `doctor` say of its fault.
const FAULTS: [(&str, &[&str], f64, &str); 9] = [
    ("lifted/lifted_7m", &[], 0.1, "as if the robot was carried"),
    (
        "lifted/lifted_far_noodo",
        &[],
        0.15,
        "as if the robot was carried",
    ),
    ("gaps_no_wheels/gaps_3s", &[], 0.15, "scans are missing"),
    ("quaternion_zero/quaternion_zero", &[], 0.15, "is 0,0,0,0"),
    (
        "one_stamp/one_stamp_for_all",
        &[],
        0.1,
        "have the same stamp",
    ),
    ("turns_scaled/turns_x1.6", &[], 0.1, "odometry turns by 1.6"),
    (
        "beams_backward_in_time/rev",
        &[],
        0.15,
        "the last one was measured first",
    ),
    (
        "beams_backward_in_time/rev",
        &["--no-odometry"],
        0.15,
        "the last one was measured first",
    ),
    ("foxglove/laser_scan_protobuf", &[], 0.1, ""),
];

#[test]
fn faults_that_strangers_had_are_mended_and_named() {
    for (name, options, most_m, word) in FAULTS {
        let (Some(log), Some(truth)) = (
            field(&format!("{name}.mcap")),
            field(&format!("{name}.truth.tum")),
        ) else {
            return;
        };
        let mut arguments = vec!["run", &log, "--truth", &truth, "--align", "se2", "--json"];
        arguments.extend(options);
        let output = slam2d(&arguments);
        let said = String::from_utf8_lossy(&output.stderr);
        let run: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
        let error_m = run["truth"]["ate"]["max"].as_f64().unwrap();
        assert!(error_m <= most_m, "{name}: {error_m} m: {said}");
        assert!(said.contains(word), "{name}: {said}");
        let mut arguments = vec!["doctor", &log];
        arguments.extend(options);
        let output = slam2d(&arguments);
        let diagnosis = String::from_utf8_lossy(&output.stdout);
        assert!(diagnosis.contains(word), "{name}: {diagnosis}");
    }
}

#[test]
fn the_parts_of_a_split_bag_are_one_recording() {
    let (Some(folder), Some(truth)) = (
        field("split_ros1/drive"),
        field("split_ros1/drive.truth.tum"),
    ) else {
        return;
    };
    let mut parts: Vec<String> = fs::read_dir(&folder)
        .unwrap()
        .map(|entry| entry.unwrap().path().display().to_string())
        .collect();
    parts.sort();
    // In any order.
    parts.reverse();
    let mut scans = Vec::new();
    for logs in [vec![folder.clone()], parts] {
        let mut arguments: Vec<&str> = vec!["run"];
        arguments.extend(logs.iter().map(String::as_str));
        arguments.extend(["--truth", &truth, "--align", "se2", "--json"]);
        let output = slam2d(&arguments);
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{said}");
        let run: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
        assert!(run["truth"]["ate"]["max"].as_f64().unwrap() < 0.1, "{said}");
        scans.push(run["scans"].as_u64().unwrap());
    }
    assert_eq!(scans[0], scans[1]);
}

#[test]
fn tables_and_trajectories_of_strangers_are_read_or_answered() {
    for name in [
        "csv/list_round.csv",
        "csv/list_square.csv",
        "csv/sim_time_rostopic_p.csv",
        "csv/angles_in_the_first_row.csv",
    ] {
        let Some(log) = field(name) else { return };
        let info = json(&["info", &log, "--json"]);
        assert_eq!(info["most_beams"].as_u64().unwrap(), 120, "{name}: {info}");
    }
    let of = |name: &str| field(name).unwrap();
    assert_rejected(
        &["info", &of("csv/degrees_mm_no_header.csv")],
        "pass --columns angle_deg,range_mm,quality,time",
    );
    assert_rejected(&["info", &of("csv/poses_and_scans.json")], "jq -c");
    assert_rejected(&["info", &of("csv/odometry_laser.log")], "‘Odometry 1.5");
    let est = of("evaluate/est.tum");
    for truth in ["gt.tum", "gt_header.csv", "gt_each_line_twice.tum"] {
        let errors = json(&[
            "evaluate",
            &est,
            "--truth",
            &of(&format!("evaluate/{truth}")),
            "--json",
        ]);
        // 0.02 m: the estimate's noise is 0.014 m.
        assert!(
            errors["ate"]["rmse"].as_f64().unwrap() < 0.02,
            "{truth}: {errors}"
        );
    }
    assert_rejected(
        &["evaluate", &est, "--truth", &of("evaluate/gt_kitti.txt")],
        "KITTI",
    );
}
