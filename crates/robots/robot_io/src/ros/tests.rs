//! Recordings of the simulator's lap made with other projects' writers, see `recordings/make.py`.

use std::collections::BTreeSet;

use crate::log::{LogError, LogFrame, LogNotes, LogOption, LogOptions};
use crate::log_format::LogFormat;

const FIXTURES: [(&str, &[u8]); 10] = [
    ("plain.mcap", include_bytes!("../../recordings/plain.mcap")),
    ("lz4.mcap", include_bytes!("../../recordings/lz4.mcap")),
    ("zstd.mcap", include_bytes!("../../recordings/zstd.mcap")),
    ("tf.mcap", include_bytes!("../../recordings/tf.mcap")),
    ("cloud.mcap", include_bytes!("../../recordings/cloud.mcap")),
    ("plain.db3", include_bytes!("../../recordings/plain.db3")),
    ("packed.db3", include_bytes!("../../recordings/packed.db3")),
    ("plain.bag", include_bytes!("../../recordings/plain.bag")),
    ("lz4.bag", include_bytes!("../../recordings/lz4.bag")),
    ("bz2.bag", include_bytes!("../../recordings/bz2.bag")),
];

/// The frames that the recordings contain.
const FRAMES: &[u8] = include_bytes!("../../recordings/frames.jsonl");

fn fixture(name: &str) -> &'static [u8] {
    FIXTURES.iter().find(|(known, _)| *known == name).unwrap().1
}

fn read_with(
    bytes: &[u8],
    name: &str,
    options: &LogOptions,
) -> Result<(Vec<LogFrame>, LogNotes), LogError> {
    let mut reader = LogFormat::open(bytes, name, options)?;
    let mut frames = Vec::new();
    while let Some(frame) = reader.next_frame()? {
        frames.push(frame);
    }
    Ok((frames, reader.notes().clone()))
}

fn read(bytes: &[u8], name: &str) -> Result<(Vec<LogFrame>, LogNotes), LogError> {
    read_with(bytes, name, &LogOptions::default())
}

fn simulated() -> Vec<LogFrame> {
    read(FRAMES, "frames.jsonl").unwrap().0
}

#[track_caller]
fn assert_near(value: f64, expected: f64, within: f64, what: &str) {
    assert!(
        (value - expected).abs() <= within,
        "{what}: {value} is not {expected}"
    );
}

#[test]
fn every_recording_holds_the_frames_of_the_simulator() {
    let simulated = simulated();
    assert_eq!(simulated.len(), 24);
    for (name, bytes) in FIXTURES {
        let (frames, notes) = read(bytes, name).unwrap();
        assert_eq!((notes.broken, &notes.truncated), (0, &None), "{name}");
        assert!(notes.warnings.is_empty(), "{name}: {:?}", notes.warnings);
        assert_eq!(notes.bytes, bytes.len() as u64, "{name}");
        assert_eq!(frames.len(), simulated.len(), "{name}");
        for (frame, expected) in frames.iter().zip(&simulated) {
            // 1e-6 s: a time since 1970 in f64 is exact to 0.2 µs.
            assert_near(frame.stamp_s, expected.stamp_s, 1e-6, name);
            let (odometry, expected_pose) = (frame.odometry.unwrap(), expected.odometry.unwrap());
            // 1e-4: the robot moves 0.1 m in the 40 ms around a scan, in which 0.2 µs are lost.
            assert_near(odometry.x(), expected_pose.x(), 1e-4, name);
            assert_near(odometry.y(), expected_pose.y(), 1e-4, name);
            assert_near(odometry.between(&expected_pose).theta(), 0.0, 1e-4, name);
            let mount = frame.scan.body_from_sensor;
            assert_eq!(mount.to_array(), [0.1, 0.0, 0.0], "{name}");
            if name != "cloud.mcap" {
                assert_same_beams(frame, expected, name);
            }
        }
    }
}

