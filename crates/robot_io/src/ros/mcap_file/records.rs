//! Schemas, channels and messages: what the records of MCAP say.

use std::collections::{BTreeMap, BTreeSet};

use crate::lines::printable;
use crate::ros::container::{ContainerError, Recorded, kind_of};
use crate::ros::wire::{Wire, WireError, WireReader};

/// What a record is (1 byte), and its length.
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

/// What a record is, and its length.
pub fn head(bytes: &[u8]) -> Option<(u8, u64)> {
    let (&op, rest) = bytes.split_first()?;
    let (length, _) = rest.split_first_chunk()?;
    Some((op, u64::from_le_bytes(*length)))
}

/// The fields of a record: as those of ROS 1, without gaps.
pub fn fields(body: &[u8]) -> Result<WireReader<'_>, ContainerError> {
    WireReader::new(Wire::Ros1, body).map_err(broken)
}

/// A record that is not what it has to be.
pub fn broken(problem: WireError) -> ContainerError {
    ContainerError::Broken(format!("a record of MCAP: {problem}"))
}

/// Where messages of a type are published.
#[derive(Clone, Debug)]
struct Channel {
    topic: String,
    kind: String,
    /// Else the name of an encoding that is another system's.
    wire: Result<Wire, String>,
}

/// What was announced so far, by its numbers.
#[derive(Clone, Debug, Default)]
pub struct Records {
    /// Numbers of channels that messages named before they were announced.
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

    /// What stands in the file in place of messages of ROS; none where it has such messages or nothing.
    pub fn instead(&self) -> Option<String> {
        let (topic, encoding) = self.other.as_ref().filter(|_| !self.has_ros)?;
        let [topic, encoding] = [topic, encoding].map(|name| printable(name));
        Some(format!(
            "its messages are no messages of ROS, such as those on {topic} in the encoding ‘{encoding}’; record with ros2 bag record -s mcap"
        ))
    }

    /// Takes a record; answers with its message where it is one that can be read.
    pub fn take(&mut self, op: u8, body: &[u8]) -> Result<Option<Recorded>, ContainerError> {
        match op {
            op::SCHEMA => self.take_schema(body).map(|()| None).map_err(broken),
            op::CHANNEL => self.take_channel(body).map(|()| None).map_err(broken),
            op::MESSAGE => self.message(body),
            _ => Ok(None),
        }
    }

    fn take_schema(&mut self, body: &[u8]) -> Result<(), WireError> {
        let mut fields = WireReader::new(Wire::Ros1, body)?;
        let number = fields.u16("a schema's number")?;
        let name = fields.name("a schema's name")?;
        self.kinds.insert(number, kind_of(&name));
        Ok(())
    }

    fn take_channel(&mut self, body: &[u8]) -> Result<(), WireError> {
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
