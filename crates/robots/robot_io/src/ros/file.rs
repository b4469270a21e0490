//! The files of a recording, opened in order for each pass.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::io::BufRead;
use std::rc::Rc;

use super::bag_file::{BagFile, Connections};
use super::container::{Container, ContainerError, MAX_BYTES, Recorded};
use super::decompress::Packing;
use super::mcap_file::{McapFile, Records};
use super::sqlite_file::SqliteFile;
use super::wire::Wire;
use crate::log_bytes::LogBytes;
use crate::log_format::LogFormat;

/// First bytes of zstd data; CDR begins with a zero.
const ZSTD: &[u8] = b"\x28\xb5\x2f\xfd";

/// Topics of a file by id, which may be declared again at its end.
#[derive(Clone)]
enum DeclaredTopics {
    Mcap(Records),
    Bag(Connections),
}

/// A file of a recording.
trait RosFile: Container {
    /// The topics known by now, if messages were lost because their topic was declared later.
    fn declared_topics(&self) -> Option<DeclaredTopics>;
}

impl<R: BufRead> RosFile for BagFile<R> {
    fn declared_topics(&self) -> Option<DeclaredTopics> {
        self.late_topics().map(DeclaredTopics::Bag)
    }
}

impl<R: BufRead> RosFile for McapFile<R> {
    fn declared_topics(&self) -> Option<DeclaredTopics> {
        self.late_topics().map(DeclaredTopics::Mcap)
    }
}

impl RosFile for SqliteFile<'_> {
    /// Its topics are in a table of their own.
    fn declared_topics(&self) -> Option<DeclaredTopics> {
        None
    }
}

/// Files of one recording, in order.
#[derive(Clone)]
pub struct RosFiles<'a> {
    parts: Vec<LogBytes<'a>>,
    /// Topics of a file that are declared only after damage.
    declared_topics: Rc<RefCell<BTreeMap<usize, DeclaredTopics>>>,
}

impl<'a> RosFiles<'a> {
    /// Creates from the files of a recording.
    pub fn new(parts: Vec<LogBytes<'a>>) -> Self {
        Self {
            parts,
            declared_topics: Rc::default(),
        }
    }

    /// Sorts the files by the time of their first message; keeps the order if one has none.
    pub fn sort_by_time(&mut self) {
        let first_s = |part: &LogBytes<'a>| {
            let mut messages = Self::new(vec![part.clone()]).messages();
            let first = messages.next_message().ok().flatten()?;
            Some(first.recorded_s).filter(|recorded_s| recorded_s.is_finite())
        };
        if self.parts.len() < 2 {
            return;
        }
        let timed: Option<Vec<(f64, LogBytes<'a>)>> = self
            .parts
            .iter()
            .map(|part| Some((first_s(part)?, part.clone())))
            .collect();
        if let Some(mut timed) = timed {
            timed.sort_by(|a, b| a.0.total_cmp(&b.0));
            self.parts = timed.into_iter().map(|(_, part)| part).collect();
        }
    }

    /// Iterates over their messages from the start.
    pub fn messages(&self) -> Messages<'a> {
        Messages {
            files: self.clone(),
            opened: 0,
            has_late_topics: false,
            current: None,
            before: 0,
        }
    }
}

/// The messages of several files in sequence.
pub struct Messages<'a> {
    files: RosFiles<'a>,
    opened: usize,
    /// Whether topics were found after messages that were lost without them.
    has_late_topics: bool,
    current: Option<Box<dyn RosFile + 'a>>,
    /// Bytes of the files before.
    before: u64,
}

impl Messages<'_> {
    /// Whether another pass can read messages that this one lost because their topic was unknown.
    pub fn has_late_topics(&self) -> bool {
        self.has_late_topics
    }

    /// Stores topics that the current file declared too late.
    fn keep_late_topics(&mut self) {
        let declared_topics = self
            .current
            .as_ref()
            .and_then(|current| current.declared_topics());
        if let Some(declared_topics) = declared_topics {
            let part = self.opened - 1;
            self.files
                .declared_topics
                .borrow_mut()
                .insert(part, declared_topics);
            self.has_late_topics = true;
        }
    }

    /// Opens the next file, if there is one.
    fn open_next(&mut self) -> Result<(), ContainerError> {
        self.keep_late_topics();
        self.before = self.offset();
        let Some(part) = self.files.parts.get(self.opened) else {
            return Ok(());
        };
        let known = self
            .files
            .declared_topics
            .borrow()
            .get(&self.opened)
            .cloned();
        self.opened += 1;
        let mut source = part.stream().map_err(ContainerError::Io)?;
        let start = source.fill_buf().map_err(ContainerError::Io)?;
        self.current = Some(match LogFormat::detect(start) {
            LogFormat::Sqlite => {
                drop(source);
                let source = part.seekable().map_err(ContainerError::Io)?;
                let newer = part.write_ahead().map_err(ContainerError::Io)?;
                Box::new(SqliteFile::new(source).with_write_ahead(newer))
            }
            LogFormat::RosBag => Box::new(match known {
                Some(DeclaredTopics::Bag(known)) => BagFile::new(source).with_topics(known),
                _ => BagFile::new(source),
            }),
            _ => Box::new(match known {
                Some(DeclaredTopics::Mcap(known)) => McapFile::new(source).with_topics(known),
                _ => McapFile::new(source),
            }),
        });
        Ok(())
    }
}

impl Container for Messages<'_> {
    fn next_message(&mut self) -> Result<Option<Recorded>, ContainerError> {
        loop {
            if let Some(current) = &mut self.current {
                match current.next_message() {
                    Ok(Some(message)) => return unpacked(message).map(Some),
                    Ok(None) => {}
                    // A truncated file does not end those after it.
                    Err(ContainerError::CutOff(problem) | ContainerError::Broken(problem))
                        if self.opened < self.files.parts.len() =>
                    {
                        self.open_next()?;
                        return Err(ContainerError::Skipped(problem));
                    }
                    Err(other) => return Err(other),
                }
            }
            if self.opened >= self.files.parts.len() {
                self.keep_late_topics();
                return Ok(None);
            }
            self.open_next()?;
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

/// Decompresses a message that rosbag2 compressed individually.
fn unpacked(mut message: Recorded) -> Result<Recorded, ContainerError> {
    if message.wire == Wire::Cdr && message.bytes.starts_with(ZSTD) {
        let unpacked = Packing::Zstd.unpack(&message.bytes, MAX_BYTES);
        message.bytes = unpacked.map_err(ContainerError::Skipped)?;
    }
    Ok(message)
}
