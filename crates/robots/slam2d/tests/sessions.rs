//! Saved sessions on the command line: continued, summarized, mapped and converted.

use std::fs;
use std::path::{Path, PathBuf};

use bench_support::skip::skip;
use ch16_lab::buildings::Kind;
use ch16_lab::lap::BuiltInWorld;
use pr_geom::SE2;
use robot_io::session::Session;
use robot_io::trajectory::Trajectory;
use serde_json::Value;
use tempfile::TempDir;

use crate::simulated::{building_log, lap_log};
use crate::support::{assert_rejected, json, slam2d};

/// The simulator's lap as a log, whole and in two halves.
struct Lap {
    folder: TempDir,
}

impl Lap {
    fn new() -> Self {
        let folder = TempDir::new().unwrap();
        let lap = Self { folder };
        lap_log(BuiltInWorld::Apartment, &lap.path("whole.jsonl"));
        let text = fs::read_to_string(lap.file("whole.jsonl")).unwrap();
        let lines: Vec<&str> = text.lines().collect();
        let (first, second) = lines.split_at(lines.len() / 2);
        fs::write(lap.file("first.jsonl"), first.join("\n")).unwrap();
        fs::write(lap.file("second.jsonl"), second.join("\n")).unwrap();
        lap
    }

    fn file(&self, name: &str) -> String {
        self.folder.path().join(name).display().to_string()
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn run(&self, log: &str, out: &str, more: &[&str]) -> serde_json::Value {
        let (log, out) = (self.file(log), self.file(out));
        let arguments = ["run", &log, "-o", &out, "--json"];
        json(&[&arguments[..], more].concat())
    }
}

fn lines(path: &Path) -> Vec<String> {
    let text = fs::read_to_string(path).unwrap();
    text.lines().map(str::to_owned).collect()
}

#[test]
fn a_run_in_two_parts_is_the_run_in_one() {
    let lap = Lap::new();
    let whole = lap.run("whole.jsonl", "whole", &[]);
    let first = lap.run("first.jsonl", "first", &[]);
    let folder = lap.file("first");
    let second = lap.run("second.jsonl", "second", &["--continue", &folder]);
    let scans = |run: &serde_json::Value| run["scans"].as_u64().unwrap();
    assert_eq!(scans(&whole), scans(&first) + scans(&second));
    assert_eq!(whole["keyframes"], second["keyframes"]);
    let session = |run: &str| fs::read(lap.path(run).join("session.slam2d")).unwrap();
    assert!(
        session("second") == session("whole"),
        "not a bit is another"
    );
    let poses = |run: &str| lines(&lap.path(run).join("trajectory.tum"));
    assert_eq!(poses("second"), poses("whole"));
    assert_eq!(
        lines(&lap.path("second/keyframes.jsonl")).len() as u64,
        second["keyframes"].as_u64().unwrap()
    );
    let again = lap.file("second.jsonl");
    assert_rejected(
        &[
            "run",
            &again,
            "--continue",
            &lap.file("second/session.slam2d"),
        ],
        "no scan is later than the session's last one",
    );
}

#[test]
fn a_session_is_summarized_mapped_and_converted() {
    let lap = Lap::new();
    let run = lap.run("whole.jsonl", "out", &[]);
    let session = lap.file("out/session.slam2d");
    let info = json(&["info", &session, "--json"]);
    assert_eq!(info, json(&["info", &lap.file("out"), "--json"]));
    assert_eq!(info["keyframes"], run["keyframes"]);
    assert_eq!(info["scans"], run["scans"]);
    assert_eq!(info["refined"], true);
    // The window of the front end is stored exactly: sixteen scans of at most 120 points.
    let (bytes, keyframes) = (info["bytes"].as_u64(), info["keyframes"].as_u64());
    assert!(bytes.unwrap() < 3000 * keyframes.unwrap() + 16 * 120 * 32);
    let (map, of_folder) = (lap.file("map.yaml"), lap.file("folder.yaml"));
    assert!(slam2d(&["map", &session, "-o", &map]).status.success());
    assert!(
        slam2d(&["map", &lap.file("out"), "-o", &of_folder])
            .status
            .success()
    );
    let occupied = |name: &str| {
        let pgm = fs::read(lap.path(name)).unwrap();
        pgm.iter().filter(|pixel| **pixel == 0).count() as f64
    };
    let share = occupied("map.pgm") / occupied("folder.pgm");
    // Filtered scans show the same walls as all beams.
    assert!((0.6..1.6).contains(&share), "{share}");
    let (g2o, tum) = (lap.file("out.g2o"), lap.file("out.tum"));
    assert!(slam2d(&["convert", &session, &g2o]).status.success());
    assert!(slam2d(&["convert", &session, &tum]).status.success());
    assert_eq!(
        fs::read_to_string(&g2o).unwrap(),
        fs::read_to_string(lap.path("out/graph.g2o")).unwrap()
    );
    let keyframes = run["keyframes"].as_u64().unwrap();
    assert_eq!(lines(Path::new(&tum)).len() as u64, keyframes);
    assert_rejected(
        &["convert", &session, "x.clf"],
        "convert a session to .g2o, .graph, .toro or .json, or .tum",
    );
}

#[test]
fn sessions_that_cannot_be_used_end_in_one_line() {
    let lap = Lap::new();
    lap.run("first.jsonl", "out", &[]);
    let good = fs::read(lap.path("out/session.slam2d")).unwrap();
    let write = |name: &str, bytes: &[u8]| {
        fs::write(lap.path(name), bytes).unwrap();
        lap.file(name)
    };
    let mut damaged = good.clone();
    damaged[good.len() / 2] ^= 1;
    let mut newer = good.clone();
    newer[8] = 9;
    fs::create_dir(lap.path("empty_folder")).unwrap();
    let huge = fs::File::create(lap.path("huge.slam2d")).unwrap();
    huge.set_len(1 << 31).unwrap();
    let log = lap.file("second.jsonl");
    for (file, expected) in [
        (
            write("empty.slam2d", b""),
            "empty.slam2d is empty; give a session",
        ),
        (write("foreign.slam2d", b"P5 foreign"), "is not a session"),
        (
            write("cut.slam2d", &good[..good.len() - 9]),
            "copy it again",
        ),
        (
            write("damaged.slam2d", &damaged),
            "is damaged: its checksum does not match",
        ),
        (write("newer.slam2d", &newer), "is a session of version 9"),
        (lap.file("absent.slam2d"), "absent.slam2d: "),
        (lap.file("empty_folder"), "has no session.slam2d"),
        (lap.file("huge.slam2d"), "larger than 512 MB"),
    ] {
        assert_rejected(&["run", &log, "--continue", &file], expected);
        if !file.ends_with("folder") {
            assert_rejected(&["info", &file], expected);
            assert_rejected(&["map", &file, "-o", &lap.file("m.yaml")], expected);
            assert_rejected(&["convert", &file, &lap.file("x.g2o")], expected);
        }
    }
}

#[test]
fn a_log_is_found_on_the_map_of_a_session() {
    let lap = Lap::new();
    lap.run("whole.jsonl", "out", &[]);
    let (folder, log) = (lap.file("out"), lap.file("second.jsonl"));
    let driven = lap.file("out/trajectory.tum");
    let found = lap.file("found.tum");
    for init in [&[][..], &["--init", "anywhere"], &["--init", "9,0.1,170"]] {
        let arguments = [
            "localize", &folder, &log, "-o", &found, "--truth", &driven, "--json",
        ];
        let run = json(&[&arguments[..], init].concat());
        let count = |name: &str| run[name].as_u64().unwrap();
        let localized = count("found") + count("tracking");
        assert_eq!(
            localized + count("doubtful") + count("lost"),
            count("scans")
        );
        assert!(2 * localized > count("scans"), "{init:?}: {localized}");
        assert_eq!(lines(Path::new(&found)).len() as u64, localized);
        // The map was made from the same log. 0.1: scans between keyframes keep the pose of the front end, which slides
        // along the corridor by up to 0.2 m.
        let ate = &run["truth"]["ate"];
        assert!(ate["median"].as_f64().unwrap() < 0.05, "{ate}");
        assert!(ate["rmse"].as_f64().unwrap() < 0.1, "{ate}");
        let poses = run["poses"].as_array().unwrap();
        assert_eq!(poses.len() as u64, count("scans"));
        let last = &poses[poses.len() - 1];
        assert_eq!(last["verdict"], "tracking");
        assert!(last["covariance"][0][0].as_f64().unwrap() > 0.0);
    }
    let stdout = String::from_utf8(slam2d(&["localize", &folder, &log]).stdout).unwrap();
    assert!(
        stdout.contains("found at ") && stdout.contains("localized, "),
        "{stdout}"
    );
    for (arguments, expected) in [
        (
            vec!["localize", &folder, &log, "--init", "1,2"],
            "expected x,y,deg or anywhere",
        ),
        (vec!["localize", &log, &log], "is not a session"),
        (vec!["localize", &folder, "/absent"], "/absent: "),
    ] {
        assert_rejected(&arguments, expected);
    }
}

/// Three points fit in many places, and one in all.
#[test]
fn scans_with_too_few_returns_are_localized_nowhere() {
    let lap = Lap::new();
    lap.run("whole.jsonl", "out", &[]);
    let (folder, log, found) = (
        lap.file("out"),
        lap.file("thin.jsonl"),
        lap.file("found.tum"),
    );
    let text = fs::read_to_string(lap.file("second.jsonl")).unwrap();
    for returns in [None, Some(3), Some(1)] {
        let thin = text.lines().map(|line| {
            let mut frame: Value = serde_json::from_str(line).unwrap();
            let ranges = frame["ranges_m"].as_array_mut().unwrap();
            let (count, kept) = (ranges.len(), returns.unwrap_or(ranges.len()));
            for (beam, range) in ranges.iter_mut().enumerate() {
                if beam * kept % count >= kept {
                    *range = Value::Null;
                }
            }
            format!("{frame}\n")
        });
        fs::write(&log, thin.collect::<String>()).unwrap();
        for init in ["anywhere", "9,0.1,170"] {
            let run = json(&[
                "localize", &folder, &log, "--init", init, "-o", &found, "--json",
            ]);
            let claimed = run["found"].as_u64().unwrap() + run["tracking"].as_u64().unwrap();
            assert_eq!(
                claimed == 0,
                returns.is_some(),
                "{returns:?}, {init}: {claimed}"
            );
            assert_eq!(lines(Path::new(&found)).len() as u64, claimed);
        }
    }
}

#[test]
fn the_log_of_another_building_is_found_nowhere() {
    let folder = TempDir::new().unwrap();
    let file = |name: &str| folder.path().join(name).display().to_string();
    // Two of the same kind: corridors of equal width and length, with different doors and furniture.
    for seed in [301, 302] {
        let log = file(&format!("{seed}.log"));
        building_log(Kind::Hallway, seed, Path::new(&log));
        let text = fs::read_to_string(&log).unwrap();
        let start: Vec<&str> = text.lines().take(90).collect();
        fs::write(file(&format!("start-{seed}.log")), start.join("\n")).unwrap();
    }
    let map = file("map");
    json(&["run", &file("301.log"), "-o", &map, "--json"]);
    let [own, other] = ["start-301.log", "start-302.log"]
        .map(|log| json(&["localize", &map, &file(log), "--json"]));
    assert_eq!(own["found"], 1);
    assert!(own["tracking"].as_u64().unwrap() > 70, "{own}");
    assert_eq!(
        (&other["found"], &other["tracking"]),
        (&0.into(), &0.into())
    );
    assert!(other["lost"].as_u64().unwrap() > 0);
}

/// A recording of a day in `../shared/data/field`, and its true poses.
fn day(name: &str) -> Option<(String, Trajectory)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../../shared/data/field");
    let log = folder.join(format!("{name}.mcap"));
    if !log.is_file() {
        skip(
            name,
            "it is not in ../shared/data/field, beside the repository",
        );
        return None;
    }
    let text = fs::read(folder.join(format!("{name}.truth.tum"))).unwrap();
    let truth = Trajectory::read_tum(&text[..], name).unwrap();
    Some((log.display().to_string(), truth))
}

