//! The doctor's verdict on recordings, whichever scan they start with.
//!
//! The recordings have no licence and are not part of the project. If the folder with the reference data is absent,
//! these tests report it and pass.

use std::collections::VecDeque;
use std::fs;
use std::path::PathBuf;

use bench_support::skip::{NO_RECORDED_LOGS, skip};
use pr_geom::SE2;
use robot_io::log::{LogError, LogFrame, LogNotes, LogOptions, LogReader};
use robot_io::log_bytes::LogBytes;
use robot_io::log_format::LogFormat;
use robot_io::motion::{ComparedReader, Finding, MotionComparison, OdometryUse};

/// Scans that are read: more than the doctor compares.
const MOST_SCANS: usize = 2100;
/// Scans left out at the start.
const STARTS: [usize; 5] = [0, 1, 2, 3, 5];

/// Frames that were read before.
pub struct Frames {
    pub frames: VecDeque<LogFrame>,
    pub notes: LogNotes,
}

impl LogReader for Frames {
    fn next_frame(&mut self) -> Result<Option<LogFrame>, LogError> {
        Ok(self.frames.pop_front())
    }

    fn notes(&self) -> &LogNotes {
        &self.notes
    }
}

fn data() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../../../shared/data")
}

/// The first scans of a recording below the folder with the reference data.
pub fn frames(name: &str) -> Vec<LogFrame> {
    let bytes = fs::read(data().join(name)).unwrap();
    let mut reader =
        LogFormat::open(LogBytes::from(&bytes[..]), name, &LogOptions::default()).unwrap();
    let mut frames = Vec::new();
    while frames.len() < MOST_SCANS
        && let Some(frame) = reader.next_frame().unwrap()
    {
        frames.push(frame);
    }
    frames
}

/// The comparison of scans and odometry, with its trials.
fn motion(frames: impl IntoIterator<Item = LogFrame>) -> MotionComparison {
    let frames = Frames {
        frames: frames.into_iter().collect(),
        notes: LogNotes::default(),
    };
    let mut reader = ComparedReader::new(Box::new(frames), false);
    reader.next_frame().unwrap();
    reader.motion().cloned().unwrap()
}

/// One word for each finding.
fn words(motion: &MotionComparison) -> Vec<&'static str> {
    let word = |finding: &Finding| match finding {
        Finding::Mirrored { .. } => "mirrored",
        Finding::Turned { .. } => "turned",
        Finding::Unit { .. } => "unit",
        Finding::Scale { .. } => "scale",
        Finding::Still { .. } => "still",
        Finding::Unlike { .. } => "unlike",
        Finding::Late { .. } => "late",
        Finding::TurnScale { .. } => "turns",
        Finding::Opposed { .. } => "opposed",
        Finding::Backward => "backward",
        Finding::Swept { .. } => "swept",
    };
    motion.faults().iter().map(word).collect()
}

/// Every `every`-th beam.
pub fn thinned(frame: &LogFrame, every: usize) -> LogFrame {
    let mut frame = frame.clone();
    let ranges = frame.scan.ranges_m.iter().step_by(every);
    frame.scan.ranges_m = ranges.copied().collect();
    frame.scan.angle_step_rad *= every as f64;
    frame.scan.beam_interval_s *= every as f64;
    frame
}

/// The recording from its end to its start.
pub fn reversed(frames: &[LogFrame]) -> Vec<LogFrame> {
    let last_s = frames.last().map_or(0.0, |frame| frame.stamp_s);
    let turned = frames.iter().rev().map(|frame| LogFrame {
        stamp_s: last_s - frame.stamp_s,
        ..frame.clone()
    });
    turned.collect()
}

pub fn given_logs() -> Option<Vec<String>> {
    let mut names: Vec<String> = fs::read_dir(data().join("logs"))
        .ok()?
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .filter(|name| name.contains(".clf"))
        .map(|name| format!("logs/{name}"))
        .collect();
    names.sort();
    Some(names)
}

/// Recordings below the folder with the reference data, and what is wrong with each.
pub const FIELD: [(&str, &[&str]); 12] = [
    ("field/base/base.mcap", &[]),
    ("field/lidars/two_topics.mcap", &[]),
    ("field/mount/backward_untold.mcap", &["turned"]),
    ("field/mount/child_not_in_tree.mcap", &[]),
    ("field/mount/mirrored_driver.mcap", &["mirrored"]),
    ("field/mount/static_last.mcap", &[]),
    ("field/odom/millimetres_odom.mcap", &["unit"]),
    ("field/odom/starts_half_way_odom.mcap", &[]),
    ("field/odom/tf_stamps_zero.mcap", &[]),
    ("field/odom/tf_static_below_odom.mcap", &[]),
    ("field/turns_scaled/turns_x1.6.mcap", &["turns"]),
    ("field/beams_backward_in_time/rev.mcap", &["backward"]),
];

/// A log with one scan per metre, which cannot be matched without odometry: its mounting cannot be checked.
const SPARSE: &str = "logs/csail.clf";

