//! Recordings that are read while they are made, as a robot's connection gives them: one pass over the bytes.

use std::fs;

use robot_io::live::queue;
use robot_io::log::{LogError, LogFrame, LogOption, LogOptions, LogReader};
use robot_io::log_format::LogFormat;
use robot_io::motion::ComparedReader;

use super::PER_CHUNK;
use super::base::{START_S, as_transforms, messages, scans, shift_stamps, transform, without};
use super::field::folder;
use super::write::{Body, Message, mcap};
use bench_support::skip::skip;

/// Recordings without faults, with their messages in the order in which the robot sent them.
const CLEAN: [&str; 4] = [
    "base/base.mcap",
    "odom/tf_static_below_odom.mcap",
    "foxglove/laser_scan_json.mcap",
    "foxglove/laser_scan_protobuf.mcap",
];

/// Frames and sentences of a reader, or its error.
fn read_all(mut reader: Box<dyn LogReader + '_>) -> (Vec<LogFrame>, String) {
    let mut frames = Vec::new();
    loop {
        match reader.next_frame() {
            Ok(Some(frame)) => frames.push(frame),
            Ok(None) => return (frames, reader.notes().sentences("x").join("\n")),
            Err(problem) => return (frames, problem.to_string()),
        }
    }
}

fn live(bytes: &[u8], options: &LogOptions) -> (Vec<LogFrame>, String) {
    read_all(LogFormat::open_live(bytes, "x", options))
}

fn live_messages(all: &[Message]) -> (Vec<LogFrame>, String) {
    live(&mcap(all, PER_CHUNK), &LogOptions::default())
}

fn assert_same_as_the_file(bytes: &[u8], name: &str) {
    let options = LogOptions::default();
    let (frames, notes) = live(bytes, &options);
    let (of_file, of_notes) = read_all(LogFormat::open(bytes, name, &options).unwrap());
    assert!(!frames.is_empty(), "{name}: {notes}");
    assert_eq!(frames.len(), of_file.len(), "{name}: {notes}");
    for (number, (one, other)) in frames.iter().zip(&of_file).enumerate() {
        // The text tells unset ranges, which are NaN, from others.
        let is_same = format!("{one:?}") == format!("{other:?}");
        assert!(is_same, "{name}: {number} of {}", frames.len());
    }
    assert_eq!(notes, of_notes, "{name}");
}

#[test]
fn a_recording_without_faults_has_the_same_frames_live() {
    let all = messages();
    assert_same_as_the_file(&mcap(&all, PER_CHUNK), "odometry");
    let mut by_transforms = all;
    as_transforms(&mut by_transforms);
    assert_same_as_the_file(&mcap(&by_transforms, PER_CHUNK), "transforms");
}

#[test]
fn the_recordings_of_the_field_without_faults_have_the_same_frames_live() {
    if !folder().is_dir() {
        return skip(
            "recordings without faults, read while they are made",
            "they are not in ../shared/data/field, beside the repository",
        );
    }
    for name in CLEAN {
        assert_same_as_the_file(&fs::read(folder().join(name)).unwrap(), name);
    }
}

/// The records of a recording, with its first bytes and its last ones.
fn records(bytes: &[u8]) -> Vec<&[u8]> {
    const MAGIC: usize = 8;
    let (mut from, mut at) = (0, MAGIC);
    let mut records = Vec::new();
    while at + MAGIC < bytes.len() {
        let length = bytes[at + 1..at + 9].try_into().unwrap();
        at += 9 + usize::try_from(u64::from_le_bytes(length)).unwrap();
        let is_last = at + MAGIC == bytes.len();
        let end = if is_last { bytes.len() } else { at };
        records.push(&bytes[from..end]);
        from = end;
    }
    records
}

#[test]
fn a_reader_that_is_called_at_each_record_has_the_same_frames() {
    let all = messages();
    let mut bare = all.clone();
    without(&mut bare, "/odom");
    for all in [all, bare] {
        let bytes = mcap(&all, 1);
        let options = LogOptions::default();
        let compared = |reader| Box::new(ComparedReader::new(reader, false));
        let (expected, notes) = read_all(compared(LogFormat::open_live(&bytes[..], "x", &options)));
        let (feeder, feed) = queue::stream(false);
        let mut reader = compared(LogFormat::open_live(feed, "x", &options));
        let (mut frames, mut waits) = (Vec::new(), 0);
        let records = records(&bytes);
        let (last, earlier) = records.split_last().unwrap();
        for record in earlier {
            feeder.add(record.to_vec());
            loop {
                match reader.next_frame() {
                    Ok(Some(frame)) => frames.push(frame),
                    Err(LogError::Waiting) => break waits += 1,
                    other => panic!("{other:?}"),
                }
            }
        }
        assert_eq!(waits, earlier.len());
        feeder.add(last.to_vec());
        drop(feeder);
        let (rest, notes_at_the_end) = read_all(reader);
        frames.extend(rest);
        assert_eq!(format!("{frames:?}"), format!("{expected:?}"));
        assert_eq!(notes_at_the_end, notes);
    }
}

