//! `foxglove.LaserScan` in protobuf and in JSON, rewritten as the `sensor_msgs/LaserScan` of ROS 1.
//!
//! | field of the protobuf message | content |
//! |---|---|
//! | 1 | timestamp: seconds (1), nanoseconds (2) |
//! | 2 | frame |
//! | 3 | pose of the scan in the frame: position (1: x, y, z), orientation (2: x, y, z, w) |
//! | 4, 5 | first and last angle, rad |
//! | 6 | ranges, m |
//!
//! Source: the schemas of Foxglove, `LaserScan.proto`. A dependency would be larger than the one message that is read.

use serde::Deserialize;

/// Type of the message.
pub const LASER_SCAN: &str = "foxglove.LaserScan";
/// Type that it is rewritten as.
pub const AS_KIND: &str = "sensor_msgs/LaserScan";

/// A scan by name, as in JSON.
#[derive(Debug, Default, Deserialize, PartialEq)]
#[serde(default)]
struct Scan {
    timestamp: Stamp,
    frame_id: String,
    pose: Pose,
    start_angle: f64,
    end_angle: f64,
    ranges: Vec<Option<f64>>,
}

#[derive(Debug, Default, Deserialize, PartialEq)]
#[serde(default)]
struct Stamp {
    #[serde(alias = "seconds")]
    sec: u32,
    #[serde(alias = "nanos", alias = "nanosec")]
    nsec: u32,
}

#[derive(Debug, Default, Deserialize, PartialEq)]
#[serde(default)]
struct Pose {
    position: Axes,
    orientation: Axes,
}

#[derive(Debug, Default, Deserialize, PartialEq)]
#[serde(default)]
struct Axes {
    x: f64,
    y: f64,
    z: f64,
}

impl Axes {
    fn is_zero(&self) -> bool {
        [self.x, self.y, self.z] == [0.0; 3]
    }

    fn set(&mut self, number: u64, value: &Value<'_>) {
        let slot = match number {
            1 => &mut self.x,
            2 => &mut self.y,
            3 => &mut self.z,
            _ => return,
        };
        *slot = value.double();
    }
}

/// The message as `sensor_msgs/LaserScan` of ROS 1; `None` if the encoding is another one.
///
/// # Errors
/// If the message is malformed, or its scan is not at the origin of its frame.
pub fn as_ros1(encoding: &str, bytes: &[u8]) -> Option<Result<Vec<u8>, String>> {
    let scan = match encoding {
        "protobuf" => of_protobuf(bytes),
        "json" => serde_json::from_slice(bytes).map_err(|problem| problem.to_string()),
        _ => return None,
    };
    Some(scan.and_then(|scan| {
        if scan.pose.position.is_zero() && scan.pose.orientation.is_zero() {
            return Ok(scan.to_ros1());
        }
        Err("its pose is not zero; publish the scan in the laser's own frame".to_owned())
    }))
}

impl Scan {
    fn to_ros1(&self) -> Vec<u8> {
        let mut bytes = vec![0; 4];
        bytes.extend(self.timestamp.sec.to_le_bytes());
        bytes.extend(self.timestamp.nsec.to_le_bytes());
        bytes.extend((self.frame_id.len() as u32).to_le_bytes());
        bytes.extend(self.frame_id.as_bytes());
        let steps = self.ranges.len().saturating_sub(1).max(1) as f64;
        let step = (self.end_angle - self.start_angle) / steps;
        // Angles, times (unknown), and limits (none).
        let fields = [self.start_angle, self.end_angle, step, 0.0, 0.0, 0.0];
        for field in fields.into_iter().chain([f64::INFINITY]) {
            bytes.extend((field as f32).to_le_bytes());
        }
        bytes.extend((self.ranges.len() as u32).to_le_bytes());
        for range in &self.ranges {
            bytes.extend((range.unwrap_or(f64::NAN) as f32).to_le_bytes());
        }
        bytes.extend([0; 4]);
        bytes
    }
}

fn of_protobuf(bytes: &[u8]) -> Result<Scan, String> {
    let mut scan = Scan::default();
    each_field(bytes, |number, value| {
        match number {
            1 => each_field(value.bytes(), |number, value| {
                match number {
                    1 => scan.timestamp.sec = value.integer() as u32,
                    2 => scan.timestamp.nsec = value.integer() as u32,
                    _ => {}
                }
                Ok(())
            })?,
            2 => scan.frame_id = String::from_utf8_lossy(value.bytes()).into_owned(),
            3 => each_field(value.bytes(), |number, value| {
                let axes = match number {
                    1 => &mut scan.pose.position,
                    2 => &mut scan.pose.orientation,
                    _ => return Ok(()),
                };
                each_field(value.bytes(), |number, value| {
                    axes.set(number, &value);
                    Ok(())
                })
            })?,
            4 => scan.start_angle = value.double(),
            5 => scan.end_angle = value.double(),
            6 => match value {
                Value::Bytes(packed) => {
                    let doubles = packed.chunks_exact(8);
                    scan.ranges
                        .extend(doubles.map(|double| Some(Value::of_double(double).double())));
                }
                single => scan.ranges.push(Some(single.double())),
            },
            _ => {}
        }
        Ok(())
    })?;
    Ok(scan)
}

