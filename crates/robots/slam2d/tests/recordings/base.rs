//! The simulated drive as a recording without faults, and functions that change it.

use std::sync::OnceLock;

use pr_geom::SE2;

use super::drive;
use super::write::{Body, FrameTransform, Message, Scan};

/// Start of the drive, s.
pub const START_S: f64 = 1_700_000_000.0;
/// Odometry poses per scan.
const PER_SCAN: usize = 5;

/// The drive as a recording without faults.
pub fn messages() -> Vec<Message> {
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

pub fn odometry(topic: &str, stamp_s: f64, above: &str, child: &str, pose: [f64; 3]) -> Message {
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

pub fn transform(topic: &str, parent: &str, child: &str, pose: [f64; 3], stamp_s: f64) -> Message {
    Message {
        topic: topic.to_owned(),
        recorded_s: stamp_s,
        body: Body::Transforms(vec![FrameTransform {
            stamp_s,
            parent: parent.to_owned(),
            child: child.to_owned(),
            pose,
            is_upside_down: false,
        }]),
    }
}

/// Changes every scan; the first argument is its index.
pub fn scans(all: &mut [Message], mut change: impl FnMut(usize, &mut Scan)) {
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

/// Changes stamp and pose of every odometry message.
pub fn poses(all: &mut [Message], mut change: impl FnMut(usize, &mut f64, &mut [f64; 3])) {
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

/// Shifts the stamps of all scans and odometry that were recorded after a time.
pub fn shift_stamps(all: &mut [Message], after_s: f64, by_s: f64) {
    for message in all {
        if message.recorded_s > after_s {
            match &mut message.body {
                Body::Scan(scan) => scan.stamp_s += by_s,
                Body::Odometry { stamp_s, .. } => *stamp_s += by_s,
                _ => {}
            }
        }
    }
}

/// Turns the laser about its axis by whole beams, counter-clockwise.
pub fn turned(all: &mut [Message], degrees: i32) {
    scans(all, |_, scan| {
        let beams = scan.ranges.len() as i32;
        let by = (degrees * beams / 360).rem_euclid(beams) as usize;
        scan.ranges.rotate_left(by);
    });
}

/// Reverses the order of the beams.
pub fn mirrored(all: &mut [Message]) {
    scans(all, |_, scan| {
        // Beam k points to −π + k·step: its mirror image is beam n − k.
        scan.ranges[1..].reverse();
    });
}

pub fn without(all: &mut Vec<Message>, topic: &str) {
    all.retain(|message| message.topic != topic);
}

/// Converts odometry to transforms.
pub fn as_transforms(all: &mut [Message]) {
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

/// True poses of the robot.
pub fn truth() -> &'static [SE2] {
    static TRUTH: OnceLock<Vec<SE2>> = OnceLock::new();
    TRUTH.get_or_init(|| {
        let drive = drive();
        (0..=drive.ticks().len())
            .map(|tick| drive.truth(tick))
            .collect()
    })
}
