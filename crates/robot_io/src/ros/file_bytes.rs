//! The bytes of a file, counted as they are read.

use std::io::{self, BufRead, Read};

use super::container::{ContainerError, MOST_BYTES};

/// Bytes in their order, and how many there were.
pub struct FileBytes<R> {
    source: R,
    offset: u64,
}

impl<R: BufRead> FileBytes<R> {
    /// The bytes from a file's start on.
    pub fn new(source: R) -> Self {
        Self { source, offset: 0 }
    }

    /// Bytes read so far.
    pub fn offset(&self) -> u64 {
        self.offset
    }

    /// Whether no byte follows.
    pub fn is_at_end(&mut self) -> Result<bool, ContainerError> {
        let left = self.source.fill_buf().map_err(ContainerError::Io)?;
        Ok(left.is_empty())
    }

    /// `count` bytes.
    pub fn take(&mut self, count: u64, what: &str) -> Result<Vec<u8>, ContainerError> {
        let bytes = self.up_to(count, what)?;
        if (bytes.len() as u64) < count {
            return Err(cut_off(what, count, bytes.len() as u64));
        }
        Ok(bytes)
    }

    /// `count` bytes, or those that are left. They are read in pieces as they come: a length that is a
    /// lie costs no memory.
    pub fn up_to(&mut self, count: u64, what: &str) -> Result<Vec<u8>, ContainerError> {
        if count > MOST_BYTES as u64 {
            return Err(ContainerError::Broken(format!(
                "{what} of {MOST_BYTES} bytes at most was expected, and it has {count}"
            )));
        }
        let mut bytes = Vec::new();
        let read = self.source.by_ref().take(count).read_to_end(&mut bytes);
        self.offset += bytes.len() as u64;
        read.map_err(ContainerError::Io)?;
        Ok(bytes)
    }

    /// Goes over `count` bytes, which may be more than fit into memory.
    pub fn skip(&mut self, count: u64, what: &str) -> Result<(), ContainerError> {
        let mut skipped = self.source.by_ref().take(count);
        let there = io::copy(&mut skipped, &mut io::sink()).map_err(ContainerError::Io)?;
        self.offset += there;
        if there < count {
            return Err(cut_off(what, count, there));
        }
        Ok(())
    }
}

fn cut_off(what: &str, count: u64, there: u64) -> ContainerError {
    ContainerError::CutOff(format!(
        "{what} of {count} bytes was expected, and {there} are there"
    ))
}
