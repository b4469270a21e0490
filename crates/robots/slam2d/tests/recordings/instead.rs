//! Recordings with other messages instead of odometry or scans: named, with what to do.

use robot_io::log::LogOptions;
use robot_io::log_bytes::LogBytes;
use robot_io::log_format::LogFormat;

use super::base::{messages, truth, without};
use super::connected::{drive, said};
use super::robot::Robot;
use super::write::{Body, Message, mcap};
use super::{BY_SCANS_M, Mapped, NEAR_M, PER_CHUNK, distance_m, path, read};

/// Types of poses.
const POSES: [&str; 3] = [
    "geometry_msgs/msg/PoseStamped",
    "geometry_msgs/msg/PoseWithCovarianceStamped",
    "geometry_msgs/msg/TransformStamped",
];
/// Types of clouds that are not read, and what helps.
const CLOUDS: [(&str, &str); 3] = [
    (
        "sensor_msgs/msg/PointCloud",
        "convertPointCloudToPointCloud2",
    ),
    ("livox_ros_driver/msg/CustomMsg", "set xfer_format to 0"),
    ("livox_ros_driver2/msg/CustomMsg", "set xfer_format to 0"),
];

/// The drive with poses of this type on /mocap instead of odometry.
fn with_poses(kind: &'static str) -> Vec<Message> {
    let mut all = messages();
    for message in &mut all {
        if let Body::Odometry {
            stamp_s,
            above,
            pose,
            ..
        } = message.body.clone()
        {
            "/mocap".clone_into(&mut message.topic);
            message.body = Body::Pose {
                kind,
                stamp_s,
                above,
                pose,
            };
        }
    }
    all
}

fn other(topic: &str, kind: &'static str, recorded_s: f64) -> Message {
    Message {
        topic: topic.to_owned(),
        recorded_s,
        body: Body::Other(kind),
    }
}

/// The drive without odometry and with one message more.
fn with_other(more: impl Fn(f64) -> Message) -> Mapped {
    let mut all = messages();
    without(&mut all, "/odom");
    all.push(more(all[1].recorded_s));
    read(&mcap(&all, PER_CHUNK), &LogOptions::default())
}

/// Whether every scan but the first and last has odometry.
fn has_odometry(bytes: &[u8], options: &LogOptions) -> bool {
    let mut reader = LogFormat::open(LogBytes::from(bytes), "x.mcap", options).unwrap();
    let mut frames = Vec::new();
    while let Some(frame) = reader.next_frame().unwrap() {
        frames.push(frame.odometry.is_some());
    }
    frames[1..frames.len() - 1].iter().all(|&has| has)
}

#[test]
fn poses_are_named_without_odometry_and_are_odometry_on_request() {
    let asked = LogOptions {
        odometry_topic: Some("/mocap".to_owned()),
        ..LogOptions::default()
    };
    for kind in POSES {
        let bytes = mcap(&with_poses(kind), PER_CHUNK);
        let plain = read(&bytes, &LogOptions::default());
        assert!(distance_m(&path(&plain), truth()) < BY_SCANS_M, "{kind}");
        assert!(
            plain.notes.contains("choose them with --odom-topic /mocap"),
            "{kind}: {}",
            plain.notes
        );
        assert!(!has_odometry(&bytes, &LogOptions::default()));
        let with = read(&bytes, &asked);
        assert!(distance_m(&path(&with), truth()) < NEAR_M, "{kind}");
        assert_eq!(with.notes, "", "{kind}");
        assert!(has_odometry(&bytes, &asked), "{kind}");
    }
}

#[test]
fn poses_and_inertial_measurements_beside_odometry_are_not_named() {
    let mut all = with_poses(POSES[0]);
    let odometry = messages();
    all.extend(
        odometry
            .into_iter()
            .filter(|message| message.topic == "/odom"),
    );
    all.push(other("/imu", "sensor_msgs/msg/Imu", all[1].recorded_s));
    let outcome = read(&mcap(&all, PER_CHUNK), &LogOptions::default());
    assert_eq!(outcome.notes, "");
    assert!(distance_m(&path(&outcome), truth()) < NEAR_M);
}

#[test]
fn inertial_measurements_without_odometry_are_named_and_a_goal_is_not() {
    let imu = with_other(|at_s| other("/imu", "sensor_msgs/msg/Imu", at_s));
    assert!(
        imu.notes.contains("/imu (sensor_msgs/Imu) is not read"),
        "{}",
        imu.notes
    );
    let goal = with_other(|recorded_s| Message {
        topic: "/goal_pose".to_owned(),
        recorded_s,
        body: Body::Pose {
            kind: POSES[0],
            stamp_s: recorded_s,
            above: "map".to_owned(),
            pose: [1.0, 2.0, 0.0],
        },
    });
    assert!(!goal.notes.contains("/goal_pose"), "{}", goal.notes);
}

#[test]
fn clouds_of_other_types_are_named_with_how_to_convert_them() {
    for (kind, remedy) in CLOUDS {
        let mut all = messages();
        for message in &mut all {
            if message.topic == "/scan" {
                *message = other("/cloud", kind, message.recorded_s);
            }
        }
        let file = read(&mcap(&all, PER_CHUNK), &LogOptions::default());
        let (output, _folder) = drive(&["--wait", "1"], move |server| {
            let mut robot = Robot::accept(&server);
            robot.advertise(&[("/cloud".to_owned(), kind)], 1);
            while robot.socket.read().is_ok() {}
        });
        for notes in [file.notes, said(&output)] {
            assert!(
                notes.contains("/cloud is ") && notes.contains(remedy),
                "{kind}: {notes}"
            );
            assert!(notes.contains("PointCloud2, and pass --heights"), "{notes}");
        }
    }
}
