//! Damaged and split recordings, clouds, and a laser mounting set by the user.

use pr_geom::SE2;
use robot_io::log::LogOptions;
use robot_io::log_bytes::LogBytes;

use super::base::{START_S, messages, mirrored, truth, turned, without};
use super::write::{Body, mcap};
use super::{BY_SCANS_M, Mapped, PER_CHUNK, distance_m, mapped, path, read};

/// Byte range of the first chunk's records.
fn first_chunk(bytes: &[u8]) -> std::ops::Range<usize> {
    let header = 8 + 9 + 12;
    let at = header + usize::from_le_bytes(bytes[9..17].try_into().unwrap()) - 12;
    let length = usize::from_le_bytes(bytes[at + 1..at + 9].try_into().unwrap());
    at + 9 + 40..at + 9 + length
}

#[track_caller]
fn assert_mapped(outcome: &Mapped, least_scans: usize, word: &str) {
    let notes = &outcome.notes;
    assert!(
        outcome.path.len() >= least_scans,
        "{} scans: {notes}",
        outcome.path.len()
    );
    assert!(
        notes.contains(word) && notes.is_empty() == word.is_empty(),
        "{notes}"
    );
    let number = |stamp_s: f64| ((stamp_s - START_S) / 0.25).round() as usize;
    let truth: Vec<SE2> = outcome
        .path
        .iter()
        .map(|(stamp_s, _)| truth()[number(*stamp_s)])
        .collect();
    let off_m = distance_m(&path(outcome), &truth);
    assert!(off_m <= BY_SCANS_M, "{off_m} m: {notes}");
}

#[test]
fn damage_costs_the_chunk_that_it_is_in() {
    let whole = mcap(&messages(), PER_CHUNK);
    let options = LogOptions::default();
    // The first chunk declares the topics; so does the end of the file.
    let chunk = first_chunk(&whole);
    let mut bytes = whole.clone();
    bytes[chunk.start + 400] ^= 0x55;
    assert_mapped(&read(&bytes, &options), 120, "its checksum does not match");
    // A length that covers the next chunks as well.
    let mut bytes = whole.clone();
    bytes[chunk.end + 1 + 2] ^= 0x7f;
    assert_mapped(&read(&bytes, &options), 120, "skipped");
    // A range of zeros, as from a disk that lost a block.
    let mut bytes = whole.clone();
    let middle = whole.len() / 2;
    bytes[middle..middle + 8192].fill(0);
    assert_mapped(&read(&bytes, &options), 110, "skipped");
    assert_mapped(
        &read(&whole[..whole.len() * 2 / 3], &options),
        80,
        "cut off",
    );
}

#[test]
fn split_files_are_one_recording() {
    let all = messages();
    let (first, second) = all.split_at(all.len() / 2);
    let [first, second] = [first, second].map(|part| mcap(part, PER_CHUNK));
    let parts = || vec![LogBytes::from(&first[..]), LogBytes::from(&second[..])];
    assert_mapped(&mapped(parts(), "x", &LogOptions::default()), 130, "");
    // The end of the first file is missing: the second one is still read.
    let cut = &first[..first.len() - 3000];
    let parts = vec![LogBytes::from(cut), LogBytes::from(&second[..])];
    assert_mapped(&mapped(parts, "x", &LogOptions::default()), 125, "skipped");
    let twice = vec![LogBytes::from(&first[..]), LogBytes::from(&first[..])];
    let path = |parts| mapped(parts, "x", &LogOptions::default()).path;
    let once = path(vec![LogBytes::from(&first[..])]);
    assert_eq!(path(twice), once);
    // Two parts of which nothing was written are no reason to refuse the others.
    let empty = LogBytes::from(&first[..60]);
    assert_eq!(
        path(vec![LogBytes::from(&first[..]), empty.clone(), empty]),
        once
    );
}

#[test]
fn a_cloud_of_several_rings_is_cut_by_heights() {
    let mut all = messages();
    for message in &mut all {
        if let Body::Scan(scan) = &message.body {
            let mut points = Vec::new();
            for (beam, &range) in scan.ranges.iter().enumerate() {
                let bearing = scan.angle_min + beam as f32 * scan.angle_increment;
                if range < scan.range_max {
                    points.push([range * bearing.cos(), range * bearing.sin(), 0.1]);
                }
                // The floor, which is not a wall.
                points.push([bearing.cos(), bearing.sin(), -0.4]);
            }
            message.body = Body::Cloud {
                stamp_s: scan.stamp_s,
                frame: scan.frame.clone(),
                points,
            };
        }
    }
    let bytes = mcap(&all, PER_CHUNK);
    let rejected = read(&bytes, &LogOptions::default());
    assert!(
        rejected.path.is_empty() && rejected.notes.contains("--heights LOW,HIGH"),
        "{}",
        rejected.notes
    );
    let options = LogOptions {
        heights_m: Some((0.0, 0.3)),
        ..LogOptions::default()
    };
    assert_mapped(&read(&bytes, &options), 130, "");
}

#[test]
fn the_user_may_set_the_mounting() {
    let mut all = messages();
    turned(&mut all, 180);
    mirrored(&mut all);
    without(&mut all, "/tf_static");
    let options = LogOptions {
        laser: Some("0,0,180,flipped".parse().unwrap()),
        ..LogOptions::default()
    };
    assert_mapped(&read(&mcap(&all, PER_CHUNK), &options), 130, "");
    // A mounting set by the user is kept, and the comparison reports that it is wrong.
    let options = LogOptions {
        laser: Some("0,0,0".parse().unwrap()),
        ..LogOptions::default()
    };
    let outcome = read(&mcap(&all, PER_CHUNK), &options);
    assert!(
        outcome.notes.contains("correct it with --laser 0,0,"),
        "{}",
        outcome.notes
    );
}
