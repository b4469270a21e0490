//! The files of a recording: opened for each pass, one after the other.

use std::io::BufRead;

use super::bag_file::BagFile;
use super::container::{Container, ContainerError, MOST_BYTES, Recorded};
use super::decompress::Packing;
use super::mcap_file::McapFile;
use super::sqlite_file::SqliteFile;
use super::wire::Wire;
use crate::log_bytes::LogBytes;
use crate::log_format::LogFormat;

/// The first bytes of what zstd has packed; CDR begins with a zero.
const ZSTD: &[u8] = b"\x28\xb5\x2f\xfd";

/// Files of one recording, in their order.
#[derive(Clone)]
pub struct RosFiles<'a> {
    parts: Vec<LogBytes<'a>>,
}

impl<'a> RosFiles<'a> {
    /// The files of a recording.
    pub fn new(parts: Vec<LogBytes<'a>>) -> Self {
        Self { parts }
    }

    /// Their messages from the first on.
    pub fn messages(&self) -> Messages<'a> {
        Messages {
            parts: self.parts.clone(),
            opened: 0,
            current: None,
            before: 0,
        }
    }
}

/// The messages of several files, one file after the other.
pub struct Messages<'a> {
    parts: Vec<LogBytes<'a>>,
    opened: usize,
    current: Option<Box<dyn Container + 'a>>,
    /// Bytes of the files before.
    before: u64,
}

impl Messages<'_> {
    /// Opens the next file; false where there is none.
    fn open_next(&mut self) -> Result<bool, ContainerError> {
        self.before = self.offset();
        let Some(part) = self.parts.get(self.opened) else {
            return Ok(false);
        };
        self.opened += 1;
        let mut source = part.stream().map_err(ContainerError::Io)?;
        let start = source.fill_buf().map_err(ContainerError::Io)?;
        self.current = Some(match LogFormat::detect(start) {
            LogFormat::Sqlite => {
                drop(source);
                let source = part.seekable().map_err(ContainerError::Io)?;
                Box::new(SqliteFile::new(source))
            }
            LogFormat::RosBag => Box::new(BagFile::new(source)),
            _ => Box::new(McapFile::new(source)),
        });
        Ok(true)
    }
}

impl Container for Messages<'_> {
    fn next_message(&mut self) -> Result<Option<Recorded>, ContainerError> {
        loop {
            if let Some(current) = &mut self.current {
                match current.next_message() {
                    Ok(Some(message)) => return unpacked(message).map(Some),
                    Ok(None) => {}
                    // A file that breaks off does not end those after it.
                    Err(ContainerError::CutOff(problem) | ContainerError::Broken(problem))
                        if self.opened < self.parts.len() =>
                    {
                        self.open_next()?;
                        return Err(ContainerError::Skipped(problem));
                    }
                    Err(other) => return Err(other),
                }
            }
            if self.opened >= self.parts.len() || !self.open_next()? {
                return Ok(None);
            }
        }
    }

    fn offset(&self) -> u64 {
        let of_current = self.current.as_ref().map_or(0, |current| current.offset());
        self.before + of_current
    }

    fn instead(&self) -> Option<String> {
        self.current.as_ref().and_then(|current| current.instead())
    }
}

/// A message that rosbag2 has packed by itself, unpacked.
fn unpacked(mut message: Recorded) -> Result<Recorded, ContainerError> {
    if message.wire == Wire::Cdr && message.bytes.starts_with(ZSTD) {
        let unpacked = Packing::Zstd.unpack(&message.bytes, MOST_BYTES);
        message.bytes = unpacked.map_err(ContainerError::Skipped)?;
    }
    Ok(message)
}
