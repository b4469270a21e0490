//! Small recordings modelled on public reports, each with one fault.
//!
//! They are in `../shared/data/field` next to the repository; if they are absent, this test reports it and passes.

use std::fs;
use std::path::{Path, PathBuf};

use bench_support::skip::skip;
use pr_geom::SE2;
use robot_io::graph_file::GraphFile;
use robot_io::log::LogOptions;
use robot_io::log_bytes::LogBytes;
use robot_io::trajectory::Trajectory;

use super::{Mapped, distance_m, mapped, path};

/// Largest error of a map with odometry, and of one by scans alone, m.
const WITH_ODOMETRY_M: f64 = 0.1;
const BY_SCANS_M: f64 = 0.15;
/// Stamp of the first scan; the others follow every half second.
const START_S: f64 = 1_700_000_000.0;

/// Each recording: largest error (m), least number of scans, and a word of the remark.
const VERDICTS: [(&str, f64, usize, &str); 22] = [
    ("base/base.mcap", WITH_ODOMETRY_M, 240, ""),
    (
        "containers/index_length_lies.bag",
        WITH_ODOMETRY_M,
        240,
        "the length of an index",
    ),
    (
        "containers/one_damaged_chunk.mcap",
        WITH_ODOMETRY_M,
        210,
        "a chunk is damaged",
    ),
    (
        "containers/rosbag2_db3/rosbag2_db3.db3",
        WITH_ODOMETRY_M,
        66,
        "",
    ),
    ("containers/topic_order.mcap", WITH_ODOMETRY_M, 240, ""),
    ("containers/whole_file.mcap.zstd", WITH_ODOMETRY_M, 240, ""),
    ("lidars/two_topics.mcap", WITH_ODOMETRY_M, 240, ""),
    (
        "mount/backward_untold.mcap",
        WITH_ODOMETRY_M,
        240,
        "--laser 0,0,180",
    ),
    (
        "mount/child_not_in_tree.mcap",
        WITH_ODOMETRY_M,
        240,
        "base_link is connected to it",
    ),
    (
        "mount/mirrored_driver.mcap",
        WITH_ODOMETRY_M,
        240,
        "--laser 0,0,0,flipped",
    ),
    ("mount/static_last.mcap", WITH_ODOMETRY_M, 240, ""),
    (
        "odom/millimetres_odom.mcap",
        WITH_ODOMETRY_M,
        240,
        "millimetres",
    ),
    (
        "odom/starts_half_way_odom.mcap",
        BY_SCANS_M,
        240,
        "120 of 240 scans have no odometry",
    ),
    (
        "odom/tf_stamps_zero.mcap",
        WITH_ODOMETRY_M,
        240,
        "have no stamp",
    ),
    ("odom/tf_static_below_odom.mcap", WITH_ODOMETRY_M, 240, ""),
    (
        "stamps/one_future_odom.mcap",
        WITH_ODOMETRY_M,
        240,
        "2 of 480 poses of /odom",
    ),
    (
        "stamps/pairs_swapped.mcap",
        WITH_ODOMETRY_M,
        240,
        "sorted by stamp",
    ),
    (
        "stamps/scan_clock_+3600.mcap",
        WITH_ODOMETRY_M,
        240,
        "differ by 3600.0 s",
    ),
    ("tinc/ns.mcap", WITH_ODOMETRY_M, 240, "time_increment"),
    ("units/degrees.mcap", WITH_ODOMETRY_M, 240, "degrees"),
    (
        "units/inc_half.mcap",
        WITH_ODOMETRY_M,
        240,
        "angle_increment",
    ),
    (
        "units/min_gt_max_inc_positive.mcap",
        WITH_ODOMETRY_M,
        240,
        "angle_increment",
    ),
];

pub fn folder() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../../../shared/data/field")
}

fn truth() -> Option<Vec<SE2>> {
    let file = fs::read(folder().join("truth.tum")).ok()?;
    let truth = Trajectory::read_tum(&file[..], "truth.tum").unwrap();
    Some(truth.poses().iter().map(|at| at.pose).collect())
}

fn bytes(path: &Path) -> Vec<u8> {
    fs::read(path).unwrap_or_else(|problem| panic!("{}: {problem}", path.display()))
}