/// Scans have 32-bit floats: 1e-6 for angles up to π and ranges up to 6 m.
fn assert_same_beams(frame: &LogFrame, expected: &LogFrame, name: &str) {
    let (scan, other) = (&frame.scan, &expected.scan);
    assert_near(scan.first_angle_rad, other.first_angle_rad, 1e-6, name);
    assert_near(scan.angle_step_rad, other.angle_step_rad, 1e-6, name);
    assert_near(scan.range_max_m, other.range_max_m, 1e-6, name);
    assert_eq!(scan.ranges_m.len(), other.ranges_m.len());
    for (&range_m, &other_m) in scan.ranges_m.iter().zip(&other.ranges_m) {
        assert_near(range_m, other_m, 1e-6, name);
    }
}

#[test]
fn a_cloud_of_one_ring_has_the_points_of_its_scan() {
    let (clouds, _) = read(fixture("cloud.mcap"), "cloud.mcap").unwrap();
    let simulated = simulated();
    assert_eq!(clouds.len(), simulated.len());
    for (cloud, expected) in clouds.iter().zip(&simulated) {
        let points = |frame: &LogFrame| -> Vec<(f64, f64)> {
            let scan = &frame.scan;
            let beams = scan.ranges_m.iter().enumerate();
            let seen = beams.filter(|&(_, &range_m)| scan.is_return(range_m));
            seen.map(|(beam, &range_m)| (scan.bearing_rad(beam), range_m))
                .collect()
        };
        let (found, expected) = (points(cloud), points(expected));
        assert_eq!(found.len(), expected.len());
        for (&(bearing, range_m), &(other, other_m)) in found.iter().zip(&expected) {
            // Coordinates are 32-bit floats.
            assert_near(bearing, other, 1e-5, "bearing");
            assert_near(range_m, other_m, 1e-5, "range");
        }
    }
}

#[test]
fn choices_and_alternatives_are_reported() {
    let (_, notes) = read(fixture("tf.mcap"), "tf.mcap").unwrap();
    assert_eq!(notes.records["/scan sensor_msgs/LaserScan"], 24);
    let about = notes.about.join("; ");
    assert_eq!(
        about,
        "scans come from /scan, in frame laser; \
         odometry comes from /tf, odom to base_link; \
         the laser is at 0.100 m, 0.000 m, 0.00° on base_link; \
         frame base_link is a child of odom; frame laser is a child of base_link"
    );
}

#[test]
fn topics_and_frames_can_be_chosen() {
    let bytes = fixture("plain.mcap");
    let other = LogOptions {
        scan_topic: Some("/rear".to_owned()),
        ..LogOptions::default()
    };
    let error = read_with(bytes, "x.mcap", &other).unwrap_err().to_string();
    assert!(
        error.contains("x.mcap has no usable scan: /rear is not one of /odom"),
        "{error}"
    );
    let elsewhere = LogOptions {
        body_frame: Some("chassis".to_owned()),
        ..LogOptions::default()
    };
    let error = read_with(bytes, "x.mcap", &elsewhere).unwrap_err();
    assert_eq!(
        error.to_string(),
        "x.mcap has no body-frame chassis; it has base_link, laser"
    );
    let missing_topic = LogOptions {
        odometry_topic: Some("/tf".to_owned()),
        ..LogOptions::default()
    };
    let error = read_with(bytes, "x.mcap", &missing_topic).unwrap_err();
    assert_eq!(
        error.to_string(),
        "x.mcap has no odom-topic /tf; it has /odom"
    );
    let of_laser = LogOptions::default()
        .with(LogOption::BodyFrame, "laser")
        .unwrap();
    let (frames, notes) = read_with(bytes, "x.mcap", &of_laser).unwrap();
    assert_eq!(frames[0].scan.body_from_sensor.to_array(), [0.0; 3]);
    let taken = notes.offers.iter().map(|offer| offer.taken.as_deref());
    let taken: Vec<_> = taken.collect();
    assert_eq!(taken, [Some("/scan"), Some("/odom"), None, Some("laser")]);
}