/// The value of a field.
enum Value<'a> {
    Integer(u64),
    Double(u64),
    Bytes(&'a [u8]),
}

impl<'a> Value<'a> {
    fn of_double(bytes: &[u8]) -> Self {
        let mut eight = [0; 8];
        eight.copy_from_slice(bytes);
        Self::Double(u64::from_le_bytes(eight))
    }

    fn integer(&self) -> u64 {
        match self {
            Self::Integer(value) => *value,
            _ => 0,
        }
    }

    fn double(&self) -> f64 {
        match self {
            Self::Double(bits) => f64::from_bits(*bits),
            _ => 0.0,
        }
    }

    fn bytes(&self) -> &'a [u8] {
        match self {
            Self::Bytes(bytes) => bytes,
            _ => &[],
        }
    }
}

/// Visits the fields of a protobuf message.
fn each_field<'a>(
    mut bytes: &'a [u8],
    mut visit: impl FnMut(u64, Value<'a>) -> Result<(), String>,
) -> Result<(), String> {
    let cut_off = || "the message is cut off".to_owned();
    while !bytes.is_empty() {
        let key = varint(&mut bytes).ok_or_else(cut_off)?;
        let mut take = |count: u64| {
            let count = usize::try_from(count).ok()?;
            let (taken, rest) = bytes.split_at_checked(count)?;
            bytes = rest;
            Some(taken)
        };
        let value = match key & 7 {
            0 => Value::Integer(varint(&mut bytes).ok_or_else(cut_off)?),
            1 => Value::of_double(take(8).ok_or_else(cut_off)?),
            2 => {
                let length = varint(&mut bytes).ok_or_else(cut_off)?;
                let (taken, rest) = usize::try_from(length)
                    .ok()
                    .and_then(|length| bytes.split_at_checked(length))
                    .ok_or_else(cut_off)?;
                bytes = rest;
                Value::Bytes(taken)
            }
            5 => {
                take(4).ok_or_else(cut_off)?;
                continue;
            }
            other => return Err(format!("a field has the unknown wire type {other}")),
        };
        visit(key >> 3, value)?;
    }
    Ok(())
}

/// The next variable-length integer.
fn varint(bytes: &mut &[u8]) -> Option<u64> {
    let mut value = 0_u64;
    for shift in (0..64).step_by(7) {
        let (&byte, rest) = bytes.split_first()?;
        *bytes = rest;
        value |= u64::from(byte & 0x7f) << shift;
        if byte & 0x80 == 0 {
            return Some(value);
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A field of a message: key, length and bytes.
    fn field(number: u8, bytes: &[u8]) -> Vec<u8> {
        [&[number << 3 | 2, bytes.len() as u8], bytes].concat()
    }

    fn double(number: u8, value: f64) -> Vec<u8> {
        [&[number << 3 | 1][..], &value.to_le_bytes()].concat()
    }

    fn message(pose: &[u8]) -> Vec<u8> {
        let ranges: Vec<u8> = [1.5_f64, 2.0, 2.5]
            .iter()
            .flat_map(|range| range.to_le_bytes())
            .collect();
        [
            field(1, &[8, 0x96, 1, 16, 5]),
            field(2, b"laser"),
            field(3, pose),
            double(4, -0.5),
            double(5, 0.5),
            field(6, &ranges),
        ]
        .concat()
    }

    #[test]
    fn protobuf_and_json_are_the_same_scan() {
        let json = br#"{"timestamp":{"sec":150,"nsec":5},"frame_id":"laser","pose":{"position":{"x":0,"y":0,"z":0},"orientation":{"x":0,"y":0,"z":0,"w":1}},"start_angle":-0.5,"end_angle":0.5,"ranges":[1.5,2.0,2.5],"intensities":[]}"#;
        let of_json = as_ros1("json", json).unwrap().unwrap();
        let of_protobuf = as_ros1("protobuf", &message(&[])).unwrap().unwrap();
        assert_eq!(of_json, of_protobuf);
        assert_eq!(of_json.len(), 4 + 8 + 4 + 5 + 7 * 4 + 4 + 3 * 4 + 4);
        assert!(as_ros1("flatbuffer", json).is_none());
    }

    #[test]
    fn a_scan_elsewhere_in_its_frame_is_rejected_and_so_is_a_part() {
        let moved = message(&field(1, &double(1, 0.2)));
        let problem = as_ros1("protobuf", &moved).unwrap().unwrap_err();
        assert!(problem.starts_with("its pose is not zero"), "{problem}");
        let whole = message(&[]);
        for length in 1..whole.len() {
            // Cut between two fields, it is a scan of fewer of them.
            let _ = as_ros1("protobuf", &whole[..length]).unwrap();
        }
        assert!(
            as_ros1("protobuf", &whole[..whole.len() - 1])
                .unwrap()
                .is_err()
        );
    }
}
