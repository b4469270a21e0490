//! The write-ahead log beside a database: pages that a killed recording did not move into it.
//!
//! Source: "Database File Format", sqlite.org/fileformat2.html, section 4.

use std::collections::BTreeMap;
use std::io::{Read, Seek, SeekFrom};

use crate::log_bytes::SeekRead;
use crate::ros::container::ContainerError;

/// Bytes of the header, and of that of a frame.
const HEADER: usize = 32;
const FRAME_HEADER: usize = 24;
/// Magic of either order of words in checksums, little-endian and big-endian.
const MAGIC: [u32; 2] = [0x377f_0682, 0x377f_0683];

/// The latest committed copy of each page.
pub struct WriteAhead<'a> {
    source: Box<dyn SeekRead + 'a>,
    /// Bytes of a page.
    pub size: usize,
    /// Position of each page.
    pages: BTreeMap<u32, u64>,
}

impl<'a> WriteAhead<'a> {
    /// Finds the pages of a log; `None` if it is empty, damaged at its start or of another kind.
    pub fn new(mut source: Box<dyn SeekRead + 'a>) -> Result<Option<Self>, ContainerError> {
        let mut header = [0; HEADER];
        if !is_filled(&mut source, &mut header)? {
            return Ok(None);
        }
        let word = |at: usize| word(&header, at);
        let size = word(8) as usize;
        let is_known = MAGIC.contains(&word(0)) && size.is_power_of_two();
        if !is_known || !(512..=65_536).contains(&size) {
            return Ok(None);
        }
        let is_big = word(0) == MAGIC[1];
        let mut sum = add(is_big, [0; 2], &header[..24]);
        if sum != [word(24), word(28)] {
            return Ok(None);
        }
        let mut pages = BTreeMap::new();
        let mut uncommitted: Vec<(u32, u64)> = Vec::new();
        let mut frame = vec![0; FRAME_HEADER + size];
        let mut at = HEADER as u64;
        // A frame of an earlier log, or one that was not written completely, ends it.
        while is_filled(&mut source, &mut frame)? {
            let (head, page) = frame.split_at(FRAME_HEADER);
            if head[8..16] != header[16..24] {
                break;
            }
            sum = add(is_big, add(is_big, sum, &head[..8]), page);
            if sum != [self::word(head, 16), self::word(head, 20)] {
                break;
            }
            uncommitted.push((self::word(head, 0), at + FRAME_HEADER as u64));
            if self::word(head, 4) > 0 {
                pages.extend(uncommitted.drain(..));
            }
            at += frame.len() as u64;
        }
        Ok(Some(Self {
            source,
            size,
            pages,
        }))
    }

    /// Reads a page; `None` if the log does not have it.
    pub fn page(&mut self, number: u32) -> Result<Option<Vec<u8>>, ContainerError> {
        let Some(&at) = self.pages.get(&number) else {
            return Ok(None);
        };
        let mut page = vec![0; self.size];
        self.source
            .seek(SeekFrom::Start(at))
            .and_then(|_| self.source.read_exact(&mut page))
            .map_err(ContainerError::Io)?;
        Ok(Some(page))
    }
}

/// Reads all bytes; false at the end of the file.
fn is_filled(source: &mut dyn SeekRead, into: &mut [u8]) -> Result<bool, ContainerError> {
    match source.read_exact(into) {
        Ok(()) => Ok(true),
        Err(error) if error.kind() == std::io::ErrorKind::UnexpectedEof => Ok(false),
        Err(error) => Err(ContainerError::Io(error)),
    }
}

fn word(bytes: &[u8], at: usize) -> u32 {
    u32::from_be_bytes(bytes[at..at + 4].try_into().expect("four bytes"))
}

/// Continues a checksum over whole pairs of words.
fn add(is_big: bool, [mut first, mut second]: [u32; 2], bytes: &[u8]) -> [u32; 2] {
    for pair in bytes.chunks_exact(8) {
        let words = [0, 4].map(|at| {
            let word = word(pair, at);
            if is_big { word } else { word.swap_bytes() }
        });
        first = first.wrapping_add(words[0]).wrapping_add(second);
        second = second.wrapping_add(words[1]).wrapping_add(first);
    }
    [first, second]
}
