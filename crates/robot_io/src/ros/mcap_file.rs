//! MCAP: records with channels and schemas, in chunks. The `mcap` crate knows the format.

use std::io::BufRead;

use mcap::sans_io::{LinearReaderOptions, MessageReadEvent, MessageReader};
use mcap::{McapError, McapResult};

use super::container::{Container, ContainerError, MOST_BYTES, Recorded, kind_of};
use super::decompress::{ChunkUnpacker, Packing};
use super::wire::Wire;
use crate::lines::printable;

/// So much is asked of the file at once: a length that is a lie costs no more.
const PIECE_BYTES: usize = 1 << 16;

/// Messages of an MCAP file, in the order of the file.
pub struct McapFile<R> {
    source: R,
    reader: MessageReader,
    offset: u64,
    is_done: bool,
    /// Topic and encoding of the first message that is not of ROS, as long as none is.
    other: Option<(String, String)>,
    has_ros: bool,
}

impl<R: BufRead> McapFile<R> {
    /// A reader at the file's start.
    pub fn new(source: R) -> Self {
        let options = LinearReaderOptions::default()
            .with_validate_chunk_crcs(true)
            .with_record_length_limit(MOST_BYTES);
        let mut reader = MessageReader::new_with_options(options);
        for packing in [Packing::Lz4, Packing::Zstd] {
            reader
                .add_decompressor(ChunkUnpacker::new(packing))
                .expect("they have names");
        }
        Self {
            source,
            reader,
            offset: 0,
            is_done: false,
            other: None,
            has_ros: false,
        }
    }

    fn next_event(&mut self) -> Result<Option<McapResult<MessageReadEvent>>, ContainerError> {
        loop {
            let wanted = match self.reader.next_event() {
                Some(Ok(MessageReadEvent::ReadRequest(wanted))) => wanted,
                other => return Ok(other),
            };
            let there = self.source.fill_buf().map_err(ContainerError::Io)?;
            let count = wanted.min(there.len()).min(PIECE_BYTES);
            self.reader.insert(count)[..count].copy_from_slice(&there[..count]);
            self.reader.notify_read(count);
            self.source.consume(count);
            self.offset += count as u64;
        }
    }
}

impl<R: BufRead> Container for McapFile<R> {
    fn next_message(&mut self) -> Result<Option<Recorded>, ContainerError> {
        while !self.is_done {
            let message = match self.next_event()? {
                Some(Ok(MessageReadEvent::Message(message))) => message,
                Some(Ok(MessageReadEvent::ReadRequest(_))) => continue,
                None => {
                    self.is_done = true;
                    break;
                }
                Some(Err(problem)) => {
                    self.is_done = true;
                    return Err(in_words(problem));
                }
            };
            let channel = &message.channel;
            let wire = match channel.message_encoding.as_str() {
                "cdr" => Wire::Cdr,
                "ros1" => Wire::Ros1,
                // Other encodings are other systems' messages.
                other => {
                    let named = || (channel.topic.clone(), other.to_owned());
                    self.other.get_or_insert_with(named);
                    continue;
                }
            };
            self.has_ros = true;
            let schema = channel.schema.as_ref();
            return Ok(Some(Recorded {
                topic: channel.topic.clone(),
                kind: kind_of(schema.map_or("", |schema| &schema.name)),
                wire,
                recorded_s: message.log_time as f64 * 1e-9,
                bytes: message.data.into_owned(),
            }));
        }
        Ok(None)
    }

    fn offset(&self) -> u64 {
        self.offset
    }

    fn instead(&self) -> Option<String> {
        let (topic, encoding) = self.other.as_ref().filter(|_| !self.has_ros)?;
        let [topic, encoding] = [topic, encoding].map(|name| printable(name));
        Some(format!(
            "its messages are no messages of ROS, such as those on {topic} in the encoding ‘{encoding}’; record with ros2 bag record -s mcap"
        ))
    }
}

fn in_words(problem: McapError) -> ContainerError {
    match problem {
        McapError::UnexpectedEof => {
            ContainerError::CutOff("the end of a record was expected".to_owned())
        }
        McapError::UnsupportedCompression(name) => ContainerError::Broken(format!(
            "a chunk packed by lz4, by zstd or not at all was expected, and it is packed by ‘{}’; convert it with mcap compress",
            printable(&name)
        )),
        McapError::DecompressionError(problem) => ContainerError::Broken(problem),
        other => {
            let mut said = other.to_string();
            if let McapError::Parse(_) = other {
                said = "a record of MCAP was expected".to_owned();
            }
            ContainerError::Broken(said)
        }
    }
}
