//! Recorded logs of every format: read, summarized, converted and mapped.

use robot_io::carmen::{CarmenReader, write_carmen};
use robot_io::doctor::Checkup;
use robot_io::info::LogInfo;
use robot_io::json_log::{FrameLine, JsonLogReader};
use robot_io::log::{LogFrame, LogNotes, LogOptions, LogReader};
use robot_io::log_bytes::LogBytes;
use robot_io::log_format::LogFormat;
use robot_io::motion::ComparedReader;
use robot_io::run::LogRun;

use crate::runs::{assert_finite, assert_loads, drive};
use crate::sentences::{NAME, assert_rejection, assert_sentence};

/// More frames are read, but not mapped: this target tests the readers.
const MAX_MAPPED: usize = 6;
/// Scans with more beams are not mapped either.
const MAX_BEAMS: usize = 64;

/// A log is rejected in one sentence, or yields frames of finite numbers, which can be written and mapped.
pub fn fuzz(bytes: &[u8]) {
    let Some((frames, notes)) = read(bytes, &LogOptions::default()) else {
        return;
    };
    for offer in &notes.offers {
        for name in offer.names.iter().rev().take(1) {
            let options = LogOptions::default().with(offer.option, name);
            read(bytes, &options.expect("any name can be asked for"));
        }
    }
    let mut info = LogInfo::default();
    frames.iter().for_each(|frame| info.add(frame));
    assert!(info.duration_s.is_finite(), "{info:?}");
    assert!(
        info.odometry_path_length_m.is_none_or(f64::is_finite),
        "{info:?}"
    );
    frames.iter().for_each(assert_written);
    let is_small = |frame: &LogFrame| frame.scan.ranges_m.len() <= MAX_BEAMS;
    if frames.len() <= MAX_MAPPED && frames.iter().all(is_small) {
        compare(bytes);
    }
    let small = frames.into_iter().filter(is_small).take(MAX_MAPPED);
    let saved = drive(&mut LogRun::default(), small);
    saved.iter().for_each(|saved| assert_loads(saved));
}

/// The comparison of scans and odometry gives valid sentences and keeps poses within bounds.
fn compare(bytes: &[u8]) {
    let reader =
        LogFormat::open(bytes, NAME, &LogOptions::default()).expect("it was opened before");
    let mut reader = ComparedReader::new(reader, false);
    let mut checkup = Checkup::default();
    while let Some(frame) = reader.next_frame().expect("it was read before") {
        frame.odometry.iter().for_each(assert_finite);
        assert_finite(&frame.scan.body_from_sensor);
        checkup.add(&frame);
    }
    let motion = reader.motion().cloned().unwrap_or_default();
    let screen = checkup.finish(NAME, reader.notes(), &motion).text();
    screen.lines().skip(1).for_each(assert_sentence);
}

/// The frames and notes of a log; `None` after checking that the error is one sentence.
pub fn read(bytes: &[u8], options: &LogOptions) -> Option<(Vec<LogFrame>, LogNotes)> {
    // Bytes of a compressed file are counted after decompression.
    let is_packed = bytes.starts_with(b"\x1f\x8b") || bytes.starts_with(b"\x28\xb5\x2f\xfd");
    let most = if is_packed { usize::MAX } else { bytes.len() };
    read_parts(vec![LogBytes::from(bytes)], most, options)
}

/// As [`read`], of several files, the log's with at most so many bytes.
pub fn read_parts(
    parts: Vec<LogBytes<'_>>,
    most_bytes: usize,
    options: &LogOptions,
) -> Option<(Vec<LogFrame>, LogNotes)> {
    let check = |rejection: robot_io::log::LogError| assert_rejection(&rejection.to_string());
    let opened = LogFormat::open_parts(parts, NAME, options);
    let mut reader = opened.map_err(check).ok()?;
    let mut frames = Vec::new();
    while let Some(frame) = reader.next_frame().map_err(check).ok()? {
        assert!(frame.stamp_s.is_finite(), "{frame:?}");
        frame.odometry.iter().for_each(assert_finite);
        assert_finite(&frame.scan.body_from_sensor);
        frames.push(frame);
    }
    let notes = reader.notes();
    assert!(notes.bytes <= most_bytes as u64);
    notes
        .sentences(NAME)
        .iter()
        .for_each(|said| assert_rejection(said));
    notes.about.iter().for_each(|said| assert_sentence(said));
    Some((frames, notes.clone()))
}

/// A frame survives a round trip through JSON to the same bits, and through CARMEN with the same number of beams.
fn assert_written(frame: &LogFrame) {
    let mut line = Vec::new();
    FrameLine::from(frame)
        .write(&mut line)
        .expect("memory takes it");
    let back = only(JsonLogReader::new(&line[..], NAME));
    assert_eq!(FrameLine::from(&back), FrameLine::from(frame));
    line.clear();
    write_carmen(frame, &mut line).expect("memory takes it");
    let back = only(CarmenReader::new(&line[..], NAME));
    assert_eq!(back.scan.ranges_m.len(), frame.scan.ranges_m.len());
    assert_eq!(back.odometry, frame.odometry);
}

fn only(mut reader: impl LogReader) -> LogFrame {
    let frame = reader.next_frame().expect("what was written can be read");
    frame.expect("a line was written")
}
