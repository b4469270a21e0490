//! Writes ROS 2 recordings: messages in CDR, in an uncompressed MCAP file.
//!
//! Source: "MCAP format specification", version 0; OMG, "Extended and dynamic topic types for DDS", 7.4.

use robot_connection::Cdr;

/// A message with its topic and the time of its recording.
#[derive(Clone, Debug)]
pub struct Message {
    pub topic: String,
    pub recorded_s: f64,
    pub body: Body,
}

/// Content of a message.
#[derive(Clone, Debug)]
pub enum Body {
    Scan(Scan),
    Odometry {
        stamp_s: f64,
        above: String,
        child: String,
        pose: [f64; 3],
    },
    Transforms(Vec<FrameTransform>),
    /// A pose, of a type that states it like this.
    Pose {
        kind: &'static str,
        stamp_s: f64,
        above: String,
        pose: [f64; 3],
    },
    /// A message of another type.
    Other(&'static str),
    /// Points of a 3-D sensor, in its frame.
    Cloud {
        stamp_s: f64,
        frame: String,
        points: Vec<[f32; 3]>,
    },
}

/// The fields of a scan; several echoes make a multi-echo scan.
#[derive(Clone, Debug, Default)]
pub struct Scan {
    pub stamp_s: f64,
    pub frame: String,
    pub angle_min: f32,
    pub angle_max: f32,
    pub angle_increment: f32,
    pub time_increment: f32,
    pub scan_time: f32,
    pub range_min: f32,
    pub range_max: f32,
    pub ranges: Vec<f32>,
    pub has_echoes: bool,
}

/// Transform of a frame to its parent.
#[derive(Clone, Debug)]
pub struct FrameTransform {
    pub stamp_s: f64,
    pub parent: String,
    pub child: String,
    pub pose: [f64; 3],
    pub is_upside_down: bool,
}

/// Adds a list of numbers.
fn floats(cdr: &mut Cdr, values: &[f32]) {
    cdr.u32(values.len() as u32);
    values.iter().for_each(|&value| cdr.f32(value));
}

/// Adds position and quaternion.
fn pose(cdr: &mut Cdr, [x, y, theta]: [f64; 3], is_upside_down: bool) {
    let (sin, cos) = (theta / 2.0).sin_cos();
    // Half a turn about x first.
    let [qx, qy, qz, qw] = if is_upside_down {
        [cos, sin, 0.0, 0.0]
    } else {
        [0.0, 0.0, sin, cos]
    };
    cdr.f64s(&[x, y, 0.0, qx, qy, qz, qw]);
}

impl Message {
    /// Type of the message.
    pub fn kind(&self) -> &'static str {
        match &self.body {
            Body::Scan(scan) if scan.has_echoes => "sensor_msgs/msg/MultiEchoLaserScan",
            Body::Scan(_) => "sensor_msgs/msg/LaserScan",
            Body::Odometry { .. } => "nav_msgs/msg/Odometry",
            Body::Transforms(_) => "tf2_msgs/msg/TFMessage",
            Body::Pose { kind, .. } | Body::Other(kind) => kind,
            Body::Cloud { .. } => "sensor_msgs/msg/PointCloud2",
        }
    }

