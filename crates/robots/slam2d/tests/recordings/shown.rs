//! The map of `slam2d live --serve`, as a client of Foxglove's WebSocket protocol gets it.

use std::collections::BTreeMap;
use std::fs;
use std::io::{BufRead as _, BufReader, Read as _};
use std::net::{TcpListener, TcpStream};
use std::process::{Command, Stdio};
use std::sync::mpsc::channel;
use std::thread;
use std::time::Duration;

use super::base::messages;
use super::robot::{Robot, topics};
use crate::support::assert_rejected;
use robot_connection::{Channel, Server};
use serde_json::{Value, json};
use tungstenite::{ClientRequestBuilder, Message as Frame, WebSocket, client};

/// A client that subscribes to all topics.
struct Viewer {
    socket: WebSocket<TcpStream>,
    topics: Vec<String>,
}

impl Viewer {
    fn connect(url: &str) -> Self {
        let stream = TcpStream::connect(url.trim_start_matches("ws://")).unwrap();
        let request = ClientRequestBuilder::new(url.parse().unwrap());
        let request = request.with_sub_protocol("foxglove.websocket.v1");
        let (mut socket, _) = client(request, stream).unwrap();
        let mut text = || -> Value {
            serde_json::from_str(socket.read().unwrap().to_text().unwrap()).unwrap()
        };
        assert_eq!(text()["op"], "serverInfo");
        let advertised = text();
        let channels = advertised["channels"].as_array().unwrap();
        let topics = channels.iter().map(|channel| {
            assert_eq!(channel["schemaEncoding"], "ros2msg");
            channel["topic"].as_str().unwrap().to_owned()
        });
        let topics: Vec<String> = topics.collect();
        let all = channels
            .iter()
            .map(|channel| json!({"id": channel["id"], "channelId": channel["id"]}));
        let all: Vec<Value> = all.collect();
        let subscribe = json!({"op": "subscribe", "subscriptions": all});
        socket.send(Frame::text(subscribe.to_string())).unwrap();
        Self { socket, topics }
    }

    /// The next message and its topic; `None` after the server has closed the connection.
    fn next(&mut self) -> Option<(String, Vec<u8>)> {
        loop {
            match self.socket.read().ok()? {
                Frame::Binary(binary) => {
                    let id = u32::from_le_bytes(binary[1..5].try_into().unwrap());
                    return Some((self.topics[id as usize].clone(), binary[13..].to_vec()));
                }
                Frame::Close(_) => return None,
                _ => {}
            }
        }
    }

    /// The last message of each topic.
    fn last(mut self) -> BTreeMap<String, Vec<u8>> {
        let mut last = BTreeMap::new();
        while let Some((topic, message)) = self.next() {
            last.insert(topic, message);
        }
        last
    }
}

fn u32_at(bytes: &[u8], at: usize) -> usize {
    u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap()) as usize
}

/// Width and pixels of an occupancy grid in the frame "map", as those of the map's image.
fn image(grid: &[u8]) -> (usize, Vec<u8>) {
    let (width, height) = (u32_at(grid, 32), u32_at(grid, 36));
    assert_eq!(u32_at(grid, 100), width * height);
    let pixel = |&cell: &u8| match cell {
        100 => 0,
        0 => 254,
        _ => 205,
    };
    let rows = grid[104..].chunks(width).rev();
    (width, rows.flatten().map(pixel).collect())
}