#[test]
fn a_transform_that_comes_after_mapping_has_begun_is_said() {
    let mut all = messages();
    let (frames, notes) = live_messages(&all);
    assert!(!notes.contains("transform"), "{notes}");
    let mounted = all.remove(0);
    assert_eq!(mounted.topic, "/tf_static");
    // After a second of the drive it is early enough, at its end it is not.
    for (at, is_late) in [(30, false), (all.len(), true)] {
        let mut late = all.clone();
        late.insert(at, mounted.clone());
        let (again, notes) = live_messages(&late);
        assert_eq!(again.len(), frames.len());
        let is_said = notes.contains("the transform to the laser came after mapping had begun");
        assert_eq!(is_said, is_late, "{at}: {notes}");
    }
}

#[test]
fn a_clock_that_is_set_back_goes_on() {
    let mut all = messages();
    shift_stamps(&mut all, START_S + 30.0, -500.0);
    let (frames, notes) = live_messages(&all);
    assert_eq!(frames.len(), live_messages(&messages()).0.len());
    let steps = frames.windows(2).map(|two| two[1].stamp_s - two[0].stamp_s);
    let steps: Vec<f64> = steps.collect();
    // Scans are recorded a quarter of a second apart.
    assert!(steps.iter().all(|step_s| (step_s - 0.25).abs() < 1e-3));
    assert!(frames.iter().all(|frame| frame.odometry.is_some()));
    assert!(
        notes.contains("used as they came") && notes.contains("map the recording again"),
        "{notes}"
    );
}

#[test]
fn a_topic_of_scans_may_appear_later_than_all_others() {
    let mut all = messages();
    let is_early = |message: &Message| {
        matches!(message.body, Body::Scan(_)) && message.recorded_s < START_S + 40.0
    };
    all.retain(|message| !is_early(message));
    let (frames, notes) = live_messages(&all);
    let scans = all.iter().filter(|message| message.topic == "/scan");
    assert_eq!(frames.len(), scans.count(), "{notes}");
    assert!(frames.iter().all(|frame| frame.odometry.is_some()));
}

#[test]
fn odometry_that_ends_does_not_keep_scans_waiting() {
    let mut all = messages();
    all.retain(|message| message.topic != "/odom" || message.recorded_s < START_S + 20.0);
    let bytes = mcap(&all, PER_CHUNK);
    let mut reader = LogFormat::open_live(&bytes[..], "x", &LogOptions::default());
    let mut bare = 0;
    while let Some(frame) = reader.next_frame().unwrap() {
        bare += usize::from(frame.odometry.is_none());
    }
    let scans = all.iter().filter(|message| message.topic == "/scan");
    let late = scans.filter(|message| message.recorded_s > START_S + 20.1);
    assert_eq!(bare, late.count());
}

#[test]
fn of_two_lasers_one_is_read_and_the_option_names_the_other() {
    let mut all = messages();
    let mut second = all.clone();
    second.retain(|message| message.topic == "/scan");
    scans(&mut second, |_, scan| scan.frame = "rear".to_owned());
    for message in &mut second {
        message.topic = "/rear".to_owned();
    }
    all.extend(second);
    all.sort_by(|a, b| a.recorded_s.total_cmp(&b.recorded_s));
    let (frames, notes) = live_messages(&all);
    assert_eq!(frames.len(), live_messages(&messages()).0.len());
    assert!(notes.contains("choose with --scan-topic /rear"), "{notes}");
    // Once a transform connects both, a file's scans are merged.
    all.insert(
        0,
        transform("/tf_static", "base_link", "rear", [0.0; 3], START_S - 1.0),
    );
    let (_, notes) = live_messages(&all);
    assert!(
        notes.contains("scans of /rear are not merged with those of /scan while the robot drives"),
        "{notes}"
    );
    let rear = LogOptions::default()
        .with(LogOption::ScanTopic, "/rear")
        .unwrap();
    let (frames, notes) = live(&mcap(&all, PER_CHUNK), &rear);
    assert!(!frames.is_empty() && notes.is_empty(), "{notes}");
}

#[test]
fn without_scans_the_topics_are_listed() {
    let mut all = messages();
    without(&mut all, "/scan");
    let (frames, notes) = live_messages(&all);
    assert!(frames.is_empty() && notes.contains("/odom"), "{notes}");
}