/// What is wrong with a given log: the odometry of the mine's is 0.16 s early, also backwards.
fn fault_of_log(name: &str) -> &'static [&'static str] {
    if name.contains("mines_exp1") {
        &["late"]
    } else {
        &[]
    }
}

#[test]
fn the_verdict_is_the_same_whichever_scan_a_recording_starts_with() {
    let Some(logs) = given_logs() else {
        return skip("the doctor's verdict on recorded logs", NO_RECORDED_LOGS);
    };
    let logs = logs.into_iter().map(|name| {
        let faults = fault_of_log(&name);
        (name, faults)
    });
    let field = FIELD.map(|(name, faults)| (name.to_owned(), faults));
    for (name, faults) in logs.chain(field) {
        let all = frames(&name);
        let of_laser = ["turned", "mirrored"];
        let is_mounted = !faults.iter().any(|fault| of_laser.contains(fault));
        for start in STARTS {
            let motion = motion(all[start..].iter().cloned());
            assert_eq!(words(&motion), faults, "{name} from {start}: {motion:?}");
            // Of some starts, too few scans match for a trial without odometry to mean something.
            if name != SPARSE {
                assert_eq!(motion.suggestions(), [], "{name} from {start}");
            }
            assert_eq!(
                motion.confirms_mounting(),
                is_mounted && name != SPARSE,
                "{name} from {start}: {motion:?}"
            );
        }
    }
}

#[test]
fn a_good_log_is_left_alone_with_every_fourth_beam_backwards_and_from_its_middle() {
    let Some(logs) = given_logs() else {
        return skip("the doctor's verdict on recorded logs", NO_RECORDED_LOGS);
    };
    for name in logs {
        let all = frames(&name);
        let ways = [
            all.iter().map(|frame| thinned(frame, 4)).collect(),
            reversed(&all),
            all[all.len() / 2..].to_vec(),
        ];
        for (way, frames) in ways.into_iter().enumerate() {
            let motion = motion(frames);
            assert_eq!(
                words(&motion),
                fault_of_log(&name),
                "{name}, way {way}: {motion:?}"
            );
        }
    }
}

#[test]
fn a_laser_turned_by_hand_loses_against_the_right_one() {
    let Some(_) = given_logs() else {
        return skip("the doctor's verdict on recorded logs", NO_RECORDED_LOGS);
    };
    let mut all = frames("logs/intel.clf");
    for frame in &mut all {
        let mount = &mut frame.scan.body_from_sensor;
        *mount = *mount * SE2::new(0.0, 0.0, 42_f64.to_radians());
    }
    let motion = motion(all);
    let [(Finding::Turned { by_rad }, Some(costs))] = motion.findings() else {
        panic!("{motion:?}");
    };
    // 3°: the comparison's accuracy on this log is 1.6°.
    assert!((by_rad.to_degrees() + 42.0).abs() < 3.0, "{motion:?}");
    assert!(costs.wins, "{costs:?}");
}

#[test]
fn odometry_that_is_trusted_is_neither_dropped_nor_converted() {
    let Some(_) = given_logs() else {
        return skip("the doctor's verdict on recorded logs", NO_RECORDED_LOGS);
    };
    let mut all = frames("logs/intel.clf");
    let origin = all[0].odometry;
    for frame in &mut all {
        frame.odometry = origin;
    }
    let found = |odometry| {
        let frames = Frames {
            frames: all.iter().cloned().collect(),
            notes: LogNotes::default(),
        };
        let mut reader = ComparedReader::new(Box::new(frames), false).with_odometry(odometry);
        let first = reader.next_frame().unwrap().unwrap();
        (words(reader.motion().unwrap()), first.odometry)
    };
    assert_eq!(found(OdometryUse::Check), (vec!["still"], None));
    assert_eq!(found(OdometryUse::Force), (vec![], origin));
}

#[test]
fn mirrored_odometry_is_right_once_it_is_mirrored_back() {
    let Some(_) = given_logs() else {
        return skip("the doctor's verdict on recorded logs", NO_RECORDED_LOGS);
    };
    let mirrored = |frame: LogFrame| LogFrame {
        odometry: frame
            .odometry
            .map(|pose| SE2::new(pose.x(), -pose.y(), -pose.theta())),
        ..frame
    };
    let all: VecDeque<LogFrame> = frames("logs/intel.clf").into_iter().map(mirrored).collect();
    let found = |odometry| {
        let frames = Frames {
            frames: all.clone(),
            notes: LogNotes::default(),
        };
        let mut reader = ComparedReader::new(Box::new(frames), false).with_odometry(odometry);
        reader.next_frame().unwrap();
        let options = reader.notes().warnings.iter();
        let options: Vec<String> = options.flat_map(|remark| remark.options.clone()).collect();
        (words(reader.motion().unwrap()), options)
    };
    let (faults, options) = found(OdometryUse::Check);
    assert_eq!(faults, ["mirrored"]);
    assert!(
        options.contains(&"--odometry mirrored".to_owned()),
        "{options:?}"
    );
    assert_eq!(found(OdometryUse::Mirrored), (vec![], vec![]));
}