#[test]
fn a_viewer_gets_the_map_that_the_drive_writes_early_or_late() {
    let server = TcpListener::bind("127.0.0.1:0").unwrap();
    let robot_url = format!("ws://{}", server.local_addr().unwrap());
    let (played, is_played) = channel();
    let (go, may_go) = channel::<()>();
    let robot = thread::spawn(move || {
        let all = messages();
        let topics = topics(&all);
        let mut robot = Robot::accept(&server);
        robot.advertise(&topics, 1);
        robot.subscribed(topics.len());
        robot.play(&all);
        played.send(()).unwrap();
        may_go.recv().unwrap();
        drop(server);
        robot.close();
    });
    let folder = tempfile::tempdir().unwrap();
    let to = folder.path().join("run");
    let mut live = Command::new(env!("CARGO_BIN_EXE_slam2d"))
        .args(["live", &robot_url, "--serve=0", "--wait", "1", "-o"])
        .arg(&to)
        .stderr(Stdio::piped())
        .stdout(Stdio::null())
        .spawn()
        .unwrap();
    let mut said = BufReader::new(live.stderr.take().unwrap());
    let mut first = String::new();
    said.read_line(&mut first).unwrap();
    let url = first
        .trim()
        .strip_prefix("slam2d: shows the map at ")
        .unwrap();
    let early = Viewer::connect(url);
    is_played.recv().unwrap();
    let late = Viewer::connect(url);
    go.send(()).unwrap();
    let viewers = [early, late].map(|viewer| thread::spawn(move || viewer.last()));
    let [early, late] = viewers.map(|viewer| viewer.join().unwrap());
    robot.join().unwrap();
    let mut rest = String::new();
    said.read_to_string(&mut rest).unwrap();
    assert!(live.wait().unwrap().success(), "{rest}");
    assert_eq!(early, late);
    let pgm = fs::read(to.join("map.pgm")).unwrap();
    let (width, pixels) = image(&early["/map"]);
    let height = pixels.len() / width;
    let expected = [format!("P5\n{width} {height}\n255\n").into_bytes(), pixels].concat();
    assert!(expected == pgm, "the map differs from map.pgm");
    let quality: Value =
        serde_json::from_str(&fs::read_to_string(to.join("quality.json")).unwrap()).unwrap();
    // Time, frame, number of poses.
    let keyframes = quality["keyframes"].as_array().unwrap();
    assert_eq!(u32_at(&early["/path"], 20), keyframes.len());
    let transforms = String::from_utf8_lossy(&early["/tf"]);
    for frame in ["map\0", "odom\0", "base_link\0"] {
        assert!(transforms.contains(frame), "{frame}");
    }
}

#[test]
fn a_viewer_that_stalls_delays_neither_the_drive_nor_others() {
    const LARGE: usize = 1 << 22;
    let topic = Channel {
        topic: "/map",
        schema_name: "nav_msgs/msg/OccupancyGrid",
        schema: String::new(),
    };
    let server = Server::start("test", ([127, 0, 0, 1], 0).into(), vec![topic]).unwrap();
    let url = format!("ws://{}", server.address);
    let stalls = Viewer::connect(&url);
    let mut other = Viewer::connect(&url);
    // More than sockets hold.
    for number in 1..=20 {
        server.publish(0, number, vec![number as u8; LARGE]);
        let (_, message) = other.next().unwrap();
        assert!(message[0] == number as u8 && message.len() == LARGE);
    }
    let (_, latest) = Viewer::connect(&url).next().unwrap();
    assert_eq!(latest[0], 20);
    server.end(Duration::from_millis(100));
    drop(stalls);
}

#[test]
fn an_address_that_cannot_be_served_is_rejected() {
    let taken = TcpListener::bind("127.0.0.1:0").unwrap();
    let folder = tempfile::tempdir().unwrap();
    let to = folder.path().join("run");
    let drive = ["live", "ws://localhost:1", "-o", to.to_str().unwrap()];
    for (serve, expected) in [
        (
            format!("--serve={}", taken.local_addr().unwrap()),
            "pass another port, such as --serve=8767",
        ),
        (
            "--serve=robot".to_owned(),
            "expected a port such as 8766, or an address with one, such as 0.0.0.0:8766",
        ),
    ] {
        assert_rejected(&[&drive[..], &[&serve]].concat(), expected);
    }
    assert!(!to.exists());
}
