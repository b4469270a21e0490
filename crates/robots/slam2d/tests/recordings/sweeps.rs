//! Sweeps that take longer than the time between two scans.

use ch16_lab::sweeping::SweepCase;
use pr_geom::SE2;
use robot_io::json_log::write_frames;
use robot_io::log::{LogFrame, LogOptions};
use robot_io::log_bytes::LogBytes;

use super::{Mapped, NEAR_M, distance_m, mapped, path};

/// Amplitude of the turns to and fro that show when the odometry turns, rad.
const WEAVE_RAD: f64 = 0.5;

/// A drive in a hall whose sweeps take this share of the time between two scans.
fn case(share: f64, weave_rad: f64) -> SweepCase {
    SweepCase {
        share,
        turn_rad_s: 0.6,
        weave_rad,
        ..SweepCase::default()
    }
}

fn mapped_after(case: &SweepCase, change: impl Fn(&mut Vec<LogFrame>)) -> (Mapped, Vec<SE2>) {
    let (mut frames, mut truth) = case.recording();
    change(&mut frames);
    truth.truncate(frames.len());
    let mut lines = Vec::new();
    write_frames(frames.into_iter().zip(truth.clone()), &mut lines).unwrap();
    let lines = vec![LogBytes::from(&lines[..])];
    (mapped(lines, "x.jsonl", &LogOptions::default()), truth)
}

fn swept(share: f64) -> Mapped {
    mapped_after(&case(share, 0.0), |_| {}).0
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

#[test]
fn sweeps_of_several_revolutions_whose_beams_have_no_times_are_found() {
    let without_times = |share: f64| {
        mapped_after(&case(share, WEAVE_RAD), |frames| {
            for frame in frames {
                frame.scan.beam_interval_s = 0.0;
            }
        })
    };
    let (found, truth) = without_times(3.0);
    let notes = &found.notes;
    assert!(
        notes.contains("a sweep takes about 3 times the time between two scans, although its beams have no times"),
        "{notes}"
    );
    let off_m = distance_m(&path(&found), &truth);
    assert!(off_m < NEAR_M, "{off_m} m: {notes}");
    for share in [0.0, 1.0] {
        let notes = without_times(share).0.notes;
        assert!(!notes.contains("a sweep takes"), "{share}: {notes}");
    }
}

#[test]
fn scans_stamped_at_their_last_beam_are_named_if_odometry_shows_it() {
    let (found, _) = mapped_after(&case(1.0, WEAVE_RAD), |frames| {
        for k in 1..frames.len() {
            let (stamp_s, odometry) = (frames[k].stamp_s, frames[k].odometry);
            (frames[k - 1].stamp_s, frames[k - 1].odometry) = (stamp_s, odometry);
        }
        frames.pop();
    });
    let notes = &found.notes;
    assert!(
        notes.contains("the scans may be stamped at their last beam"),
        "{notes}"
    );
    let notes = mapped_after(&case(1.0, WEAVE_RAD), |_| {}).0.notes;
    assert_eq!(notes, "");
}
