//! Decompresses chunks by lz4, zstd and bzip2, without C code.

use std::io::Read;

use lz4_flex::frame::FrameDecoder;
use ruzstd::decoding::StreamingDecoder;

/// Bytes that any chunk may have, however small it is packed.
const ROOM: usize = 1 << 24;
/// Measurements are never packed to less than one byte in this many.
const MOST_PACKED: usize = 1000;

/// Compression of a chunk.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Packing {
    /// LZ4 frames.
    Lz4,
    /// Zstandard.
    Zstd,
    /// Bzip2.
    Bzip2,
}

impl Packing {
    /// Name in files.
    fn name(self) -> &'static str {
        match self {
            Self::Lz4 => "lz4",
            Self::Zstd => "zstd",
            Self::Bzip2 => "bz2",
        }
    }

    /// Decompresses `packed`, up to `most` bytes; fewer if a few bytes claim to be very many.
    ///
    /// # Errors
    /// If it is damaged or too large.
    pub fn unpack(self, packed: &[u8], most: usize) -> Result<Vec<u8>, String> {
        let most = most.min(ROOM.max(packed.len().saturating_mul(MOST_PACKED)));
        let mut content = Vec::new();
        let describe = |problem: &dyn std::fmt::Display| {
            format!(
                "a chunk cannot be decompressed as {}: {problem}",
                self.name()
            )
        };
        let most_and_one = most as u64 + 1;
        match self {
            Self::Lz4 => FrameDecoder::new(packed)
                .take(most_and_one)
                .read_to_end(&mut content)
                .map_err(|problem| describe(&problem))?,
            Self::Zstd => StreamingDecoder::new(packed)
                .map_err(|problem| describe(&problem))?
                .take(most_and_one)
                .read_to_end(&mut content)
                .map_err(|problem| describe(&problem))?,
            Self::Bzip2 => bzip2::read::BzDecoder::new(packed)
                .take(most_and_one)
                .read_to_end(&mut content)
                .map_err(|problem| describe(&problem))?,
        };
        if content.len() > most {
            return Err(format!(
                "a chunk of {} bytes decompresses to more than {most} bytes; no sensor's messages do, so record it again",
                packed.len()
            ));
        }
        Ok(content)
    }
}
