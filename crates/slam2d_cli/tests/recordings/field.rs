//! Small recordings after public reports, each with one fault.
//!
//! They lie in `../shared/data/field` beside the repository; where they are absent, this test says so and passes.

use std::fs;
use std::path::{Path, PathBuf};

use measuring::skip::skip;
use pr_geom::SE2;
use robot_io::log::LogOptions;
use robot_io::log_bytes::LogBytes;
use robot_io::trajectory::Trajectory;

use super::{distance_m, mapped};

/// Largest distance of a map with odometry, and of one by scans alone, m.
const WITH_ODOMETRY_M: f64 = 0.1;
const BY_SCANS_M: f64 = 0.15;
/// The first scan was taken then, and the others half a second apart.
const START_S: f64 = 1_700_000_000.0;

/// Each recording: largest distance from the truth (m), scans at least, and a word of what is told.
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
        "base_link leads there",
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

fn folder() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data/field")
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
        let parts = vec![LogBytes::from(bytes(&folder().join(name)))];
        let outcome = mapped(parts, name, &LogOptions::default());
        assert!(
            outcome.path.len() >= least_scans,
            "{name}: {} scans: {}",
            outcome.path.len(),
            outcome.said
        );
        assert!(outcome.said.contains(word), "{name}: {}", outcome.said);
        assert_eq!(
            outcome.said.is_empty(),
            word.is_empty(),
            "{name}: {}",
            outcome.said
        );
        let number = |stamp_s: f64| ((stamp_s - START_S) * 2.0).round() as usize;
        let of_truth: Vec<SE2> = outcome
            .path
            .iter()
            .map(|(stamp_s, _)| truth[number(*stamp_s)])
            .collect();
        let poses: Vec<SE2> = outcome.path.iter().map(|(_, pose)| *pose).collect();
        let off_m = distance_m(&poses, &of_truth);
        assert!(off_m <= most_m, "{name}: {off_m} m: {}", outcome.said);
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
    let parts = vec![LogBytes::from(bytes(&folder().join(name)))];
    let outcome = mapped(parts, name, &LogOptions::default());
    assert_eq!(outcome.path.len(), truth.len());
    assert!(outcome.said.contains("too few digits"), "{}", outcome.said);
    let poses: Vec<SE2> = outcome.path.iter().map(|(_, pose)| *pose).collect();
    // Half a turn of beams: 0.2 m is what such a laser gets here with good stamps, too.
    assert!(distance_m(&poses, &truth) < 0.2);
}
