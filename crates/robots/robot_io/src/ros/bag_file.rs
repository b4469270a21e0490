//! ROS 1 bags, version 2.0: records with a header of named fields and data; some are chunks of records.
//!
//! Source: "Bag format, version 2.0", wiki.ros.org/Bags/Format/2.0. The crate `rosbag` maps files
//! into memory and needs C, which a browser cannot do; the format is small.

mod records;

use std::io::BufRead;

use super::container::{Container, ContainerError, MAX_BYTES, Recorded};
use super::decompress::Packing;
use super::file_bytes::FileBytes;
pub use records::Connections;
use records::{HeaderFields, LONGEST_START, begins, op, piece};

const MAGIC: &[u8] = b"#ROSBAG V2.0\n";

/// Messages of a bag, in the order of the file.
pub struct BagFile<R> {
    file: FileBytes<R>,
    is_started: bool,
    connections: Connections,
    /// Records of the current chunk, from `chunk_at` on.
    chunk: Vec<u8>,
    chunk_at: usize,
}

impl<R: BufRead> BagFile<R> {
    /// Creates a reader at the file's start.
    pub fn new(source: R) -> Self {
        Self {
            file: FileBytes::new(source),
            is_started: false,
            connections: Connections::default(),
            chunk: Vec::new(),
            chunk_at: 0,
        }
    }

    /// Sets topics that are declared later in the file.
    pub fn with_topics(mut self, connections: Connections) -> Self {
        self.connections = connections;
        self
    }

    /// The topics known by now, if messages were lost because their topic was declared later.
    pub fn late_topics(&self) -> Option<Connections> {
        let has_orphans = self.connections.has_orphans();
        has_orphans.then(|| self.connections.clone())
    }

    /// Appends a length and that many bytes to `taken`; returns false if they are incomplete or too long.
    fn with_length(&mut self, what: &str, taken: &mut Vec<u8>) -> Result<bool, ContainerError> {
        let length = self.file.up_to(4, "a length")?;
        taken.extend_from_slice(&length);
        let Ok(length) = <[u8; 4]>::try_from(length) else {
            return Ok(false);
        };
        let length = u64::from(u32::from_le_bytes(length));
        if length > MAX_BYTES as u64 {
            return Ok(false);
        }
        let bytes = self.file.up_to(length, what)?;
        taken.extend_from_slice(&bytes);
        Ok(bytes.len() as u64 == length)
    }

    /// Reads the next record of the file; returns its message if it is one.
    fn next_record(&mut self) -> Result<Option<Recorded>, ContainerError> {
        let mut taken = Vec::new();
        if !self.with_length("a record's header", &mut taken)? {
            return self.resync(&taken, true, "expected a record's header".to_owned());
        }
        let header_end = taken.len();
        let header = taken[4..].to_vec();
        let fields = match HeaderFields::parse(&header)
            .and_then(|fields| fields.op().map(|op| (op, fields)))
        {
            Ok(fields) => fields,
            Err(problem) => return self.resync(&taken, false, problem),
        };
        let (op, fields) = fields;
        if !self.with_length("a record's data", &mut taken)? {
            return self.resync(&taken, true, "expected a record's data".to_owned());
        }
        let data = &taken[header_end + 4..];
        // A wrong length of an index would swallow the records after it.
        if op == op::INDEX
            && fields
                .u32("count")
                .is_ok_and(|count| count as usize * op::INDEX_ENTRY != data.len())
        {
            let problem = "the length of an index does not match its count".to_owned();
            return self.resync(&taken, false, problem);
        }
        let read = match op {
            op::CHUNK => unpacked(&fields, data.to_vec()).map(|chunk| {
                self.chunk = chunk;
                self.chunk_at = 0;
                None
            }),
            // Version 2.0 stores messages in chunks; some writers do not.
            _ => self.connections.read(&fields, data),
        };
        match read {
            Err(problem) if self.is_at_record()? => Err(ContainerError::Skipped(problem)),
            Err(problem) => self.resync(&taken, false, problem),
            Ok(message) => Ok(message),
        }
    }

    /// Whether a record or the end of the file follows.
    fn is_at_record(&mut self) -> Result<bool, ContainerError> {
        let next = self.file.up_to(LONGEST_START as u64, "a record")?;
        self.file.put_back(&next);
        Ok(next.is_empty() || begins(&next))
    }

    /// Resynchronizes at the next record after the first byte of `taken`.
    fn resync(
        &mut self,
        taken: &[u8],
        is_cut_off: bool,
        problem: String,
    ) -> Result<Option<Recorded>, ContainerError> {
        self.file.put_back(taken.get(1..).unwrap_or_default());
        if self.file.seek(LONGEST_START, begins)? {
            return Err(ContainerError::Skipped(problem));
        }
        if is_cut_off {
            Err(ContainerError::CutOff(problem))
        } else {
            Err(ContainerError::Broken(problem))
        }
    }

    /// Reads the next record of the chunk.
    fn next_of_chunk(&mut self) -> Result<Option<Recorded>, String> {
        let mut rest = &self.chunk[self.chunk_at..];
        // After an error, the next call is at the end of the chunk.
        self.chunk_at = self.chunk.len();
        let header = piece(&mut rest, "a record's header inside a chunk")?;
        let data = piece(&mut rest, "a record's data inside a chunk")?;
        self.chunk_at = self.chunk.len() - rest.len();
        self.connections.read(&HeaderFields::parse(header)?, data)
    }
}

impl<R: BufRead> Container for BagFile<R> {
    fn next_message(&mut self) -> Result<Option<Recorded>, ContainerError> {
        if !self.is_started {
            if self.file.read(MAGIC.len() as u64, "‘#ROSBAG V2.0’")? != MAGIC {
                return Err(ContainerError::Broken(
                    "expected ‘#ROSBAG V2.0’; convert an older bag with rosbag fix".to_owned(),
                ));
            }
            self.is_started = true;
        }
        loop {
            let message = if self.chunk_at < self.chunk.len() {
                self.next_of_chunk().map_err(ContainerError::Skipped)?
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

/// Decompresses a chunk with this header.
fn unpacked(fields: &HeaderFields<'_>, data: Vec<u8>) -> Result<Vec<u8>, String> {
    let size = (fields.u32("size")? as usize).min(MAX_BYTES);
    match fields.name("compression")?.as_str() {
        "none" => Ok(data),
        "lz4" => Packing::Lz4.unpack(&data, size),
        "bz2" => Packing::Bzip2.unpack(&data, size),
        other => Err(format!(
            "expected a chunk compressed by bz2, lz4 or none, found ‘{}’",
            crate::lines::printable(other)
        )),
    }
}
