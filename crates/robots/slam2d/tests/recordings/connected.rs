//! `slam2d live` and a robot's server: the same map as that of the file, and what networks do.

use std::fs;
use std::io::{Read as _, Write as _};
use std::net::TcpListener;
use std::process::Output;
use std::thread;

use super::base::{START_S, messages, poses, shift_stamps, truth};
use super::robot::{Robot, topics};
use super::write::{Body, Message, mcap};
use super::{NEAR_M, distance_m};
use crate::support::{assert_rejected, slam2d};
use pr_geom::SE2;
use tungstenite::{Bytes, Message as Frame};

/// Time for a first scan and a lost connection, s.
const WAIT: &str = "2";

/// The output of `slam2d live` into a new folder, with this server at the other end, and the folder.
pub fn drive(
    options: &[&str],
    serve: impl FnOnce(TcpListener) + Send + 'static,
) -> (Output, tempfile::TempDir) {
    let server = TcpListener::bind("127.0.0.1:0").unwrap();
    let url = format!("ws://{}", server.local_addr().unwrap());
    let serving = thread::spawn(move || serve(server));
    let folder = tempfile::tempdir().unwrap();
    let to = folder.path().join("run");
    let arguments = ["live", &url, "-o", to.to_str().unwrap()];
    let output = slam2d(&[&arguments[..], options].concat());
    serving.join().expect("the server saw what it expects");
    (output, folder)
}

/// Plays these parts of a recording, each over a connection and with channels of its own.
fn play(server: &TcpListener, parts: &[&[Message]]) {
    let topics = topics(&parts.concat());
    for (part, first) in parts.iter().zip([1, 70]) {
        let mut robot = Robot::accept(server);
        robot.advertise(&topics, first);
        robot.subscribed(topics.len());
        robot.play(part);
        robot.close();
    }
}

pub fn said(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).unwrap()
}

fn trajectory(folder: &tempfile::TempDir, run: &str) -> String {
    fs::read_to_string(folder.path().join(run).join("trajectory.tum")).unwrap()
}

#[test]
fn a_robot_that_is_mapped_while_it_drives_has_the_map_of_its_recording() {
    let all = messages();
    let file = mcap(&all, 40);
    let (output, folder) = drive(&["--wait", WAIT], move |server| {
        play(&server, &[&all]);
    });
    assert!(output.status.success(), "{}", said(&output));
    assert!(said(&output).contains("reads /scan (sensor_msgs/msg/LaserScan)"));
    let path = folder.path().join("file.mcap");
    fs::write(&path, file).unwrap();
    let recording = folder.path().join("run/recording.mcap");
    for (log, into) in [(path, "of_file"), (recording, "of_recording")] {
        let into = folder.path().join(into);
        let run = slam2d(&["run", log.to_str().unwrap(), "-o", into.to_str().unwrap()]);
        assert!(run.status.success());
    }
    let live = trajectory(&folder, "run");
    assert!(live.lines().count() > 100);
    assert_eq!(live, trajectory(&folder, "of_file"));
    assert_eq!(live, trajectory(&folder, "of_recording"));
    // Another drive does not overwrite the recording.
    let to = folder.path().join("run");
    let again = ["live", "ws://localhost:1", "-o", to.to_str().unwrap()];
    assert_rejected(&again, "is the recording of an earlier drive");
}

#[test]
fn a_connection_that_is_lost_comes_back_and_the_gap_is_named() {
    let (output, folder) = drive(&["--wait", WAIT], |server| {
        let all = messages();
        let (before, after) = all.split_at(all.len() / 2);
        play(&server, &[before, after]);
    });
    let said = said(&output);
    assert!(output.status.success(), "{said}");
    assert!(said.contains("connected again"), "{said}");
    assert!(said.contains("the connection was lost for"), "{said}");
    assert!(said.contains("the drive ends there"), "{said}");
    let scans = messages();
    let scans = scans.iter().filter(|message| message.topic == "/scan");
    let mapped = trajectory(&folder, "run");
    let mapped = mapped.lines().filter(|line| !line.starts_with('#'));
    assert_eq!(mapped.count(), scans.count());
}

/// Distance of the path of a run from the truth, m.
fn error_m(folder: &tempfile::TempDir, truth: &[SE2]) -> f64 {
    let lines = trajectory(folder, "run");
    let path = lines.lines().filter(|line| !line.starts_with('#'));
    let path = path.map(|line| {
        let words: Vec<f64> = line.split(' ').map(|word| word.parse().unwrap()).collect();
        SE2::new(words[1], words[2], 2.0 * words[6].atan2(words[7]))
    });
    distance_m(&path.collect::<Vec<_>>(), truth)
}

/// Shifts stamps and times of recording.
fn shift(part: &mut [Message], by_s: f64) {
    shift_stamps(part, f64::NEG_INFINITY, by_s);
    part.iter_mut()
        .for_each(|message| message.recorded_s += by_s);
}

#[test]
fn a_robot_that_restarts_goes_on_in_the_same_map() {
    let (output, folder) = drive(&["--wait", WAIT], |server| {
        let mut all = messages();
        let middle = all.len() / 2;
        // A minute later, odometry starts at zero.
        let origin = all[middle..].iter().find_map(|message| match message.body {
            Body::Odometry { pose, .. } => Some(SE2::new(pose[0], pose[1], pose[2])),
            _ => None,
        });
        let from_origin = origin.unwrap().inverse();
        poses(&mut all[middle..], |_, _, pose| {
            *pose = (from_origin * SE2::new(pose[0], pose[1], pose[2])).to_array();
        });
        shift(&mut all[middle..], 60.0);
        play(&server, &[&all[..middle], &all[middle..]]);
    });
    let said = said(&output);
    assert!(output.status.success(), "{said}");
    assert!(said.contains("the connection was lost for"), "{said}");
    let error_m = error_m(&folder, truth());
    assert!(error_m < NEAR_M, "{error_m}: {said}");
}