    /// The message in CDR.
    pub fn bytes(&self) -> Vec<u8> {
        let mut cdr = Cdr::default();
        match &self.body {
            Body::Scan(scan) => {
                cdr.header(scan.stamp_s, &scan.frame);
                for value in [
                    scan.angle_min,
                    scan.angle_max,
                    scan.angle_increment,
                    scan.time_increment,
                    scan.scan_time,
                    scan.range_min,
                    scan.range_max,
                ] {
                    cdr.f32(value);
                }
                if scan.has_echoes {
                    cdr.u32(scan.ranges.len() as u32);
                    // The second echo is from behind.
                    for &range in &scan.ranges {
                        floats(&mut cdr, &[range, range + 1.0]);
                    }
                } else {
                    floats(&mut cdr, &scan.ranges);
                }
                cdr.u32(0);
            }
            Body::Odometry {
                stamp_s,
                above,
                child,
                pose,
            } => {
                cdr.header(*stamp_s, above);
                cdr.text(child);
                self::pose(&mut cdr, *pose, false);
                (0..78).for_each(|_| cdr.f64(0.0));
            }
            Body::Transforms(all) => {
                cdr.u32(all.len() as u32);
                for transform in all {
                    cdr.header(transform.stamp_s, &transform.parent);
                    cdr.text(&transform.child);
                    pose(&mut cdr, transform.pose, transform.is_upside_down);
                }
            }
            Body::Pose {
                kind,
                stamp_s,
                above,
                pose,
            } => {
                cdr.header(*stamp_s, above);
                if kind.ends_with("TransformStamped") {
                    cdr.text("base_link");
                }
                self::pose(&mut cdr, *pose, false);
                if kind.ends_with("WithCovarianceStamped") {
                    cdr.f64s(&[0.0; 36]);
                }
            }
            Body::Other(_) => cdr.header(0.0, ""),
            Body::Cloud {
                stamp_s,
                frame,
                points,
            } => {
                cdr.header(*stamp_s, frame);
                cdr.u32(1);
                cdr.u32(points.len() as u32);
                cdr.u32(3);
                for (offset, name) in ["x", "y", "z"].iter().enumerate() {
                    cdr.text(name);
                    cdr.u32(4 * offset as u32);
                    cdr.raw(&[7]);
                    cdr.u32(1);
                }
                cdr.raw(&[0]);
                cdr.u32(12);
                cdr.u32(12 * points.len() as u32);
                cdr.u32(12 * points.len() as u32);
                for value in points.iter().flatten() {
                    cdr.raw(&value.to_le_bytes());
                }
                cdr.raw(&[1]);
            }
        }
        cdr.finish()
    }
}

fn record(op: u8, fields: &[&[u8]]) -> Vec<u8> {
    let body = fields.concat();
    [&[op][..], &(body.len() as u64).to_le_bytes(), &body].concat()
}

fn text(text: &str) -> Vec<u8> {
    [&(text.len() as u32).to_le_bytes()[..], text.as_bytes()].concat()
}

/// Writes messages as an MCAP file, with `per_chunk` messages in each chunk.
pub fn mcap(messages: &[Message], per_chunk: usize) -> Vec<u8> {
    let magic = b"\x89MCAP0\r\n";
    let mut file = [&magic[..], &record(1, &[&text("ros2"), &text("test")])].concat();
    let mut channels: Vec<(String, &str)> = Vec::new();
    let mut announced: Vec<u8> = Vec::new();
    for chunk in messages.chunks(per_chunk) {
        let mut records: Vec<u8> = Vec::new();
        for message in chunk {
            let key = (message.topic.clone(), message.kind());
            let known = channels.iter().position(|channel| *channel == key);
            let number = known.unwrap_or_else(|| {
                channels.push(key.clone());
                let number = channels.len() as u16;
                let bytes = number.to_le_bytes();
                let schema = record(3, &[&bytes, &text(key.1), &text("ros2msg"), &text("")]);
                let channel = record(4, &[&bytes, &bytes, &text(&key.0), &text("cdr"), &text("")]);
                for announcement in [schema, channel] {
                    records.extend_from_slice(&announcement);
                    announced.extend_from_slice(&announcement);
                }
                channels.len() - 1
            });
            let channel = (number as u16 + 1).to_le_bytes();
            let time = ((message.recorded_s * 1e9).round() as u64).to_le_bytes();
            let body = message.bytes();
            records.extend(record(5, &[&channel, &[0; 4], &time, &time, &body]));
        }
        let size = (records.len() as u64).to_le_bytes();
        let sum = crc32(&records).to_le_bytes();
        file.extend(record(
            6,
            &[&[0; 16], &size, &sum, &text(""), &size, &records],
        ));
    }
    file.extend(record(15, &[&[0; 4]]));
    // The summary repeats the declarations of all topics.
    file.extend(&announced);
    file.extend(record(2, &[&[0; 20]]));
    file.extend_from_slice(magic);
    file
}

/// CRC-32 of ISO 3309, bit by bit.
fn crc32(bytes: &[u8]) -> u32 {
    let mut sum = !0_u32;
    for &byte in bytes {
        sum ^= u32::from(byte);
        for _ in 0..8 {
            sum = (sum >> 1) ^ (0xedb8_8320 & (sum & 1).wrapping_neg());
        }
    }
    !sum
}
