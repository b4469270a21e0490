//! Files that were given together, their options, and the doctor's report on them.

use std::fs;
use std::path::Path;

use bench_support::skip::skip;
use log_messages::{MapperReport, Stage};
use robot_io::log::{LogOption, LogOptions, LogReader as _};
use robot_io::log_bytes::LogBytes;
use robot_io::motion::OdometryUse;
use serde_json::Value;
use slam_robot::engine::Engine;
use slam_robot::given::{Given, GivenFile, compared, options};
use slam_robot::update::Update;

use crate::engine::{files, given, of, open};

fn file<'a>(name: &str, text: &'a str) -> GivenFile<'a> {
    GivenFile {
        name: name.to_owned(),
        size_bytes: text.len() as u64,
        bytes: LogBytes::from(text.as_bytes()),
    }
}

#[test]
fn the_files_of_a_folder_are_one_recording_in_the_order_of_its_metadata() {
    let listed = "relative_file_paths:\n  - b_1.db3\n  - b_0.db3\n";
    let folder = |text| {
        vec![
            file("b_0.db3", "0"),
            file("metadata.yaml", text),
            file("b_1.db3", "11"),
        ]
    };
    let given = Given::new(folder(listed)).unwrap();
    assert_eq!(
        (given.name.as_str(), given.size_bytes),
        ("b_1.db3 and 1 more", 3)
    );
    let given = Given::new(folder("")).unwrap();
    assert_eq!(given.name, "b_0.db3 and 1 more");
    let part = Given::new(folder("relative_file_paths:\n  - b_2.db3\n")).unwrap();
    let said = &part.remarks[0].text;
    assert!(said.contains("lists b_2.db3, which is not there"), "{said}");
    let listed_only = vec![file("metadata.yaml", listed), file("b_0.db3-wal", "")];
    let missing = Given::new(listed_only).err().unwrap();
    assert!(
        missing.starts_with("metadata.yaml lists b_1.db3"),
        "{missing}"
    );
    // Alone, it is left to the log reader to reject it.
    assert_eq!(
        Given::new(vec![file("metadata.yaml", listed)])
            .unwrap()
            .name,
        "metadata.yaml"
    );
}

#[test]
fn options_are_those_of_the_command() {
    let choices = options("scan-topic /front\nlaser 0,0,180,flipped\nodometry force").unwrap();
    assert_eq!(choices.scan_topic.as_deref(), Some("/front"));
    assert_eq!(choices.laser.unwrap().option(), "--laser 0,0,180,flipped");
    assert_eq!(choices.odometry, OdometryUse::Force);
    let alone = options("no-odometry").unwrap();
    assert_eq!(alone.odometry, OdometryUse::Ignore);
    for wrong in ["laser 0,0", "speed 3", "odometry maybe"] {
        assert!(options(wrong).is_err(), "{wrong}");
    }
    assert_eq!(options(""), Ok(LogOptions::default()));
    // The page passes on whatever the core has.
    for option in LogOption::ALL {
        let taken = options(&format!("{} ?", option.name()));
        assert!(
            !taken.is_err_and(|said| said.contains("no option")),
            "{option:?}"
        );
    }
}

/// All updates of a log, in order.
fn updates(mut engine: Engine<'_>) -> Vec<Update> {
    let mut updates = engine.updates();
    while engine.step() {
        updates.extend(engine.updates());
    }
    updates.extend(engine.updates());
    updates
}

fn diagnosis(updates: &[Update]) -> Value {
    let sent = updates.iter().find(|update| update.kind() == "diagnosis");
    serde_json::from_str(&sent.unwrap().json()).unwrap()
}