#[test]
fn a_simulation_that_starts_again_goes_on_in_the_same_map() {
    let mut all = messages();
    // Simulated time is that of the stamps and of the recording.
    shift(&mut all, 2.0 - START_S);
    let half = all.len() / 2;
    let scans = all[..half]
        .iter()
        .filter(|message| message.topic == "/scan");
    let truth = [&truth()[..scans.count()], truth()].concat();
    let (output, folder) = drive(&["--wait", WAIT], move |server| {
        play(&server, &[&[&all[..half], &all].concat()]);
    });
    let said = said(&output);
    assert!(output.status.success(), "{said}");
    let error_m = error_m(&folder, &truth);
    assert!(error_m < NEAR_M, "{error_m}: {said}");
}

#[test]
fn only_what_is_read_is_subscribed_to_also_if_it_appears_later() {
    let other = |topic: &str, kind| (topic.to_owned(), kind);
    let (output, _) = drive(&["--wait", WAIT, "--scan-topic", "/scan"], move |server| {
        let all = messages();
        let mut robot = Robot::accept(&server);
        let early = [
            other("/camera", "sensor_msgs/msg/Image"),
            other("/points", "sensor_msgs/msg/PointCloud2"),
            other("/rear", "sensor_msgs/msg/LaserScan"),
            other("/odom", "nav_msgs/msg/Odometry"),
        ];
        robot.advertise(&early, 1);
        assert_eq!(robot.subscribed(1), ["/odom"]);
        let late = [
            other("/scan", "sensor_msgs/msg/LaserScan"),
            other("/tf_static", "tf2_msgs/msg/TFMessage"),
        ];
        robot.advertise(&late, 10);
        assert_eq!(robot.subscribed(3), ["/odom", "/scan", "/tf_static"]);
        robot.play(&all);
        drop(server);
        robot.close();
    });
    assert!(output.status.success(), "{}", said(&output));
}

#[test]
fn a_robot_without_scans_lists_what_it_has_and_leaves_no_folder() {
    let (output, folder) = drive(&["--wait", WAIT], |server| {
        let mut robot = Robot::accept(&server);
        robot.advertise(&[("/odom".to_owned(), "nav_msgs/msg/Odometry")], 1);
        robot.subscribed(1);
        while robot.socket.read().is_ok() {}
    });
    let said = said(&output);
    assert_eq!(output.status.code(), Some(2), "{said}");
    assert!(
        said.contains("no scan came; it has /odom (nav_msgs/msg/Odometry). Start the driver"),
        "{said}"
    );
    assert!(!folder.path().join("run").exists());
}

#[test]
fn a_server_that_sends_too_much_ends_the_drive_with_what_was_mapped() {
    let (output, folder) = drive(&["--wait", WAIT], |server| {
        let all = messages();
        let mut robot = Robot::accept(&server);
        let topics = topics(&all);
        robot.advertise(&topics, 1);
        robot.subscribed(topics.len());
        robot.play(&all);
        let large = Frame::Binary(Bytes::from(vec![1; 100 << 20]));
        // The client hangs up while this is sent.
        let _ = robot.socket.send(large);
    });
    let said = said(&output);
    assert_eq!(output.status.code(), Some(2), "{said}");
    assert!(
        said.contains("the server sent a message of 104857600 bytes"),
        "{said}"
    );
    let quality = fs::read_to_string(folder.path().join("run/quality.json")).unwrap();
    assert!(quality.contains("the run was cut short"));
    assert!(trajectory(&folder, "run").lines().count() > 100);
}

#[test]
fn other_servers_and_none_are_rejected_in_one_sentence() {
    let server = TcpListener::bind("127.0.0.1:0").unwrap();
    let url = format!("ws://{}", server.local_addr().unwrap());
    drop(server);
    let folder = tempfile::tempdir().unwrap();
    let to = folder.path().to_str().unwrap();
    for (url, expected) in [
        (
            &url[..],
            "start foxglove_bridge on the robot, and check address and port",
        ),
        ("robot:8765", "is not the address of a robot"),
        ("http://robot:8765", "pass one such as ws://robot:8765"),
        ("wss://robot:8765", "ssh -L 8765:localhost:8765"),
    ] {
        assert_rejected(&["live", url, "-o", to], expected);
    }
    assert_rejected(&["live", &url], "-o DIR");
    assert_rejected(&["live", &url, "-o", to, "--wait", "-1"], "not within 0");
    let (output, _) = drive(&[], |server| {
        let (mut stream, _) = server.accept().unwrap();
        assert!(stream.read(&mut [0; 4096]).unwrap() > 0);
        stream
            .write_all(b"HTTP/1.1 400 Bad Request\r\nContent-Length: 0\r\n\r\n")
            .unwrap();
    });
    assert!(
        said(&output).contains("it answers HTTP 400"),
        "{}",
        said(&output)
    );
    let (output, _) = drive(&[], |server| {
        let (stream, _) = server.accept().unwrap();
        // rosbridge has no subprotocol.
        drop(tungstenite::accept(stream).unwrap());
    });
    assert!(
        said(&output).contains("another subprotocol"),
        "{}",
        said(&output)
    );
    assert_eq!(output.status.code(), Some(2));
}
