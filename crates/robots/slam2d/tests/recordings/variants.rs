//! Variants of one simulated drive, each with a fault that users report.

use std::f32::consts::{PI, TAU};

use pr_geom::SE2;
use robot_io::log::LogOptions;

use super::base::{
    START_S, as_transforms, messages, mirrored, odometry, poses, scans, shift_stamps, transform,
    truth, turned, without,
};
use super::write::{Body, Message, mcap};
use super::{BY_SCANS_M, NEAR_M, PER_CHUNK, distance_m, path, read};

/// Added to a stamp of the base to get one of simulated time, s.
const SIMULATED_S: f64 = -1_699_999_990.0;

type Change = fn(&mut Vec<Message>);

/// Each variant: name, change, largest error of its map (m), and a word of the remark.
const VARIANTS: &[(&str, Change, f64, &str)] = &[
    ("nothing", |_| {}, NEAR_M, ""),
    (
        "backward, without its transform",
        |all| {
            turned(all, 180);
            without(all, "/tf_static");
        },
        NEAR_M,
        "--laser 0,0,180",
    ),
    (
        "backward, with a transform that points ahead",
        |all| turned(all, 180),
        NEAR_M,
        "--laser 0,0,180",
    ),
    (
        "to the left, with a transform that points ahead",
        |all| turned(all, 90),
        NEAR_M,
        "--laser 0,0,90",
    ),
    (
        "to the right, with a transform that points ahead",
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
        "upside down, as in its transform",
        |all| {
            mirrored(all);
            if let Body::Transforms(transforms) = &mut all[0].body {
                transforms[0].is_upside_down = true;
            }
        },
        NEAR_M,
        "",
    ),
    (
        "static transform at the end",
        |all| {
            turned(all, 180);
            let mut message = all.remove(0);
            if let Body::Transforms(transforms) = &mut message.body {
                transforms[0].pose[2] = std::f64::consts::PI;
            }
            all.push(message);
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
        "base_link is connected to it",
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
        "odometry that is stamped as it arrives, 0.4 s late",
        |all| {
            poses(all, |_, stamp_s, _| *stamp_s += 0.4);
            for message in all.iter_mut() {
                if matches!(message.body, Body::Odometry { .. }) {
                    message.recorded_s += 0.4;
                }
            }
        },
        NEAR_M,
        "s late relative to the scans",
    ),
    (
        "scans that are stamped as they arrive, 0.3 s late",
        |all| {
            scans(all, |_, scan| scan.stamp_s += 0.3);
            for message in all.iter_mut() {
                if matches!(message.body, Body::Scan(_)) {
                    message.recorded_s += 0.3;
                }
            }
        },
        NEAR_M,
        "s early relative to the scans",
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
        "check the wheel radius",
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
        "the scans are mirrored",
    ),
    (
        "the heading of odometry has the wrong sign",
        |all| poses(all, |_, _, pose| pose[2] *= -1.0),
        NEAR_M,
        "its heading has the wrong sign",
    ),
    (
        "y of odometry has the wrong sign",
        |all| poses(all, |_, _, pose| pose[1] *= -1.0),
        NEAR_M,
        "its y has the wrong sign",
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
        "have no odometry at their stamp",
    ),
    (
        "odometry ends early",
        |all| all.retain(|message| message.topic != "/odom" || message.recorded_s < START_S + 12.0),
        BY_SCANS_M,
        "have no odometry at their stamp",
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
                if let Body::Transforms(transforms) = &mut message.body {
                    transforms[0].stamp_s = 0.0;
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
            shift_stamps(all, f64::NEG_INFINITY, SIMULATED_S);
            shift_stamps(all, START_S + 16.0, -16.0);
        },
        BY_SCANS_M,
        "steps back by",
    ),
    (
        "simulated time starts again, and the recording's with it",
        |all| {
            shift_stamps(all, f64::NEG_INFINITY, SIMULATED_S);
            shift_stamps(all, START_S + 16.0, -16.0);
            for message in all.iter_mut() {
                let is_restarted = message.recorded_s > START_S + 16.0;
                message.recorded_s += SIMULATED_S - if is_restarted { 16.0 } else { 0.0 };
            }
        },
        BY_SCANS_M,
        "steps back by",
    ),
    (
        "a step of NTP",
        |all| shift_stamps(all, START_S + 16.0, -40.0),
        NEAR_M,
        "steps back by 40.0 s",
    ),
    (
        "a small step of NTP",
        |all| shift_stamps(all, START_S + 16.0, -0.4),
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
        "130 scans of /scan are a duplicate of the one before",
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
        "have no odometry at their stamp",
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
        // A reversed sweep is filtered to other points.
        BY_SCANS_M,
        "angle_increment",
    ),
    (
        "the last angle of twice the sweep",
        |all| scans(all, |_, scan| scan.angle_max = 3.0 * PI),
        NEAR_M,
        "angle_increment is used",
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
                    // The rear one faces backward and is slightly later.
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

#[test]
fn every_fault_is_corrected_or_named() {
    let mut failures = Vec::new();
    for (name, change, max_m, word) in VARIANTS {
        let mut all = messages();
        change(&mut all);
        let outcome = read(&mcap(&all, PER_CHUNK), &LogOptions::default());
        let scans = outcome.path.len();
        let off_m = if scans == truth().len() {
            distance_m(&path(&outcome), truth())
        } else {
            f64::INFINITY
        };
        let is_reported = outcome.notes.contains(word)
            && (outcome.notes.is_empty() == word.is_empty() || *name == "no odometry");
        if off_m > *max_m || !is_reported {
            failures.push(format!(
                "{name}: {scans} scans, {off_m:.3} m: {}",
                outcome.notes
            ));
        }
    }
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}
