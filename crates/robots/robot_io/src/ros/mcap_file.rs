//! MCAP files: records, some of which are chunks of records.
//!
//! Source: "MCAP format specification", version 0, mcap.dev/spec. The crate `mcap` trusts the length of
//! a record inside a chunk, which costs memory or overflows; the format is small.

mod chunk;
mod foxglove;
mod records;

use std::io::BufRead;

use super::container::{Container, ContainerError, MAX_BYTES, Recorded};
use super::file_bytes::FileBytes;
pub use foxglove::LASER_SCAN;
pub use records::Records;
use records::{HEAD_BYTES, head, op};

/// First and last bytes of a file.
pub const MAGIC: &[u8] = b"\x89MCAP0\r\n";

/// Messages of an MCAP file, in the order of the file.
pub struct McapFile<R> {
    file: FileBytes<R>,
    is_started: bool,
    is_done: bool,
    records: Records,
    /// Records of the current chunk, from `chunk_at` on.
    chunk: Vec<u8>,
    chunk_at: usize,
    /// Whether the file ends within it.
    is_cut_off: bool,
}

impl<R: BufRead> McapFile<R> {
    /// Creates a reader at the file's start.
    pub fn new(source: R) -> Self {
        Self {
            file: FileBytes::new(source),
            is_started: false,
            is_done: false,
            records: Records::default(),
            chunk: Vec::new(),
            chunk_at: 0,
            is_cut_off: false,
        }
    }

    /// Sets topics that are declared later in the file.
    pub fn with_topics(mut self, records: Records) -> Self {
        self.records = records;
        self
    }

    /// The topics known by now, if messages were lost because their topic was declared later.
    pub fn late_topics(&self) -> Option<Records> {
        self.records.has_orphans().then(|| self.records.clone())
    }

    fn magic(&mut self) -> Result<(), ContainerError> {
        if self.file.read(MAGIC.len() as u64, "MCAP's magic")? == MAGIC {
            return Ok(());
        }
        Err(ContainerError::Broken("expected MCAP's magic".to_owned()))
    }

    /// Reads the next record of the file; returns its message if it is a readable one.
    fn next_record(&mut self) -> Result<Option<Recorded>, ContainerError> {
        let head_bytes = self.file.read(HEAD_BYTES as u64, "a record's head")?;
        let (op, length) = head(&head_bytes).expect("as many bytes as were taken");
        if op == op::ATTACHMENT {
            // It may exceed memory.
            return self.file.skip(length, "an attachment").map(|()| None);
        }
        let body = match self.file.up_to(length, "a record") {
            Ok(body) => body,
            Err(ContainerError::Broken(problem)) => return self.resync(&head_bytes, &[], problem),
            Err(other) => return Err(other),
        };
        let is_cut_off = (body.len() as u64) < length;
        if is_cut_off {
            let problem = format!("expected a record of {length} bytes, found {}", body.len());
            // A wrong length may cover intact chunks.
            return match self.resync(&head_bytes, &body, problem.clone()) {
                Err(ContainerError::Broken(_)) if op == op::CHUNK => {
                    self.chunk = chunk::records(&body, true)?;
                    self.is_cut_off = true;
                    self.chunk_at = 0;
                    Ok(None)
                }
                Err(ContainerError::Broken(_)) => Err(ContainerError::CutOff(problem)),
                other => other,
            };
        }
        match op {
            op::CHUNK => match chunk::records(&body, false) {
                Ok(records) => {
                    self.chunk = records;
                    self.chunk_at = 0;
                    Ok(None)
                }
                Err(ContainerError::Broken(problem)) => self.after(&body, problem),
                Err(other) => Err(other),
            },
            op::SCHEMA | op::CHANNEL | op::MESSAGE => match self.records.read(op, &body) {
                Err(ContainerError::Broken(problem)) => Err(ContainerError::Skipped(problem)),
                other => other,
            },
            op::FOOTER => {
                self.is_done = true;
                self.magic().map(|()| None)
            }
            1..=15 | 128.. => Ok(None),
            _ => self.resync(
                &head_bytes,
                &body,
                format!("a record is of the unknown kind {op}"),
            ),
        }
    }

