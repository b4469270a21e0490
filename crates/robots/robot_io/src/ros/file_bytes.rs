//! Bytes of a file, with a count of those read.

use std::collections::VecDeque;
use std::io::{self, BufRead, Read};

use super::container::{ContainerError, MAX_BYTES};

/// Bytes read at a time while searching for the next record.
const PIECE: usize = 1 << 16;

/// Sequential bytes with push-back.
pub struct FileBytes<R> {
    source: R,
    /// Bytes that were put back, which precede those of the source.
    back: VecDeque<u8>,
    offset: u64,
}

impl<R: BufRead> FileBytes<R> {
    /// Creates at a file's start.
    pub fn new(source: R) -> Self {
        Self {
            source,
            back: VecDeque::new(),
            offset: 0,
        }
    }

    /// Bytes read so far.
    pub fn offset(&self) -> u64 {
        self.offset
    }

    /// Whether no byte follows.
    pub fn is_at_end(&mut self) -> Result<bool, ContainerError> {
        if !self.back.is_empty() {
            return Ok(false);
        }
        let left = self.source.fill_buf().map_err(ContainerError::Io)?;
        Ok(left.is_empty())
    }

    /// Reads `count` bytes.
    pub fn read(&mut self, count: u64, what: &str) -> Result<Vec<u8>, ContainerError> {
        let bytes = self.up_to(count, what)?;
        if (bytes.len() as u64) < count {
            return Err(cut_off(what, count, bytes.len() as u64));
        }
        Ok(bytes)
    }

    /// Reads up to `count` bytes. They are read in pieces, so a wrong length costs no memory.
    pub fn up_to(&mut self, count: u64, what: &str) -> Result<Vec<u8>, ContainerError> {
        if count > MAX_BYTES as u64 {
            return Err(ContainerError::Broken(format!(
                "expected {what} of at most {MAX_BYTES} bytes, found {count}"
            )));
        }
        let held = self.back.len().min(count as usize);
        let mut bytes: Vec<u8> = self.back.drain(..held).collect();
        let left = count - held as u64;
        let read = self.source.by_ref().take(left).read_to_end(&mut bytes);
        self.offset += bytes.len() as u64;
        read.map_err(ContainerError::Io)?;
        Ok(bytes)
    }

    /// Skips `count` bytes, which may exceed memory.
    pub fn skip(&mut self, count: u64, what: &str) -> Result<(), ContainerError> {
        let held = self
            .back
            .len()
            .min(usize::try_from(count).unwrap_or(usize::MAX));
        self.back.drain(..held);
        let mut skipped = self.source.by_ref().take(count - held as u64);
        let there = io::copy(&mut skipped, &mut io::sink()).map_err(ContainerError::Io)?;
        let there = there + held as u64;
        self.offset += there;
        if there < count {
            return Err(cut_off(what, count, there));
        }
        Ok(())
    }
}

impl<R: BufRead> FileBytes<R> {
    /// Puts back the last bytes, to be read again.
    pub fn put_back(&mut self, bytes: &[u8]) {
        self.offset -= bytes.len() as u64;
        for &byte in bytes.iter().rev() {
            self.back.push_front(byte);
        }
    }

    /// Advances to the next record start that `begins` recognizes in a window of at least `window` bytes, less only at
    /// the end of the file. Returns whether there is one.
    pub fn seek(
        &mut self,
        window: usize,
        begins: impl Fn(&[u8]) -> bool,
    ) -> Result<bool, ContainerError> {
        loop {
            let bytes = self.up_to((PIECE + window) as u64, "a record")?;
            let is_end = bytes.len() < PIECE + window;
            let starts = if is_end { bytes.len() } else { PIECE };
            let found = (0..starts).find(|&at| begins(&bytes[at..]));
            let kept = found.unwrap_or(starts);
            self.put_back(&bytes[kept..]);
            if found.is_some() || is_end {
                return Ok(found.is_some());
            }
        }
    }
}

fn cut_off(what: &str, count: u64, there: u64) -> ContainerError {
    ContainerError::CutOff(format!("expected {what} of {count} bytes, found {there}"))
}
