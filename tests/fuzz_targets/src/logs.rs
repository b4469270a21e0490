//! Recorded logs of every format: read, described, written in other formats, and mapped.

use robot_io::carmen::{CarmenReader, write_carmen};
use robot_io::doctor::Checkup;
use robot_io::info::LogInfo;
use robot_io::json_log::{FrameLine, JsonLogReader};
use robot_io::log::{LogFrame, LogNotes, LogOptions, LogReader};
use robot_io::log_format::LogFormat;
use robot_io::motion::ComparedReader;
use robot_io::run::{LogRun, OdometryUse};

use crate::runs::{assert_finite, assert_loads, drive};
use crate::sentences::{NAME, assert_refusal, assert_sentence};

/// Longer logs are read, but not mapped, because the target is the readers.
const MAX_MAPPED: usize = 6;
/// The same for scans with more beams.
const MAX_BEAMS: usize = 64;

/// An invalid log yields one sentence; a valid one has frames of finite numbers, which can be written and
/// mapped.
pub fn fuzz(bytes: &[u8]) {
    let Some((frames, notes)) = read(bytes, &LogOptions::default()) else {
        return;
    };
    for offer in &notes.offers {
        for name in offer.names.iter().rev().take(1) {
            read(bytes, &LogOptions::default().with(offer.option, name));
        }
    }
    let mut info = LogInfo::default();
    frames.iter().for_each(|frame| info.take(frame));
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
    let saved = drive(&mut LogRun::new(OdometryUse::Log), small);
    saved.iter().for_each(|saved| assert_loads(saved));
}

/// The comparison of scans with odometry yields sentences and finite poses.
fn compare(bytes: &[u8]) {
    let reader =
        LogFormat::open(bytes, NAME, &LogOptions::default()).expect("it was opened before");
    let mut reader = ComparedReader::new(reader, false);
    let mut checkup = Checkup::default();
    while let Some(frame) = reader.next_frame().expect("it was read before") {
        frame.odometry.iter().for_each(assert_finite);
        assert_finite(&frame.scan.body_from_sensor);
        checkup.take(&frame);
    }
    let motion = reader.motion().cloned().unwrap_or_default();
    let screen = checkup.finish(NAME, reader.notes(), &motion).text();
    screen.lines().skip(1).for_each(assert_sentence);
}

/// The frames and notes of a log, or `None` for an error, which must be one sentence.
pub fn read(bytes: &[u8], options: &LogOptions) -> Option<(Vec<LogFrame>, LogNotes)> {
    let told = |refusal: robot_io::log::LogError| assert_refusal(&refusal.to_string());
    let mut reader = LogFormat::open(bytes, NAME, options).map_err(told).ok()?;
    let mut frames = Vec::new();
    while let Some(frame) = reader.next_frame().map_err(told).ok()? {
        assert!(frame.stamp_s.is_finite(), "{frame:?}");
        frame.odometry.iter().for_each(assert_finite);
        assert_finite(&frame.scan.body_from_sensor);
        frames.push(frame);
    }
    let notes = reader.notes();
    // Bytes of a compressed file are counted after decompression.
    let is_packed = bytes.starts_with(b"\x1f\x8b") || bytes.starts_with(b"\x28\xb5\x2f\xfd");
    assert!(is_packed || notes.bytes <= bytes.len() as u64);
    notes
        .sentences(NAME)
        .iter()
        .for_each(|said| assert_refusal(said));
    notes.about.iter().for_each(|said| assert_sentence(said));
    Some((frames, notes.clone()))
}

/// A frame reads back from a JSON line to the same bits, and from a CARMEN line with as many beams.
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
