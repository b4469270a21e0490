//! Pages of a database, read as they are needed.

use std::io::{Read, Seek, SeekFrom};

use crate::log_bytes::SeekRead;
use crate::ros::container::ContainerError;

/// The header of the file stands in front of the first page's own.
pub const FILE_HEADER: usize = 100;

/// The pages of a file.
pub struct Pages<'a> {
    source: Box<dyn SeekRead + 'a>,
    /// Where the source stands.
    at: u64,
    size: usize,
    /// Bytes of a page without those that are reserved at its end.
    usable: usize,
    offset: u64,
}

impl<'a> Pages<'a> {
    /// The pages of a file, whose source stands at its start.
    pub fn new(mut source: Box<dyn SeekRead + 'a>) -> Result<Self, ContainerError> {
        let mut header = [0; FILE_HEADER];
        source
            .read_exact(&mut header)
            .map_err(|error| match error.kind() {
                std::io::ErrorKind::UnexpectedEof => {
                    ContainerError::CutOff("the header of a database was expected".to_owned())
                }
                _ => ContainerError::Io(error),
            })?;
        let size = match u16::from_be_bytes([header[16], header[17]]) {
            1 => 65_536,
            size => usize::from(size),
        };
        let usable = size.saturating_sub(usize::from(header[20]));
        if !size.is_power_of_two() || size < 512 || usable < 480 {
            return Err(ContainerError::Broken(format!(
                "pages of 512 to 65536 bytes were expected, and the database has pages of {size}"
            )));
        }
        // 2 and 3 are UTF-16, which rosbag2 never writes.
        if u32::from_be_bytes([header[56], header[57], header[58], header[59]]) > 1 {
            return Err(ContainerError::Broken(
                "text in UTF-8 was expected, and the database has UTF-16; give a recording of ros2 bag record".to_owned(),
            ));
        }
        Ok(Self {
            source,
            at: FILE_HEADER as u64,
            size,
            usable,
            offset: FILE_HEADER as u64,
        })
    }

    /// Bytes of a page that hold data.
    pub fn usable(&self) -> usize {
        self.usable
    }

    /// Where the last page read ends.
    pub fn offset(&self) -> u64 {
        self.offset
    }

    /// A page by its number, which counts from 1, without what is reserved at its end.
    pub fn page(&mut self, number: u32) -> Result<Vec<u8>, ContainerError> {
        let Some(index) = number.checked_sub(1) else {
            return Err(ContainerError::Skipped(
                "a number of a page was expected, and 0 stands there".to_owned(),
            ));
        };
        let start = u64::from(index) * self.size as u64;
        let moved = match i64::try_from(i128::from(start) - i128::from(self.at)) {
            // What is buffered stays.
            Ok(by) => self.source.seek_relative(by),
            Err(_) => self.source.seek(SeekFrom::Start(start)).map(|_| ()),
        };
        moved.map_err(ContainerError::Io)?;
        let mut page = Vec::new();
        let count = self
            .source
            .by_ref()
            .take(self.size as u64)
            .read_to_end(&mut page)
            .map_err(ContainerError::Io)?;
        self.at = start + count as u64;
        if count > 0 {
            self.offset = self.offset.max(self.at);
        }
        if count < self.size {
            return Err(ContainerError::Skipped(format!(
                "page {number} of the database was expected, and {count} of its {} bytes are there",
                self.size
            )));
        }
        page.truncate(self.usable);
        Ok(page)
    }
}