#[test]
fn the_doctor_s_screen_comes_before_the_first_keyframe_and_once() {
    let updates = updates(open(&files().0, "ring.log").unwrap());
    let kinds: Vec<&str> = updates.iter().map(|update| update.kind()).collect();
    let at = |kind: &str| kinds.iter().position(|other| *other == kind).unwrap();
    assert!(at("diagnosis") < at("keyframes") && at("diagnosis") < at("map"));
    assert_eq!(kinds.iter().filter(|kind| **kind == "diagnosis").count(), 1);
    let shares = updates.iter().filter_map(|update| match update {
        Update::Report(MapperReport::Progress(progress)) => Some(progress.share),
        _ => None,
    });
    let shares: Vec<f64> = shares.collect();
    assert!(shares.windows(2).all(|two| two[0] <= two[1]), "{shares:?}");
    let report = diagnosis(&updates);
    assert_eq!(
        (&report["name"], &report["verdict"]),
        (&"ring.log".into(), &"good".into())
    );
}

#[test]
fn a_path_of_another_length_by_odometry_joins_the_doctor_s_screen_after_the_map() {
    let log = String::from_utf8(files().0.clone()).unwrap();
    let lengthened = log.lines().map(|line| {
        let mut words: Vec<String> = line.split(' ').map(str::to_owned).collect();
        // The poses of laser and body, before eight other fields.
        let poses = words.len() - 14;
        for index in [poses, poses + 1, poses + 3, poses + 4] {
            words[index] = (2.0 * words[index].parse::<f64>().unwrap()).to_string();
        }
        words.join(" ") + "\n"
    });
    let log: Vec<u8> = lengthened.collect::<String>().into_bytes();
    let choices = options("odometry force").unwrap();
    let updates = updates(Engine::open(given(&log, "long.log"), &choices).unwrap());
    let screens = updates.iter().filter(|update| update.kind() == "diagnosis");
    let screens: Vec<bool> = screens
        .map(|screen| screen.json().contains("m long on the map and"))
        .collect();
    assert_eq!(screens, [false, true]);
}

#[test]
fn a_turned_laser_is_reported_with_the_options_that_correct_it() {
    let (log, _) = files();
    let choices = options("laser 0,0,180").unwrap();
    let turned = Engine::open(given(log, "ring.log"), &choices).unwrap();
    let told_of_turned = diagnosis(&updates(turned));
    assert_eq!(told_of_turned["laser"], "0,0,180");
    let remarks = told_of_turned["remarks"].as_array().unwrap();
    let wrong = remarks
        .iter()
        .find(|remark| remark["part"] == "mounting")
        .unwrap();
    assert_eq!(wrong["verdict"], "wrong");
    assert_eq!(wrong["options"], serde_json::json!(["--laser 0,0,0"]));
}

#[test]
fn scans_go_alone_if_the_reader_leaves_odometry_out() {
    let (log, _) = files();
    let choices = options("no-odometry").unwrap();
    let alone = updates(Engine::open(given(log, "ring.log"), &choices).unwrap());
    let with = updates(open(log, "ring.log").unwrap());
    let way = |updates: &[Update]| {
        let keyframes = updates.iter().rev().find_map(|update| match update {
            Update::Report(MapperReport::Keyframes(keyframes)) => Some(keyframes),
            _ => None,
        });
        let poses = keyframes.unwrap().iter().map(|keyframe| keyframe.pose);
        poses.collect::<Vec<_>>()
    };
    assert_ne!(way(&alone), way(&with));
}

/// A file of `../shared/data/field` beside the repository; `None` after this was reported.
fn field(name: &str) -> Option<Vec<u8>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../../shared/data/field");
    let bytes = fs::read(folder.join(name)).ok();
    if bytes.is_none() {
        skip(
            "files that people have, in the page",
            "they are not in ../shared/data/field, beside the repository",
        );
    }
    bytes
}

