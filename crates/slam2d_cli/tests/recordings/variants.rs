//! Variants of one simulated drive, each with a fault that people report.

use std::f32::consts::{PI, TAU};
use std::sync::OnceLock;

use pr_geom::SE2;
use robot_io::log::LogOptions;
use robot_io::log_bytes::LogBytes;

use super::write::{Body, Message, Scan, Transform, mcap};
use super::{Outcome, distance_m, drive, mapped};

/// The drive starts then, s.
const START_S: f64 = 1_700_000_000.0;
/// Poses of odometry for each scan.
const PER_SCAN: usize = 5;
/// Messages in a chunk.
const PER_CHUNK: usize = 40;
/// Largest distance from the truth, m; and by scans alone.
const NEAR_M: f64 = 0.1;
const BY_SCANS_M: f64 = 0.15;

/// The drive as a recording without a fault.
fn messages() -> Vec<Message> {
    static MESSAGES: OnceLock<Vec<Message>> = OnceLock::new();
    MESSAGES.get_or_init(recorded).clone()
}

fn recorded() -> Vec<Message> {
    let drive = drive();
    let mut all = vec![transform(
        "/tf_static",
        "base_link",
        "laser",
        [0.0; 3],
        START_S - 1.0,
    )];
    let mut body = SE2::identity();
    for tick in 0..=drive.ticks().len() {
        let frame = drive.frame(tick);
        let motion = frame.odometry.unwrap_or_default();
        let stamp_s = START_S + frame.stamp_s;
        for part in 1..=PER_SCAN {
            let share = part as f64 / PER_SCAN as f64;
            let pose = body * SE2::exp(&(motion.log() * share));
            let at_s = stamp_s - 0.25 * (1.0 - share) - 0.01;
            all.push(odometry(
                "/odom",
                at_s,
                "odom",
                "base_link",
                pose.to_array(),
            ));
        }
        body = body * motion;
        let scan = frame.scan;
        let beams = scan.ranges_m.len() as f32;
        all.push(Message {
            topic: "/scan".to_owned(),
            recorded_s: stamp_s + 0.002,
            body: Body::Scan(Scan {
                stamp_s,
                frame: "laser".to_owned(),
                angle_min: scan.first_angle_rad as f32,
                angle_max: (scan.first_angle_rad as f32)
                    + (beams - 1.0) * scan.angle_step_rad as f32,
                angle_increment: scan.angle_step_rad as f32,
                range_max: scan.range_max_m as f32,
                ranges: scan
                    .ranges_m
                    .iter()
                    .map(|&range_m| range_m as f32)
                    .collect(),
                ..Scan::default()
            }),
        });
    }
    all
}

fn odometry(topic: &str, stamp_s: f64, above: &str, child: &str, pose: [f64; 3]) -> Message {
    Message {
        topic: topic.to_owned(),
        recorded_s: stamp_s + 0.001,
        body: Body::Odometry {
            stamp_s,
            above: above.to_owned(),
            child: child.to_owned(),
            pose,
        },
    }
}

fn transform(topic: &str, parent: &str, child: &str, pose: [f64; 3], stamp_s: f64) -> Message {
    Message {
        topic: topic.to_owned(),
        recorded_s: stamp_s,
        body: Body::Transforms(vec![Transform {
            stamp_s,
            parent: parent.to_owned(),
            child: child.to_owned(),
            pose,
            is_upside_down: false,
        }]),
    }
}

/// Changes every scan; the first argument is its number.
fn scans(all: &mut [Message], mut change: impl FnMut(usize, &mut Scan)) {
    let bodies = all
        .iter_mut()
        .filter_map(|message| match &mut message.body {
            Body::Scan(scan) => Some(scan),
            _ => None,
        });
    bodies
        .enumerate()
        .for_each(|(number, scan)| change(number, scan));
}

/// Changes stamp and pose of every message of odometry.
fn poses(all: &mut [Message], mut change: impl FnMut(usize, &mut f64, &mut [f64; 3])) {
    let bodies = all
        .iter_mut()
        .filter_map(|message| match &mut message.body {
            Body::Odometry { stamp_s, pose, .. } => Some((stamp_s, pose)),
            _ => None,
        });
    bodies
        .enumerate()
        .for_each(|(number, (stamp_s, pose))| change(number, stamp_s, pose));
}