#[test]
fn without_transforms_the_laser_is_assumed_at_the_body_with_a_warning() {
    // The same bytes with another name for the laser's frame in the transforms.
    let mut bytes = fixture("plain.bag").to_vec();
    let name = b"base_link\x05\0\0\0laser";
    let at: Vec<usize> = (0..bytes.len() - name.len())
        .filter(|&at| bytes[at..].starts_with(name))
        .collect();
    assert!(!at.is_empty(), "the transform is where it was");
    for at in at {
        bytes[at + name.len() - 1] = b'z';
    }
    let (frames, notes) = read(&bytes, "x.mcap").unwrap();
    assert_eq!(frames.len(), 24);
    assert_eq!(frames[0].scan.body_from_sensor.to_array(), [0.0; 3]);
    let text = notes.sentences("x.mcap").join(" ");
    assert!(
        text.contains("there is no transform from base_link to laser"),
        "{text}"
    );
}

#[test]
fn recordings_of_other_systems_are_rejected_by_their_encoding() {
    let record = |op: u8, fields: &[&[u8]]| {
        let body = fields.concat();
        [&[op][..], &(body.len() as u64).to_le_bytes(), &body].concat()
    };
    let text = |text: &str| [&(text.len() as u32).to_le_bytes()[..], text.as_bytes()].concat();
    let magic = b"\x89MCAP0\r\n".to_vec();
    let kind = [text("foxglove.SceneUpdate"), text("jsonschema"), text("{}")].concat();
    let channel = [text("/scan"), text("json"), text("")].concat();
    // By the MCAP specification: header, schema 1, its channel 0, a message, end of data, footer.
    let bytes = [
        magic.clone(),
        record(1, &[&text(""), &text("")]),
        record(3, &[&[1, 0], &kind]),
        record(4, &[&[0, 0, 1, 0], &channel]),
        record(5, &[&[0; 22], b"{}"]),
        record(15, &[&[0; 4]]),
        record(2, &[&[0; 20]]),
        magic,
    ]
    .concat();
    let error = read(&bytes, "x.mcap").unwrap_err().to_string();
    assert!(
        error.contains("no ROS messages but, for example, those on /scan with the encoding ‘json’"),
        "{error}"
    );
}

#[test]
fn a_truncated_recording_yields_its_frames_and_reports_its_end() {
    for (name, bytes) in FIXTURES {
        let mut counts = BTreeSet::new();
        for part in 1..40 {
            let cut = &bytes[..bytes.len() * part / 40];
            match read(cut, name) {
                Ok((frames, notes)) => {
                    counts.insert(frames.len());
                    let text = notes.sentences(name).join(" ");
                    // A bag that ends between two records looks complete; a database lacks pages.
                    let is_told = match name.rsplit('.').next() {
                        Some("bag") => true,
                        Some("db3") => text.contains("skipped"),
                        _ => text.contains("cut off at byte"),
                    };
                    assert!(is_told, "{name}: {text}");
                }
                Err(error) => {
                    counts.insert(0);
                    let text = error.to_string();
                    assert!(text.starts_with(name) && !text.contains('\n'), "{text}");
                    assert!(text.contains("expected"), "{text}");
                }
            }
        }
        assert!(counts.len() > 1, "{name}: {counts:?}");
    }
}

#[test]
fn a_wrong_byte_never_panics() {
    for (name, bytes) in FIXTURES {
        let mut rejected = 0;
        for spot in (0..bytes.len()).step_by(bytes.len() / 150) {
            let mut wrong = bytes.to_vec();
            wrong[spot] ^= 0x5a;
            match read(&wrong, name) {
                Ok((_, notes)) => rejected += notes.broken,
                Err(error) => {
                    rejected += 1;
                    let text = error.to_string();
                    assert!(text.starts_with(name) && !text.contains('\n'), "{text}");
                }
            }
        }
        assert!(rejected > 0, "{name}");
    }
}