/// Largest error of the scans of a day on a map that starts at `start`, and their number.
fn largest_error_m(out: &Path, truth: &Trajectory, start: &SE2) -> (f64, usize) {
    let text = fs::read(out.join("trajectory.tum")).unwrap();
    let found = Trajectory::read_tum(&text[..], "trajectory.tum").unwrap();
    let errors_m = truth.poses().iter().filter_map(|right| {
        let pose = found.at(right.stamp_s, 1e-3)?;
        let off = start.between(&right.pose).between(&pose);
        Some(off.x().hypot(off.y()))
    });
    let errors_m: Vec<f64> = errors_m.collect();
    (errors_m.iter().copied().fold(0.0, f64::max), errors_m.len())
}

#[test]
fn another_day_lies_on_the_map_where_the_robot_was_found() {
    let (Some((monday, monday_truth)), Some((tuesday, tuesday_truth))) = (
        day("sessions_small/monday"),
        day("sessions_small/tuesday_elsewhere"),
    ) else {
        return;
    };
    let folder = TempDir::new().unwrap();
    let file = |name: &str| folder.path().join(name).display().to_string();
    assert!(slam2d(&["run", &monday, "-o", &file("M")]).status.success());
    let start = monday_truth.poses()[0].pose;
    let first = start.between(&tuesday_truth.poses()[0].pose);
    // 0.4 m and 10° off, as a person would state it.
    let by_hand = format!(
        "{},{},{}",
        first.x() + 0.4,
        first.y(),
        first.theta().to_degrees() + 10.0
    );
    for (init, most_scans) in [(None, 141), (Some(&by_hand), 5)] {
        let (map, out) = (file("M"), file("both"));
        let mut arguments = vec!["run", &tuesday, "--continue", &map, "-o", &out];
        arguments.extend(init.into_iter().flat_map(|init| ["--init", init]));
        let run = slam2d(&arguments);
        let said = String::from_utf8(run.stderr).unwrap();
        let scans = said
            .split("was found on the session's map after ")
            .nth(1)
            .and_then(|rest| rest.split(' ').next())
            .and_then(|count| count.parse::<usize>().ok());
        assert!(scans.is_some_and(|scans| scans <= most_scans), "{said}");
        // 0.1 m: the limit of a map with odometry; glued to Monday's last pose it is 8.5 m off.
        let out = folder.path().join("both");
        let (monday_m, scans) = largest_error_m(&out, &monday_truth, &start);
        assert!(monday_m < 0.1 && scans > 250, "{monday_m} m, {scans}");
        let (tuesday_m, scans) = largest_error_m(&out, &tuesday_truth, &start);
        assert!(tuesday_m < 0.1 && scans == 141, "{tuesday_m} m, {scans}");
    }
}