/// The laser turned about its axis by whole beams, counter-clockwise.
fn turned(all: &mut [Message], degrees: i32) {
    scans(all, |_, scan| {
        let beams = scan.ranges.len() as i32;
        let by = (degrees * beams / 360).rem_euclid(beams) as usize;
        scan.ranges.rotate_left(by);
    });
}

/// The beams in the other order.
fn mirrored(all: &mut [Message]) {
    scans(all, |_, scan| {
        // Beam k looks to −π + k·step: its mirror image is beam n − k.
        scan.ranges[1..].reverse();
    });
}

fn without(all: &mut Vec<Message>, topic: &str) {
    all.retain(|message| message.topic != topic);
}

/// Odometry as transforms.
fn as_transforms(all: &mut [Message]) {
    for message in all {
        if let Body::Odometry {
            stamp_s,
            above,
            child,
            pose,
        } = message.body.clone()
        {
            *message = Message {
                recorded_s: message.recorded_s,
                ..transform("/tf", &above, &child, pose, stamp_s)
            };
        }
    }
}

type Change = fn(&mut Vec<Message>);

/// Each variant: what it is, how it is made, how near its map has to be (m), and a word of what is told.
const VARIANTS: &[(&str, Change, f64, &str)] = &[
    ("nothing", |_| {}, NEAR_M, ""),
    (
        "backward, untold",
        |all| {
            turned(all, 180);
            without(all, "/tf_static");
        },
        NEAR_M,
        "--laser 0,0,180",
    ),
    (
        "backward, told otherwise",
        |all| turned(all, 180),
        NEAR_M,
        "--laser 0,0,180",
    ),
    (
        "to the left, untold",
        |all| turned(all, 90),
        NEAR_M,
        "--laser 0,0,90",
    ),
    (
        "to the right, untold",
        |all| turned(all, -90),
        NEAR_M,
        "--laser 0,0,-90",
    ),
    (
        "mirrored",
        |all| mirrored(all),
        NEAR_M,
        "--laser 0,0,0,flipped",
    ),
    (
        "mirrored and backward",
        |all| {
            mirrored(all);
            turned(all, 180);
        },
        NEAR_M,
        ",flipped",
    ),
    (
        "upside down, told",
        |all| {
            mirrored(all);
            if let Body::Transforms(told) = &mut all[0].body {
                told[0].is_upside_down = true;
            }
        },
        NEAR_M,
        "",
    ),
    (
        "static transform at the end",
        |all| {
            turned(all, 180);
            let mut told = all.remove(0);
            if let Body::Transforms(told) = &mut told.body {
                told[0].pose[2] = std::f64::consts::PI;
            }
            all.push(told);
        },
        NEAR_M,
        "",
    ),
    (
        "body of odometry not in the tree",
        |all| {
            for message in all.iter_mut() {
                if let Body::Odometry { child, .. } = &mut message.body {
                    "base_footprint".clone_into(child);
                }
            }
        },
        NEAR_M,
        "base_link leads there",
    ),
    (
        "millimetres",
        |all| {
            poses(all, |_, _, pose| {
                pose[0] *= 1e3;
                pose[1] *= 1e3;
            })
        },
        NEAR_M,
        "millimetres",
    ),
    (
        "centimetres",
        |all| {
            poses(all, |_, _, pose| {
                pose[0] *= 1e2;
                pose[1] *= 1e2;
            })
        },
        NEAR_M,
        "centimetres",
    ),
    (
        "wheels a fifth too large",
        |all| {
            poses(all, |_, _, pose| {
                pose[0] *= 1.2;
                pose[1] *= 1.2;
            })
        },
        BY_SCANS_M,
        "check the radius",
    ),
    (
        "odometry turns the wrong way",
        |all| {
            poses(all, |_, _, pose| {
                pose[1] *= -1.0;
                pose[2] *= -1.0;
            })
        },
        f64::INFINITY,
        "mirror image",
    ),
    (
        "odometry stands still",
        |all| poses(all, |_, _, pose| *pose = [0.0; 3]),
        BY_SCANS_M,
        "stands still",
    ),
    (
        "odometry starts late",
        |all| all.retain(|message| message.topic != "/odom" || message.recorded_s > START_S + 12.0),
        BY_SCANS_M,
        "have no odometry of their time",
    ),
    (
        "odometry ends early",
        |all| all.retain(|message| message.topic != "/odom" || message.recorded_s < START_S + 12.0),
        BY_SCANS_M,
        "have no odometry of their time",
    ),
    (
        "odometry has a gap",
        |all| {
            all.retain(|message| {
                message.topic != "/odom" || (message.recorded_s - START_S - 12.0).abs() > 3.0
            })
        },
        BY_SCANS_M,
        "in gaps",
    ),
    ("no odometry", |all| without(all, "/odom"), BY_SCANS_M, ""),
    (
        "a static transform below odom",
        |all| {
            as_transforms(all);
            all.insert(
                0,
                transform("/tf_static", "odom", "dock", [1.0, 2.0, 0.0], START_S),
            );
        },
        NEAR_M,
        "",
    ),
    (
        "a second odometry that stands still",
        |all| {
            let still: Vec<Message> = all
                .iter()
                .filter(|message| message.topic == "/odom")
                .map(|message| {
                    odometry("/a_odom", message.recorded_s, "odom", "base_link", [0.0; 3])
                })
                .collect();
            all.splice(1..1, still);
        },
        NEAR_M,
        "",
    ),
    (
        "a second odometry of another body",
        |all| {
            let other: Vec<Message> = all
                .iter()
                .filter(|message| message.topic == "/odom")
                .enumerate()
                .map(|(k, message)| {
                    odometry(
                        "/a_odom",
                        message.recorded_s,
                        "odom2",
                        "other_base",
                        [0.1 * k as f64, 0.0, 0.0],
                    )
                })
                .collect();
            all.splice(1..1, other);
        },
        NEAR_M,
        "",
    ),
    (
        "one stamp of odometry in the future",
        |all| {
            poses(all, |number, stamp_s, _| {
                if number == 100 {
                    *stamp_s += 1e6;
                }
            })
        },
        NEAR_M,
        "1 of 650 poses of /odom",
    ),
    (
        "one stamp of odometry in the past",
        |all| {
            poses(all, |number, stamp_s, _| {
                if number == 100 {
                    *stamp_s -= 500.0;
                }
            })
        },
        NEAR_M,
        "1 of 650 poses of /odom",
    ),
    (
        "one stamp of a scan in the future",
        |all| {
            scans(all, |number, scan| {
                if number == 40 {
                    scan.stamp_s += 1e6;
                }
            })
        },
        NEAR_M,
        "1 of 130 scans of /scan",
    ),
    (
        "the first stamp of a scan in the future",
        |all| {
            scans(all, |number, scan| {
                if number == 0 {
                    scan.stamp_s += 1e6;
                }
            })
        },
        NEAR_M,
        "1 of 130 scans of /scan",
    ),
    (
        "the last stamp of odometry in the future",
        |all| {
            poses(all, |number, stamp_s, _| {
                if number == 649 {
                    *stamp_s += 1e6;
                }
            })
        },
        NEAR_M,
        "1 of 650 poses of /odom",
    ),
    (
        "scans without stamps",
        |all| scans(all, |_, scan| scan.stamp_s = 0.0),
        NEAR_M,
        "have no stamp",
    ),
    (
        "transforms without stamps",
        |all| {
            as_transforms(all);
            for message in all.iter_mut() {
                if let Body::Transforms(told) = &mut message.body {
                    told[0].stamp_s = 0.0;
                }
            }
        },
        NEAR_M,
        "have no stamp",
    ),
    (
        "scans change places in pairs",
        |all| {
            let at: Vec<usize> = (0..all.len())
                .filter(|&at| all[at].topic == "/scan")
                .collect();
            for pair in at.chunks_exact(2) {
                let (first, second) = (all[pair[0]].body.clone(), all[pair[1]].body.clone());
                (all[pair[0]].body, all[pair[1]].body) = (second, first);
            }
        },
        NEAR_M,
        "sorted by stamp",
    ),
    (
        "scans an hour ahead",
        |all| scans(all, |_, scan| scan.stamp_s += 3600.0),
        NEAR_M,
        "differ by 3600",
    ),
    (
        "scans seven seconds behind",
        |all| scans(all, |_, scan| scan.stamp_s -= 7.0),
        NEAR_M,
        "differ by 7.",
    ),
    (
        "odometry a day ahead",
        |all| poses(all, |_, stamp_s, _| *stamp_s += 86_400.0),
        NEAR_M,
        "differ by 86400",
    ),
    (
        "simulated time starts again",
        |all| {
            for message in all.iter_mut() {
                let by_s = if message.recorded_s > START_S + 16.0 {
                    -1_699_999_990.0 - 16.0
                } else {
                    -1_699_999_990.0
                };
                match &mut message.body {
                    Body::Scan(scan) => scan.stamp_s += by_s,
                    Body::Odometry { stamp_s, .. } => *stamp_s += by_s,
                    _ => {}
                }
            }
        },
        BY_SCANS_M,
        "steps back by",
    ),
    (
        "simulated time starts again, and the recording's with it",
        |all| {
            for message in all.iter_mut() {
                let by_s = if message.recorded_s > START_S + 16.0 {
                    -1_699_999_990.0 - 16.0
                } else {
                    -1_699_999_990.0
                };
                message.recorded_s += by_s;
                match &mut message.body {
                    Body::Scan(scan) => scan.stamp_s += by_s,
                    Body::Odometry { stamp_s, .. } => *stamp_s += by_s,
                    _ => {}
                }
            }
        },
        BY_SCANS_M,
        "steps back by",
    ),
    (
        "a step of NTP",
        |all| {
            for message in all.iter_mut() {
                let by_s = if message.recorded_s > START_S + 16.0 {
                    -40.0
                } else {
                    0.0
                };
                match &mut message.body {
                    Body::Scan(scan) => scan.stamp_s += by_s,
                    Body::Odometry { stamp_s, .. } => *stamp_s += by_s,
                    _ => {}
                }
            }
        },
        NEAR_M,
        "steps back by 40.0 s",
    ),
    (
        "a small step of NTP",
        |all| {
            for message in all.iter_mut() {
                let by_s = if message.recorded_s > START_S + 16.0 {
                    -0.4
                } else {
                    0.0
                };
                match &mut message.body {
                    Body::Scan(scan) => scan.stamp_s += by_s,
                    Body::Odometry { stamp_s, .. } => *stamp_s += by_s,
                    _ => {}
                }
            }
        },
        NEAR_M,
        "steps back by 0.4 s",
    ),
    (
        "scans half a second ahead of their recording",
        |all| scans(all, |_, scan| scan.stamp_s += 0.5),
        NEAR_M,
        "differ by 0.5 s",
    ),
    (
        "every scan twice",
        |all| {
            let twice = all.iter().flat_map(|message| {
                let count = if message.topic == "/scan" { 2 } else { 1 };
                std::iter::repeat_n(message.clone(), count)
            });
            *all = twice.collect();
        },
        NEAR_M,
        "130 scans of /scan are the one before once more",
    ),
    (
        "stamps in whole seconds",
        |all| {
            scans(all, |_, scan| scan.stamp_s = scan.stamp_s.floor());
            poses(all, |_, stamp_s, _| *stamp_s = stamp_s.floor());
        },
        BY_SCANS_M,
        "the same stamp as the one before",
    ),
    (
        "odometry starts again at zero",
        |all| {
            let mut at_half = None;
            poses(all, |number, _, pose| {
                let now = SE2::new(pose[0], pose[1], pose[2]);
                if number >= 300 {
                    *pose = at_half.get_or_insert(now).between(&now).to_array();
                }
            });
        },
        NEAR_M,
        "odometry jumps 1 time",
    ),
    (
        "one pose of odometry far away",
        |all| {
            poses(all, |number, _, pose| {
                if number == 300 {
                    pose[0] += 500.0;
                }
            })
        },
        NEAR_M,
        "odometry jumps 2 times",
    ),
    (
        "no times of recording",
        |all| {
            all.retain(|message| message.topic != "/odom" || message.recorded_s > START_S + 12.0);
            all.iter_mut().for_each(|message| message.recorded_s = 0.0);
        },
        BY_SCANS_M,
        "have no odometry of their time",
    ),
    (
        "a step of the scans' clock alone",
        |all| {
            scans(all, |number, scan| {
                if number > 60 {
                    scan.stamp_s += 100.0;
                }
            })
        },
        NEAR_M,
        "steps ahead by 100.0 s",
    ),
    (
        "time of a beam in nanoseconds",
        |all| scans(all, |_, scan| scan.time_increment = 1e9 / 1200.0),
        NEAR_M,
        "time_increment",
    ),
    (
        "time of a beam that is the scan's",
        |all| scans(all, |_, scan| scan.time_increment = 0.25),
        NEAR_M,
        "time_increment",
    ),
    (
        "angles in degrees",
        |all| {
            scans(all, |_, scan| {
                scan.angle_min = -180.0;
                scan.angle_max = 177.0;
                scan.angle_increment = 3.0;
            })
        },
        NEAR_M,
        "degrees",
    ),
    (
        "the increment in degrees",
        |all| scans(all, |_, scan| scan.angle_increment = 3.0),
        NEAR_M,
        "degrees",
    ),
    (
        "the increment halved",
        |all| scans(all, |_, scan| scan.angle_increment /= 2.0),
        NEAR_M,
        "angle_increment",
    ),
    (
        "the increment doubled",
        |all| scans(all, |_, scan| scan.angle_increment *= 2.0),
        NEAR_M,
        "angle_increment",
    ),
    (
        "no increment",
        |all| scans(all, |_, scan| scan.angle_increment = 0.0),
        NEAR_M,
        "angle_increment",
    ),
    (
        "an increment that is no number",
        |all| scans(all, |_, scan| scan.angle_increment = f32::NAN),
        NEAR_M,
        "angle_increment",
    ),
    (
        "the ends changed",
        |all| {
            mirrored(all);
            scans(all, |_, scan| {
                scan.angle_min = PI;
                scan.angle_max = -PI + TAU / 120.0;
            });
            turned(all, 0);
        },
        // A sweep the other way round is thinned to other points.
        BY_SCANS_M,
        "angle_increment",
    ),
    (
        "the last angle of twice the sweep",
        |all| scans(all, |_, scan| scan.angle_max = 3.0 * PI),
        NEAR_M,
        "angle_increment is taken",
    ),
    (
        "ranges in millimetres",
        |all| {
            scans(all, |_, scan| {
                scan.ranges.iter_mut().for_each(|range| *range *= 1e3)
            })
        },
        NEAR_M,
        "millimetres",
    ),
    (
        "limits changed",
        |all| {
            scans(all, |_, scan| {
                scan.range_min = scan.range_max;
                scan.range_max = 0.05;
            })
        },
        NEAR_M,
        "range_min",
    ),
    (
        "several echoes",
        |all| scans(all, |_, scan| scan.has_echoes = true),
        NEAR_M,
        "",
    ),
    (
        "sorted by topic",
        |all| all.sort_by_key(|message| message.topic.clone()),
        NEAR_M,
        "",
    ),
    (
        "sorted by topic, scans first",
        |all| all.sort_by_key(|message| std::cmp::Reverse(message.topic.clone())),
        NEAR_M,
        "",
    ),
    (
        "two halves of a laser on two topics",
        |all| {
            let mut rear: Vec<Message> = Vec::new();
            for message in all.iter_mut() {
                if let Body::Scan(scan) = &mut message.body {
                    let beams = scan.ranges.len();
                    let mut other = scan.clone();
                    "rear".clone_into(&mut other.frame);
                    // The rear one looks backward, and a little later.
                    other.ranges = (0..beams / 2)
                        .map(|k| scan.ranges[(k + 3 * beams / 4) % beams])
                        .collect();
                    scan.ranges = scan.ranges[beams / 4..3 * beams / 4].to_vec();
                    for half in [&mut *scan, &mut other] {
                        half.angle_min = -PI / 2.0;
                        half.angle_max =
                            half.angle_min + (beams as f32 / 2.0 - 1.0) * half.angle_increment;
                    }
                    rear.push(Message {
                        topic: "/scan_rear".to_owned(),
                        recorded_s: message.recorded_s,
                        body: Body::Scan(other),
                    });
                }
            }
            all.extend(rear);
            all.sort_by(|a, b| a.recorded_s.total_cmp(&b.recorded_s));
            all.insert(
                0,
                transform(
                    "/tf_static",
                    "base_link",
                    "rear",
                    [0.0, 0.0, std::f64::consts::PI],
                    START_S - 1.0,
                ),
            );
        },
        NEAR_M,
        "",
    ),
];