#[test]
fn files_that_people_have_are_mapped_or_named_as_by_the_command() {
    for (name, expected) in [
        ("formats/rostopic_echo_p.csv", ""),
        ("formats/ros2_topic_echo_csv.txt", ""),
        ("formats/breezyslam.dat", ""),
        ("formats/thrun_wean.log", ""),
        ("formats/rplidar_points.csv", ""),
        ("starts_in_the_open/first_20_no_return_noodo.mcap", ""),
        ("deskew/drive_no_wheels_sweep100.mcap", ""),
        ("body/body_behind_108deg.mcap", ""),
        ("restart/carried_3s_ahead.mcap", ""),
        ("two_robots/namespaced.mcap", ""),
        ("formats/git_lfs.bag", "is a Git LFS pointer"),
        ("formats/page.bag", "is a web page"),
        ("formats/cloud.pcd", "is a point cloud in a file"),
        ("formats/mrpt.rawlog", "is a rawlog of MRPT"),
        ("huge/bomb_50M_beams.mcap", "decompresses to more than"),
    ] {
        let Some(bytes) = field(name) else {
            return;
        };
        let mut engine = match open(&bytes, name) {
            Ok(engine) => engine,
            Err(problem) => {
                assert!(
                    problem.contains(expected) && !expected.is_empty(),
                    "{problem}"
                );
                continue;
            }
        };
        while engine.step() {}
        let text = of!(engine.updates(), Progress).problem;
        let is_mapped = engine.stage() == Stage::Done;
        assert_eq!(is_mapped, expected.is_empty(), "{name}: {text}");
        assert!(text.contains(expected), "{name}: {text}");
    }
}

#[test]
fn all_robots_of_a_recording_are_mapped_if_the_reader_wants_so() {
    let Some(bytes) = field("two_robots/namespaced.mcap") else {
        return;
    };
    let of_one = updates(open(&bytes, "two.mcap").unwrap());
    let text = diagnosis(&of_one).to_string();
    assert!(text.contains(r#""--all-robots""#), "{text}");
    let all = options("all-robots").unwrap();
    let of_all = updates(Engine::open(given(&bytes, "two.mcap"), &all).unwrap());
    let scans = |updates: &[Update]| {
        let of_update = |update: &Update| match update {
            Update::Report(MapperReport::Progress(progress)) => progress.scans,
            _ => 0,
        };
        updates.iter().map(of_update).max()
    };
    assert_eq!((scans(&of_one), scans(&of_all)), (Some(157), Some(314)));
}

#[test]
fn a_table_and_the_file_of_its_odometry_are_opened_together() {
    let row = |k: u32| format!("{k},-1,1,1,2,3\n");
    let rows: String = (0..4).map(row).collect();
    let scans = format!("time,angle_min,angle_increment,ranges\n{rows}");
    let odometry = "t,x,y,theta\n0,0,0,0\n3,3,0,0\n";
    let given = Given::new(vec![file("odom.csv", odometry), file("scans.csv", &scans)]).unwrap();
    let mut reader = compared(&given, &LogOptions::default()).unwrap();
    let mut along_m = Vec::new();
    while let Some(frame) = reader.next_frame().unwrap() {
        along_m.push(frame.odometry.unwrap().x());
    }
    assert_eq!(along_m.len(), 4);
    // 1e-12 m: between two poses.
    assert!((along_m[3] - along_m[1] - 2.0).abs() < 1e-12, "{along_m:?}");
}

#[test]
fn a_database_and_its_write_ahead_log_are_read_together() {
    let folder = "folders/killed_recording_wal";
    let (Some(database), Some(log)) = (
        field(&format!("{folder}/ok.db3")),
        field(&format!("{folder}/ok.db3-wal")),
    ) else {
        return;
    };
    let given = |name: &str, bytes: &Vec<u8>| GivenFile {
        name: name.to_owned(),
        size_bytes: bytes.len() as u64,
        bytes: LogBytes::from(bytes.clone()),
    };
    let files = vec![given("ok.db3", &database), given("ok.db3-wal", &log)];
    let mut engine = Engine::open(Given::new(files).unwrap(), &LogOptions::default()).unwrap();
    while engine.step() {}
    let updates = engine.updates();
    assert_eq!(of!(updates, Progress).scans, 80);
}
