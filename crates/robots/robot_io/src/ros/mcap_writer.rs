//! Writes a recording as MCAP while it is made: records in the order of their arrival, without chunks and without an
//! index, so that what was written before a crash is readable.
//!
//! Source: "MCAP format specification", version 0, mcap.dev/spec. For the reader's reason the crate `mcap` is not used;
//! it would also bring in 24 crates.

use std::collections::BTreeMap;

use super::mcap_file::MAGIC;

/// Name of the program in the header.
const LIBRARY: &str = "slam2d";
/// Kinds of records.
const HEADER: u8 = 1;
const FOOTER: u8 = 2;
const SCHEMA: u8 = 3;
const CHANNEL: u8 = 4;
const MESSAGE: u8 = 5;
const DATA_END: u8 = 15;

/// A topic with the type and the encoding of its messages.
#[derive(Clone, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct Topic {
    /// Name.
    pub name: String,
    /// Encoding of the messages, such as `cdr`.
    pub encoding: String,
    /// Type of the messages, such as `sensor_msgs/msg/LaserScan`.
    pub schema: String,
    /// Encoding of the type's definition, such as `ros2msg`.
    pub schema_encoding: String,
    /// The type's definition.
    pub definition: Vec<u8>,
}

/// Makes the bytes of a recording; the caller writes them in the order in which they are returned.
#[derive(Clone, Debug, Default)]
pub struct McapWriter {
    numbers: BTreeMap<Topic, u16>,
}

impl McapWriter {
    /// Bytes before the first record.
    #[must_use]
    pub fn start(&self) -> Vec<u8> {
        let header = record(HEADER, &[&text(""), &text(LIBRARY)]);
        [MAGIC, &header].concat()
    }

    /// Number of a topic, and the bytes that declare it, which are empty if it was declared before; `None` if there are
    /// too many topics.
    pub fn declare(&mut self, topic: &Topic) -> Option<(u16, Vec<u8>)> {
        if let Some(number) = self.numbers.get(topic) {
            return Some((*number, Vec::new()));
        }
        let number = u16::try_from(self.numbers.len() + 1).ok()?;
        self.numbers.insert(topic.clone(), number);
        let id = number.to_le_bytes();
        let definition = [&length(&topic.definition)[..], &topic.definition].concat();
        let names = [&topic.schema, &topic.schema_encoding].map(|name| text(name));
        let schema = record(SCHEMA, &[&id, &names[0], &names[1], &definition]);
        let names = [&topic.name, &topic.encoding].map(|name| text(name));
        let channel = record(CHANNEL, &[&id, &id, &names[0], &names[1], &text("")]);
        Some((number, [schema, channel].concat()))
    }

    /// Bytes of a message of the topic `number`, recorded at `time_ns`.
    #[must_use]
    pub fn message(number: u16, time_ns: u64, bytes: &[u8]) -> Vec<u8> {
        let time = time_ns.to_le_bytes();
        record(
            MESSAGE,
            &[&number.to_le_bytes(), &[0; 4], &time, &time, bytes],
        )
    }

    /// Bytes after the last record.
    #[must_use]
    pub fn end() -> Vec<u8> {
        let end = [record(DATA_END, &[&[0; 4]]), record(FOOTER, &[&[0; 20]])].concat();
        [&end, MAGIC].concat()
    }
}

fn length(bytes: &[u8]) -> [u8; 4] {
    (bytes.len() as u32).to_le_bytes()
}

fn text(text: &str) -> Vec<u8> {
    [&length(text.as_bytes())[..], text.as_bytes()].concat()
}

fn record(kind: u8, fields: &[&[u8]]) -> Vec<u8> {
    let body = fields.concat();
    [&[kind][..], &(body.len() as u64).to_le_bytes(), &body].concat()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ros::container::Container as _;
    use crate::ros::mcap_file::McapFile;

    #[test]
    fn what_is_written_is_read_and_a_topic_is_declared_once() {
        let topic = Topic {
            name: "/scan".to_owned(),
            encoding: "cdr".to_owned(),
            schema: "sensor_msgs/msg/LaserScan".to_owned(),
            ..Topic::default()
        };
        let mut writer = McapWriter::default();
        let (number, declared) = writer.declare(&topic).unwrap();
        assert_eq!(writer.declare(&topic).unwrap(), (number, Vec::new()));
        let message = McapWriter::message(number, 1_500_000_000, &[1, 2]);
        let bytes = [writer.start(), declared, message, McapWriter::end()].concat();
        let mut file = McapFile::new(&bytes[..]);
        let read = file.next_message().unwrap().unwrap();
        assert_eq!(
            (&read.topic[..], &read.kind[..]),
            ("/scan", "sensor_msgs/LaserScan")
        );
        assert_eq!((read.recorded_s, &read.bytes[..]), (1.5, &[1, 2][..]));
        assert!(file.next_message().unwrap().is_none());
    }
}