fn read(bytes: &[u8], options: &LogOptions) -> Outcome {
    mapped(vec![LogBytes::from(bytes)], "x.mcap", options)
}

fn path(outcome: &Outcome) -> Vec<SE2> {
    outcome.path.iter().map(|(_, pose)| *pose).collect()
}

/// Where the robot was.
fn truth() -> &'static [SE2] {
    static TRUTH: OnceLock<Vec<SE2>> = OnceLock::new();
    TRUTH.get_or_init(|| {
        let drive = drive();
        (0..=drive.ticks().len())
            .map(|tick| drive.truth(tick))
            .collect()
    })
}

#[test]
fn every_fault_is_mended_or_named() {
    let mut failures = Vec::new();
    for (name, change, most_m, word) in VARIANTS {
        let mut all = messages();
        change(&mut all);
        let outcome = read(&mcap(&all, PER_CHUNK), &LogOptions::default());
        let scans = outcome.path.len();
        let off_m = if scans == truth().len() {
            distance_m(&path(&outcome), truth())
        } else {
            f64::INFINITY
        };
        let is_told = outcome.said.contains(word) && outcome.said.is_empty() == word.is_empty();
        let is_still_told = is_told || word.is_empty() && *name == "no odometry";
        if off_m > *most_m || !is_still_told {
            failures.push(format!(
                "{name}: {scans} scans, {off_m:.3} m: {}",
                outcome.said
            ));
        }
    }
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

/// Where the first chunk's records begin and end.
fn first_chunk(bytes: &[u8]) -> std::ops::Range<usize> {
    let header = 8 + 9 + 12;
    let at = header + usize::from_le_bytes(bytes[9..17].try_into().unwrap()) - 12;
    let length = usize::from_le_bytes(bytes[at + 1..at + 9].try_into().unwrap());
    at + 9 + 40..at + 9 + length
}

#[track_caller]
fn assert_mapped(outcome: &Outcome, least_scans: usize, word: &str) {
    let said = &outcome.said;
    assert!(
        outcome.path.len() >= least_scans,
        "{} scans: {said}",
        outcome.path.len()
    );
    assert!(
        said.contains(word) && said.is_empty() == word.is_empty(),
        "{said}"
    );
    let number = |stamp_s: f64| ((stamp_s - START_S) / 0.25).round() as usize;
    let truth: Vec<SE2> = outcome
        .path
        .iter()
        .map(|(stamp_s, _)| truth()[number(*stamp_s)])
        .collect();
    let off_m = distance_m(&path(outcome), &truth);
    assert!(off_m <= BY_SCANS_M, "{off_m} m: {said}");
}

#[test]
fn damage_costs_the_chunk_that_it_is_in() {
    let whole = mcap(&messages(), PER_CHUNK);
    let options = LogOptions::default();
    // The first chunk announces the topics; so does the end of the file.
    let chunk = first_chunk(&whole);
    let mut bytes = whole.clone();
    bytes[chunk.start + 400] ^= 0x55;
    assert_mapped(&read(&bytes, &options), 120, "another checksum");
    // A length that reaches far over the next chunks.
    let mut bytes = whole.clone();
    bytes[chunk.end + 1 + 2] ^= 0x7f;
    assert_mapped(&read(&bytes, &options), 120, "left out");
    // Zeros from here to there, as of a disk that lost a block.
    let mut bytes = whole.clone();
    let middle = whole.len() / 2;
    bytes[middle..middle + 8192].fill(0);
    assert_mapped(&read(&bytes, &options), 110, "left out");
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
    // The end of the first file is missing: the second one is read all the same.
    let cut = &first[..first.len() - 3000];
    let parts = vec![LogBytes::from(cut), LogBytes::from(&second[..])];
    assert_mapped(&mapped(parts, "x", &LogOptions::default()), 125, "left out");
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
                // The floor, which is no wall.
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
    let refused = read(&bytes, &LogOptions::default());
    assert!(
        refused.path.is_empty() && refused.said.contains("--heights LOW,HIGH"),
        "{}",
        refused.said
    );
    let options = LogOptions {
        heights_m: Some((0.0, 0.3)),
        ..LogOptions::default()
    };
    assert_mapped(&read(&bytes, &options), 130, "");
}

#[test]
fn a_laser_may_be_placed_by_hand() {
    let mut all = messages();
    turned(&mut all, 180);
    mirrored(&mut all);
    without(&mut all, "/tf_static");
    let options = LogOptions {
        laser: Some("0,0,180,flipped".parse().unwrap()),
        ..LogOptions::default()
    };
    assert_mapped(&read(&mcap(&all, PER_CHUNK), &options), 130, "");
    // What was set by hand stays, and the comparison tells what it thinks of it.
    let options = LogOptions {
        laser: Some("0,0,0".parse().unwrap()),
        ..LogOptions::default()
    };
    let outcome = read(&mcap(&all, PER_CHUNK), &options);
    assert!(
        outcome.said.contains("mend it with --laser 0,0,"),
        "{}",
        outcome.said
    );
}