#[test]
fn a_robot_that_was_carried_during_a_pause_is_found_on_the_map() {
    let Some((log, truth)) = day("restart/carried_3s_ahead") else {
        return;
    };
    let folder = TempDir::new().unwrap();
    let out = folder.path().join("out").display().to_string();
    let run = slam2d(&["run", &log, "-o", &out]);
    let said = String::from_utf8(run.stderr).unwrap();
    assert!(
        said.contains("motion cannot explain the scans after a gap of 64 s"),
        "{said}"
    );
    let start = truth.poses()[0].pose;
    // 0.1 m: the limit of a map with odometry; as one drive it is 1.07 m off.
    let (error_m, scans) = largest_error_m(Path::new(&out), &truth, &start);
    assert!(error_m < 0.1 && scans == 256, "{error_m} m, {scans}");
}

#[test]
fn a_day_in_another_building_is_mapped_alone() {
    let lap = Lap::new();
    lap_log(BuiltInWorld::Ring, &lap.path("ring.jsonl"));
    let text = fs::read_to_string(lap.file("ring.jsonl")).unwrap();
    let later = text.lines().map(|line| {
        let mut frame: serde_json::Value = serde_json::from_str(line).unwrap();
        let stamp_s = frame["stamp_s"].as_f64().unwrap();
        frame["stamp_s"] = (stamp_s + 86_400.0).into();
        frame.to_string()
    });
    fs::write(lap.file("ring.jsonl"), later.collect::<Vec<_>>().join("\n")).unwrap();
    lap.run("whole.jsonl", "whole", &[]);
    let alone = lap.run("ring.jsonl", "alone", &[]);
    let (log, map, out) = (lap.file("ring.jsonl"), lap.file("whole"), lap.file("both"));
    let run = slam2d(&["run", &log, "--continue", &map, "-o", &out]);
    let said = String::from_utf8(run.stderr).unwrap();
    assert!(
        said.contains("was not found on the session's map: the results cover this log alone")
            && said.contains("--init x,y,deg"),
        "{said}"
    );
    let count = |name: &str| lines(&lap.path(name)).len();
    assert_eq!(count("both/trajectory.tum"), count("alone/trajectory.tum"));
    assert_eq!(
        count("both/keyframes.jsonl") as u64,
        alone["keyframes"].as_u64().unwrap()
    );
    let session = Session::read(
        &fs::read(lap.path("both/session.slam2d")).unwrap()[..],
        "both",
    );
    assert!(session.is_ok(), "{session:?}");
}

