//! Sweeps that take longer than the time between two scans.

use ch16_lab::sweeping::SweepCase;
use robot_io::json_log::write_frames;
use robot_io::log::LogOptions;
use robot_io::log_bytes::LogBytes;

use super::{Mapped, mapped};

/// A drive in a hall with sweeps of this share of the time between two scans.
fn swept(share: f64) -> Mapped {
    let case = SweepCase {
        share,
        turn_rad_s: 0.6,
        ..SweepCase::default()
    };
    let mut lines = Vec::new();
    let (frames, truth) = case.recording();
    write_frames(frames.into_iter().zip(truth), &mut lines).unwrap();
    let lines = vec![LogBytes::from(&lines[..])];
    mapped(lines, "x.jsonl", &LogOptions::default())
}

#[test]
fn scans_of_several_revolutions_are_named_and_full_sweeps_are_not() {
    let notes = swept(3.0).notes;
    assert!(
        notes.contains("a sweep takes 3.0 times the time between two scans"),
        "{notes}"
    );
    for share in [0.5, 1.0, 1.25] {
        let notes = swept(share).notes;
        assert!(!notes.contains("a sweep takes"), "{share}: {notes}");
    }
}
