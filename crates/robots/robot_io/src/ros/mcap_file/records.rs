//! MCAP records of schemas, channels and messages.

use std::collections::{BTreeMap, BTreeSet};

use super::foxglove;
use crate::lines::printable;
use crate::ros::container::{ContainerError, Recorded, kind_of};
use crate::ros::wire::{Wire, WireError, WireReader};

/// Bytes of a record's kind (1) and length.
pub const HEAD_BYTES: usize = 9;

/// Kinds of records.
pub mod op {
    pub const FOOTER: u8 = 2;
    pub const SCHEMA: u8 = 3;
    pub const CHANNEL: u8 = 4;
    pub const MESSAGE: u8 = 5;
    pub const CHUNK: u8 = 6;
    pub const ATTACHMENT: u8 = 9;
}

/// Kind of a record, and its length.
pub fn head(bytes: &[u8]) -> Option<(u8, u64)> {
    let (&op, rest) = bytes.split_first()?;
    let (length, _) = rest.split_first_chunk()?;
    Some((op, u64::from_le_bytes(*length)))
}

/// Reader of a record's fields, which are serialized as in ROS 1.
pub fn fields(body: &[u8]) -> Result<WireReader<'_>, ContainerError> {
    WireReader::new(Wire::Ros1, body).map_err(broken)
}

/// A malformed record.
pub fn broken(problem: WireError) -> ContainerError {
    ContainerError::Broken(format!("an MCAP record: {problem}"))
}

/// A channel: topic, type and serialization.
#[derive(Clone, Debug)]
struct Channel {
    topic: String,
    kind: String,
    /// The error is the name of an unsupported encoding.
    wire: Result<Wire, String>,
}

/// Schemas and channels declared so far, by id.
#[derive(Clone, Debug, Default)]
pub struct Records {
    /// Ids of channels that messages used before they were declared.
    orphans: BTreeSet<u16>,
    kinds: BTreeMap<u16, String>,
    channels: BTreeMap<u16, Channel>,
    /// Topic and encoding of the first message that is not of ROS.
    other: Option<(String, String)>,
    has_ros: bool,
}

impl Records {
    /// Whether messages were lost whose channel is known by now.
    pub fn has_orphans(&self) -> bool {
        self.orphans
            .iter()
            .any(|number| self.channels.contains_key(number))
    }

    /// What the file contains instead of ROS messages; `None` if it has ROS messages or none at all.
    pub fn instead(&self) -> Option<String> {
        let (topic, encoding) = self.other.as_ref().filter(|_| !self.has_ros)?;
        let [topic, encoding] = [topic, encoding].map(|name| printable(name));
        Some(format!(
            "it has no ROS messages but, for example, those on {topic} with the encoding ‘{encoding}’; record with ros2 bag record -s mcap"
        ))
    }

    /// Reads a record; returns its message if it is a readable one.
    pub fn read(&mut self, op: u8, body: &[u8]) -> Result<Option<Recorded>, ContainerError> {
        match op {
            op::SCHEMA => self.read_schema(body).map(|()| None).map_err(broken),
            op::CHANNEL => self.read_channel(body).map(|()| None).map_err(broken),
            op::MESSAGE => self.message(body),
            _ => Ok(None),
        }
    }

    fn read_schema(&mut self, body: &[u8]) -> Result<(), WireError> {
        let mut fields = WireReader::new(Wire::Ros1, body)?;
        let number = fields.u16("a schema's number")?;
        let name = fields.name("a schema's name")?;
        self.kinds.insert(number, kind_of(&name));
        Ok(())
    }

    fn read_channel(&mut self, body: &[u8]) -> Result<(), WireError> {
        let mut fields = WireReader::new(Wire::Ros1, body)?;
        let number = fields.u16("a channel's number")?;
        let schema = fields.u16("a schema's number")?;
        let topic = fields.name("a topic")?;
        let encoding = fields.name("an encoding")?;
        let wire = match encoding.as_str() {
            "cdr" => Ok(Wire::Cdr),
            "ros1" => Ok(Wire::Ros1),
            _ => Err(encoding),
        };
        let kind = self.kinds.get(&schema).cloned().unwrap_or_default();
        self.channels.insert(number, Channel { topic, kind, wire });
        Ok(())
    }

    fn message(&mut self, body: &[u8]) -> Result<Option<Recorded>, ContainerError> {
        let mut fields = fields(body)?;
        let number = fields.u16("a channel's number").map_err(broken)?;
        fields.u32("a message's number").map_err(broken)?;
        let recorded_ns = fields.u64("a time").map_err(broken)?;
        fields.u64("a time").map_err(broken)?;
        let Some(channel) = self.channels.get(&number) else {
            self.orphans.insert(number);
            return Err(ContainerError::Broken(format!(
                "a message names channel {number}, which is unknown"
            )));
        };
        let wire = match &channel.wire {
            Ok(wire) => *wire,
            Err(encoding) if channel.kind == foxglove::LASER_SCAN => {
                let Some(scan) = foxglove::as_ros1(encoding, fields.rest()) else {
                    return Ok(None);
                };
                let named = |problem| {
                    let topic = printable(&channel.topic);
                    ContainerError::Skipped(format!("{} on {topic}: {problem}", channel.kind))
                };
                self.has_ros = true;
                return Ok(Some(Recorded {
                    topic: channel.topic.clone(),
                    kind: foxglove::AS_KIND.to_owned(),
                    wire: Wire::Ros1,
                    bytes: scan.map_err(named)?,
                    recorded_s: recorded_ns as f64 * 1e-9,
                }));
            }
            Err(encoding) => {
                let named = || (channel.topic.clone(), encoding.clone());
                self.other.get_or_insert_with(named);
                return Ok(None);
            }
        };
        self.has_ros = true;
        Ok(Some(Recorded {
            topic: channel.topic.clone(),
            kind: channel.kind.clone(),
            wire,
            bytes: fields.rest().to_vec(),
            recorded_s: recorded_ns as f64 * 1e-9,
        }))
    }
}
