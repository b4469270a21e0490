//! Pages of a database, read on demand.

use std::io::{Read, Seek, SeekFrom};

use super::write_ahead::WriteAhead;
use crate::log_bytes::SeekRead;
use crate::ros::container::ContainerError;

/// Bytes of the file header, which precedes the first page's own header.
pub const FILE_HEADER: usize = 100;

/// The pages of a file.
pub struct Pages<'a> {
    source: Box<dyn SeekRead + 'a>,
    /// Newer copies of pages.
    newer: Option<WriteAhead<'a>>,
    /// Position of the source.
    at: u64,
    size: usize,
    /// Bytes of a page without those reserved at its end.
    usable: usize,
    offset: u64,
}

impl<'a> Pages<'a> {
    /// Opens the pages of a file; the source must be at its start.
    pub fn new(
        mut source: Box<dyn SeekRead + 'a>,
        mut newer: Option<WriteAhead<'a>>,
    ) -> Result<Self, ContainerError> {
        let mut header = [0; FILE_HEADER];
        source
            .read_exact(&mut header)
            .map_err(|error| match error.kind() {
                std::io::ErrorKind::UnexpectedEof => {
                    ContainerError::CutOff("expected the header of a database".to_owned())
                }
                _ => ContainerError::Io(error),
            })?;
        let of_newer = newer.as_mut().map(|newer| newer.page(1)).transpose()?;
        if let Some(first) = of_newer.flatten() {
            header.copy_from_slice(&first[..FILE_HEADER]);
        }
        let size = match u16::from_be_bytes([header[16], header[17]]) {
            1 => 65_536,
            size => usize::from(size),
        };
        let usable = size.saturating_sub(usize::from(header[20]));
        if !size.is_power_of_two() || size < 512 || usable < 480 {
            return Err(ContainerError::Broken(format!(
                "expected pages of 512 to 65536 bytes, found {size}"
            )));
        }
        // 2 and 3 are UTF-16, which rosbag2 never writes.
        if u32::from_be_bytes([header[56], header[57], header[58], header[59]]) > 1 {
            return Err(ContainerError::Broken(
                "expected text in UTF-8, but the database uses UTF-16; pass a recording of ros2 bag record".to_owned(),
            ));
        }
        Ok(Self {
            source,
            newer: newer.filter(|newer| newer.size == size),
            at: FILE_HEADER as u64,
            size,
            usable,
            offset: FILE_HEADER as u64,
        })
    }

    /// Data bytes of a page.
    pub fn usable(&self) -> usize {
        self.usable
    }

    /// End of the last page read.
    pub fn offset(&self) -> u64 {
        self.offset
    }

    /// Reads a page by its number, counted from 1, without the reserved bytes.
    pub fn page(&mut self, number: u32) -> Result<Vec<u8>, ContainerError> {
        let Some(index) = number.checked_sub(1) else {
            return Err(ContainerError::Skipped(
                "expected a page number, found 0".to_owned(),
            ));
        };
        if let Some(newer) = &mut self.newer
            && let Some(mut page) = newer.page(number)?
        {
            page.truncate(self.usable);
            return Ok(page);
        }
        let start = u64::from(index) * self.size as u64;
        let moved = match i64::try_from(i128::from(start) - i128::from(self.at)) {
            // Keeps the buffered bytes.
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
                "expected page {number} of the database, found {count} of its {} bytes",
                self.size
            )));
        }
        page.truncate(self.usable);
        Ok(page)
    }
}
