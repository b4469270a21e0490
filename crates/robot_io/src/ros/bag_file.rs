//! Bags of ROS 1, version 2.0: records of a header with named fields and data, some of which are chunks
//! of records.
//!
//! Source: "Bag format, version 2.0", wiki.ros.org/Bags/Format/2.0. The crate `rosbag` maps files
//! into memory and needs C, so that it cannot work in a browser; the format is small.

mod records;

use std::io::BufRead;

use super::container::{Container, ContainerError, MOST_BYTES, Recorded};
use super::decompress::Packing;
use super::file_bytes::FileBytes;
use records::{Connections, Fields, op, piece};

const MAGIC: &[u8] = b"#ROSBAG V2.0\n";

/// Messages of a bag, in the order of the file.
pub struct BagFile<R> {
    file: FileBytes<R>,
    is_started: bool,
    connections: Connections,
    /// Records of the chunk under way, from `chunk_at` on.
    chunk: Vec<u8>,
    chunk_at: usize,
}

impl<R: BufRead> BagFile<R> {
    /// A reader at the file's start.
    pub fn new(source: R) -> Self {
        Self {
            file: FileBytes::new(source),
            is_started: false,
            connections: Connections::default(),
            chunk: Vec::new(),
            chunk_at: 0,
        }
    }

    fn with_length(&mut self, what: &str) -> Result<Vec<u8>, ContainerError> {
        let length = self.file.take(4, "a length")?;
        let length = u32::from_le_bytes(length.try_into().expect("four bytes"));
        self.file.take(u64::from(length), what)
    }

    /// Takes the next record of the file; answers with its message where it is one.
    fn next_record(&mut self) -> Result<Option<Recorded>, ContainerError> {
        let header = self.with_length("a record's header")?;
        let data = self.with_length("a record's data")?;
        let taken = Fields::of(&header).and_then(|fields| match fields.op()? {
            op::CHUNK => {
                self.chunk = unpacked(&fields, data)?;
                self.chunk_at = 0;
                Ok(None)
            }
            // Version 2.0 keeps messages in chunks; some writers do not.
            _ => self.connections.take(&fields, &data),
        });
        taken.map_err(ContainerError::Broken)
    }

    /// Takes the next record of the chunk.
    fn next_of_chunk(&mut self) -> Result<Option<Recorded>, String> {
        let mut rest = &self.chunk[self.chunk_at..];
        let header = piece(&mut rest, "a record's header inside of a chunk")?;
        let data = piece(&mut rest, "a record's data inside of a chunk")?;
        self.chunk_at = self.chunk.len() - rest.len();
        self.connections.take(&Fields::of(header)?, data)
    }
}

impl<R: BufRead> Container for BagFile<R> {
    fn next_message(&mut self) -> Result<Option<Recorded>, ContainerError> {
        if !self.is_started {
            if self.file.take(MAGIC.len() as u64, "‘#ROSBAG V2.0’")? != MAGIC {
                return Err(ContainerError::Broken(
                    "‘#ROSBAG V2.0’ was expected; convert an older bag with rosbag fix".to_owned(),
                ));
            }
            self.is_started = true;
        }
        loop {
            let message = if self.chunk_at < self.chunk.len() {
                self.next_of_chunk().map_err(ContainerError::Broken)?
            } else if self.file.is_at_end()? {
                return Ok(None);
            } else {
                self.next_record()?
            };
            if message.is_some() {
                return Ok(message);
            }
        }
    }

    fn offset(&self) -> u64 {
        self.file.offset()
    }
}

/// The records of a chunk with this header.
fn unpacked(fields: &Fields<'_>, data: Vec<u8>) -> Result<Vec<u8>, String> {
    let size = (fields.u32("size")? as usize).min(MOST_BYTES);
    match fields.name("compression")?.as_str() {
        "none" => Ok(data),
        "lz4" => Packing::Lz4.unpack(&data, size),
        "bz2" => Packing::Bzip2.unpack(&data, size),
        other => Err(format!(
            "a chunk packed by bz2, lz4 or none was expected, and it is packed by ‘{}’",
            crate::lines::printable(other)
        )),
    }
}