#[test]
fn every_recording_of_the_field_is_mapped_and_its_fault_named() {
    let Some(truth) = truth() else {
        return skip(
            "recordings with the faults that people report",
            "they are not in ../shared/data/field, beside the repository",
        );
    };
    for (name, most_m, least_scans, word) in VERDICTS {
        let outcome = mapped_log(&bytes(&folder().join(name)), name);
        assert!(
            outcome.path.len() >= least_scans,
            "{name}: {} scans: {}",
            outcome.path.len(),
            outcome.notes
        );
        assert!(outcome.notes.contains(word), "{name}: {}", outcome.notes);
        assert_eq!(
            outcome.notes.is_empty(),
            word.is_empty(),
            "{name}: {}",
            outcome.notes
        );
        let number = |stamp_s: f64| ((stamp_s - START_S) * 2.0).round() as usize;
        let of_truth: Vec<SE2> = outcome
            .path
            .iter()
            .map(|(stamp_s, _)| truth[number(*stamp_s)])
            .collect();
        let off_m = distance_m(&path(&outcome), &of_truth);
        assert!(off_m <= most_m, "{name}: {off_m} m: {}", outcome.notes);
    }
}

#[test]
fn a_log_whose_stamps_have_six_digits_keeps_its_scans() {
    let Some(truth) = truth() else {
        return skip(
            "a log whose stamps have six digits",
            "it is not in ../shared/data/field, beside the repository",
        );
    };
    let name = "carmen/six_digit_stamps.log";
    let log = bytes(&folder().join(name));
    let outcome = mapped_log(&log, name);
    assert_eq!(outcome.path.len(), truth.len());
    assert!(
        outcome.notes.contains("too few digits"),
        "{}",
        outcome.notes
    );
    // The remaining error is due to the laser's field of view of half a turn: good stamps give the same map.
    let good = mapped_log(&with_good_stamps(&log), name);
    assert_eq!(good.notes, "");
    let (poses, good) = (path(&outcome), path(&good));
    // 1e-6 m: the stamps have no other effect.
    assert!(distance_m(&poses, &good) < 1e-6);
    let off_m = distance_m(&poses, &truth);
    assert!(off_m < 0.1, "{off_m} m");
}

#[test]
fn the_other_files_of_the_field_are_read_or_rejected_by_name() {
    if truth().is_none() {
        return skip(
            "graphs, trajectories and a map without returns",
            "they are not in ../shared/data/field, beside the repository",
        );
    }
    let of = |name: &str| bytes(&folder().join(name));
    let outcome = mapped_log(&of("map/hall_inf.mcap"), "hall_inf.mcap");
    assert_eq!(outcome.path.len(), 60, "{}", outcome.notes);
    let graph = GraphFile::read(&of("g2o/edges_only.g2o"), "edges_only.g2o");
    assert!(graph.is_ok());
    let space = GraphFile::read(&of("g2o/se3.g2o"), "se3.g2o");
    let message = space.err().unwrap().to_string();
    assert!(message.contains("three-dimensional"), "{message}");
    let read = |name: &str| Trajectory::read_tum(&of(name)[..], name);
    let plain = read("tum/t.tum").unwrap();
    assert_eq!(read("tum/commas.tum").unwrap().poses(), plain.poses());
    assert!(read("tum/est.tum").is_ok());
    // Its nanoseconds overflowed, so its order is lost: it is neither a log nor a trajectory.
    let message = read("tum/euroc.csv").unwrap_err().to_string();
    assert!(message.contains("overflowed 32 bits"), "{message}");
    let message = mapped_log(&of("tum/euroc.csv"), "euroc.csv").notes;
    assert!(
        message.starts_with("euroc.csv is a trajectory"),
        "{message}"
    );
}

fn mapped_log(bytes: &[u8], name: &str) -> Mapped {
    mapped(vec![LogBytes::from(bytes)], name, &LogOptions::default())
}

/// The same CARMEN log with its original stamps: two scans per second.
fn with_good_stamps(log: &[u8]) -> Vec<u8> {
    let text = std::str::from_utf8(log).unwrap();
    let lines = text.lines().enumerate().map(|(number, line)| {
        let mut words: Vec<&str> = line.split(' ').collect();
        let stamp = (0.5 * number as f64).to_string();
        let last = words.len() - 1;
        for at in [last - 2, last] {
            words[at] = &stamp;
        }
        words.join(" ") + "\n"
    });
    lines.collect::<String>().into_bytes()
}