    /// After an unreadable chunk: its length is right if a record or the end follows.
    fn after(&mut self, body: &[u8], problem: String) -> Result<Option<Recorded>, ContainerError> {
        let next = self.file.up_to(HEAD_BYTES as u64, "a record's head")?;
        self.file.put_back(&next);
        let holds = head(&next)
            .is_none_or(|(op, length)| (1..=15).contains(&op) && length <= MAX_BYTES as u64);
        if holds {
            return Err(ContainerError::Skipped(problem));
        }
        self.resync(&[], body, problem)
    }

    /// Resynchronizes at the next chunk after the first byte of what was read.
    fn resync(
        &mut self,
        head: &[u8],
        body: &[u8],
        problem: String,
    ) -> Result<Option<Recorded>, ContainerError> {
        let taken = [head, body].concat();
        self.file.put_back(taken.get(1..).unwrap_or_default());
        if self.file.seek(chunk::LONGEST_START, chunk::begins)? {
            Err(ContainerError::Skipped(problem))
        } else {
            Err(ContainerError::Broken(problem))
        }
    }

    /// Reads the next record of the chunk.
    fn next_of_chunk(&mut self) -> Result<Option<Recorded>, ContainerError> {
        let rest = &self.chunk[self.chunk_at..];
        let body = head(rest).and_then(|(op, length)| {
            let length = usize::try_from(length).ok()?;
            let body = rest[HEAD_BYTES..].get(..length)?;
            Some((op, body))
        });
        let Some((op, body)) = body else {
            self.chunk_at = self.chunk.len();
            let problem = "expected the end of a record inside a chunk".to_owned();
            return Err(match self.is_cut_off {
                true => ContainerError::CutOff(problem),
                false => ContainerError::Skipped(problem),
            });
        };
        self.chunk_at += HEAD_BYTES + body.len();
        match self.records.read(op, body) {
            Err(ContainerError::Broken(problem)) => Err(ContainerError::Skipped(problem)),
            other => other,
        }
    }
}

impl<R: BufRead> Container for McapFile<R> {
    fn next_message(&mut self) -> Result<Option<Recorded>, ContainerError> {
        if !self.is_started {
            self.magic()?;
            self.is_started = true;
        }
        while !self.is_done {
            let message = if self.chunk_at < self.chunk.len() {
                self.next_of_chunk()?
            } else {
                self.next_record()?
            };
            if message.is_some() {
                return Ok(message);
            }
        }
        Ok(None)
    }

    fn offset(&self) -> u64 {
        self.file.offset()
    }

    fn instead(&self) -> Option<String> {
        self.records.instead()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn record(op: u8, body: &[u8]) -> Vec<u8> {
        [&[op][..], &(body.len() as u64).to_le_bytes(), body].concat()
    }

    /// A file with one uncompressed chunk.
    fn file(records: &[u8], packed: u64) -> Vec<u8> {
        let size = (records.len() as u64).to_le_bytes();
        let head = [&[0; 16], &size[..], &[0; 8], &packed.to_le_bytes()].concat();
        [MAGIC, &record(op::CHUNK, &[&head, records].concat())].concat()
    }

    #[test]
    fn a_length_inside_a_chunk_never_exceeds_the_chunk() {
        let whole = record(15, &[0; 4]);
        for length in [1, 200_000_000, u64::MAX] {
            let mut records = whole.clone();
            records.push(op::MESSAGE);
            records.extend_from_slice(&length.to_le_bytes());
            let bytes = file(&records, records.len() as u64);
            // Bytes after the chunk must not be read.
            let bytes = [bytes, record(15, &[0; 40])].concat();
            let error = McapFile::new(&bytes[..]).next_message().unwrap_err();
            let is_named = matches!(&error, ContainerError::Skipped(error) if error.contains("inside a chunk"));
            assert!(is_named, "{length}: {error:?}");
        }
        let lie = file(&whole, 1000);
        let error = McapFile::new(&lie[..]).next_message().unwrap_err();
        assert!(matches!(error, ContainerError::Skipped(error) if error.contains("1000 bytes")));
    }

    #[test]
    fn an_unused_record_may_exceed_memory() {
        let bytes = [MAGIC, &[9], &(1_u64 << 40).to_le_bytes(), &[0; 100]].concat();
        let error = McapFile::new(&bytes[..]).next_message().unwrap_err();
        assert!(matches!(error, ContainerError::CutOff(error) if error.contains("found 100")));
    }
}