#[test]
fn two_robots_are_not_merged_and_the_other_one_is_named() {
    let folder =
        Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../../shared/data/field/two_robots");
    let log = |name: &str| folder.join(name).display().to_string();
    if !folder.is_dir() {
        skip(
            "two_robots",
            "it is not in ../shared/data/field, beside the repository",
        );
        return;
    }
    let out = TempDir::new().unwrap();
    let named = out.path().join("named").display().to_string();
    let run = slam2d(&["run", &log("namespaced.mcap"), "-o", &named]);
    let said = String::from_utf8(run.stderr).unwrap();
    assert!(
        said.contains("there are also scans on /tb3_1/scan, which are not read"),
        "{said}"
    );
    let text = fs::read(folder.join("truth0.tum")).unwrap();
    let truth = Trajectory::read_tum(&text[..], "truth0.tum").unwrap();
    let start = truth.poses()[0].pose;
    // 0.1 m: the limit of a map with odometry; with the scans of both robots as one it is 11 m off.
    let (error_m, scans) = largest_error_m(Path::new(&named), &truth, &start);
    assert!(error_m < 0.1 && scans > 100, "{error_m} m, {scans}");
    let both = slam2d(&["run", &log("namespaced.mcap"), "--all-robots", "-o", &named]);
    let said = String::from_utf8(both.stderr).unwrap();
    assert!(
        said.contains("the robot of /tb3_1/scan was found on the map after 14 scans")
            && said.contains("are 190 s later in the results")
            && !said.contains("there are also scans"),
        "{said}"
    );
    let (error_m, scans) = largest_error_m(Path::new(&named), &truth, &start);
    assert!(error_m < 0.1 && scans > 100, "{error_m} m, {scans}");
    assert_eq!(lines(&Path::new(&named).join("trajectory.tum")).len(), 314);
    let shared = slam2d(&["run", &log("two_drivers_one_topic.mcap"), "--json"]);
    let said = String::from_utf8(shared.stderr).unwrap();
    assert!(
        said.contains("/scan has scans of several publishers")
            && said.contains("those in frame laser_frame are read")
            && said.contains("cover 476°, more than a turn"),
        "{said}"
    );
}
