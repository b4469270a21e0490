//! Compressed chunks, unpacked whole: lz4, zstd and bzip2, each without C.

use std::io::Read;

use lz4_flex::frame::FrameDecoder;
use mcap::McapError;
use mcap::sans_io::decompressor::{DecompressResult, Decompressor};
use ruzstd::decoding::StreamingDecoder;

use super::container::MOST_BYTES;

/// How a chunk is packed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Packing {
    /// LZ4's frames.
    Lz4,
    /// Zstandard.
    Zstd,
    /// Bzip2.
    Bzip2,
}

impl Packing {
    /// The name that files give it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Lz4 => "lz4",
            Self::Zstd => "zstd",
            Self::Bzip2 => "bz2",
        }
    }

    /// The whole content of `packed`, up to `most` bytes.
    ///
    /// # Errors
    /// What is wrong with it, in a few words.
    pub fn unpack(self, packed: &[u8], most: usize) -> Result<Vec<u8>, String> {
        let mut content = Vec::new();
        let told = |problem: &dyn std::fmt::Display| {
            format!("a chunk does not unpack as {}: {problem}", self.name())
        };
        let most_and_one = most as u64 + 1;
        match self {
            Self::Lz4 => FrameDecoder::new(packed)
                .take(most_and_one)
                .read_to_end(&mut content)
                .map_err(|problem| told(&problem))?,
            Self::Zstd => StreamingDecoder::new(packed)
                .map_err(|problem| told(&problem))?
                .take(most_and_one)
                .read_to_end(&mut content)
                .map_err(|problem| told(&problem))?,
            Self::Bzip2 => bzip2_rs::DecoderReader::new(packed)
                .take(most_and_one)
                .read_to_end(&mut content)
                .map_err(|problem| told(&problem))?,
        };
        if content.len() > most {
            return Err(format!("a chunk unpacks to more than {most} bytes"));
        }
        Ok(content)
    }
}

/// One of them as MCAP's reader asks for it.
pub struct ChunkUnpacker {
    packing: Packing,
    content: Option<Vec<u8>>,
    given: usize,
}

impl ChunkUnpacker {
    /// A decompressor for the chunks that are packed this way.
    pub fn new(packing: Packing) -> Self {
        Self {
            packing,
            content: None,
            given: 0,
        }
    }
}

impl Decompressor for ChunkUnpacker {
    /// All of the chunk at once: the reader caps it at the chunk's end.
    fn next_read_size(&self) -> usize {
        if self.content.is_none() {
            usize::MAX
        } else {
            0
        }
    }

    fn decompress(&mut self, src: &[u8], dst: &mut [u8]) -> Result<DecompressResult, McapError> {
        let consumed = if self.content.is_none() {
            let content = self.packing.unpack(src, MOST_BYTES);
            self.content = Some(content.map_err(McapError::DecompressionError)?);
            self.given = 0;
            src.len()
        } else {
            0
        };
        let content = self.content.as_deref().unwrap_or_default();
        let wrote = dst.len().min(content.len() - self.given);
        dst[..wrote].copy_from_slice(&content[self.given..self.given + wrote]);
        self.given += wrote;
        Ok(DecompressResult { consumed, wrote })
    }

    fn reset(&mut self) -> Result<(), McapError> {
        self.content = None;
        Ok(())
    }

    fn name(&self) -> &'static str {
        self.packing.name()
    }
}
