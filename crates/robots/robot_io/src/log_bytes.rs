//! Bytes of a log, which can be read more than once.
//!
//! Most faults of a recording show only in a pass over the whole file: a transform at its end, a clock that jumps back,
//! odometry that starts late. Therefore a log is scanned once before its first frame is read, and the caller passes a
//! function that opens it. Files compressed as a whole by gzip or zstd are decompressed on the fly.

use std::io::{self, BufRead, BufReader, Cursor, Read, Seek};
use std::rc::Rc;

use flate2::bufread::MultiGzDecoder;
use ruzstd::decoding::StreamingDecoder;

/// End of the name of a database's write-ahead log.
pub const WRITE_AHEAD: &str = "-wal";

/// Most bytes of a decompressed SQLite file: it needs random access and is kept in memory.
const MAX_UNPACKED: u64 = 1 << 30;

/// First bytes of gzip.
const GZIP: &[u8] = b"\x1f\x8b";
/// First bytes of zstd.
const ZSTD: &[u8] = b"\x28\xb5\x2f\xfd";

/// Bytes with random access.
pub trait SeekRead: BufRead + Seek {}

impl<T: BufRead + Seek> SeekRead for T {}

type Open<'a> = dyn Fn() -> io::Result<Box<dyn SeekRead + 'a>> + 'a;

/// The bytes of a log, opened again for each pass.
#[derive(Clone)]
pub struct LogBytes<'a> {
    open: Rc<Open<'a>>,
    /// The write-ahead log of a database.
    write_ahead: Option<Rc<Open<'a>>>,
}

impl<'a> LogBytes<'a> {
    /// Creates from a function that opens the bytes at their start.
    pub fn new<R: SeekRead + 'a>(open: impl Fn() -> io::Result<R> + 'a) -> Self {
        Self {
            open: Rc::new(move || Ok(Box::new(open()?) as Box<dyn SeekRead + 'a>)),
            write_ahead: None,
        }
    }

    /// Adds the write-ahead log of a database: the file beside it whose name ends in [`WRITE_AHEAD`].
    #[must_use]
    pub fn with_write_ahead(mut self, log: Self) -> Self {
        self.write_ahead = Some(log.open);
        self
    }

    /// The write-ahead log of a database, if it was given.
    ///
    /// # Errors
    /// If the system cannot read it.
    pub fn write_ahead(&self) -> io::Result<Option<Box<dyn SeekRead + 'a>>> {
        self.write_ahead.as_ref().map(|open| open()).transpose()
    }

    /// The decompressed bytes in order.
    ///
    /// # Errors
    /// If the system cannot read them.
    pub fn stream(&self) -> io::Result<Box<dyn BufRead + 'a>> {
        let mut source: Box<dyn BufRead + 'a> = Box::new((self.open)()?);
        // Compressed once, or twice by mistake.
        for _ in 0..2 {
            let start = source.fill_buf()?;
            source = if start.starts_with(GZIP) {
                Box::new(BufReader::with_capacity(
                    1 << 16,
                    MultiGzDecoder::new(source),
                ))
            } else if start.starts_with(ZSTD) {
                Box::new(BufReader::with_capacity(1 << 16, ZstdFrames::new(source)))
            } else {
                break;
            };
        }
        Ok(source)
    }

    /// The decompressed bytes with random access.
    ///
    /// # Errors
    /// If the system cannot read them, or the decompressed bytes exceed the memory bound.
    pub fn seekable(&self) -> io::Result<Box<dyn SeekRead + 'a>> {
        let mut source = (self.open)()?;
        let start = source.fill_buf()?;
        if !packs(start) {
            return Ok(source);
        }
        drop(source);
        let mut bytes = Vec::new();
        self.stream()?
            .take(MAX_UNPACKED + 1)
            .read_to_end(&mut bytes)?;
        if bytes.len() as u64 > MAX_UNPACKED {
            return Err(io::Error::other(
                "it decompresses to more than 1 GB; decompress it with zstd -d or gunzip first",
            ));
        }
        Ok(Box::new(Cursor::new(bytes)))
    }

    /// Whether the file is compressed as a whole.
    ///
    /// # Errors
    /// If the system cannot read it.
    pub fn is_packed(&self) -> io::Result<bool> {
        Ok(packs((self.open)()?.fill_buf()?))
    }
}

/// Whether a file with this start is compressed as a whole, by gzip or zstd.
pub(crate) fn packs(start: &[u8]) -> bool {
    start.starts_with(GZIP) || start.starts_with(ZSTD)
}

impl<'a> From<&'a [u8]> for LogBytes<'a> {
    fn from(bytes: &'a [u8]) -> Self {
        Self::new(move || Ok(Cursor::new(bytes)))
    }
}

impl From<Vec<u8>> for LogBytes<'_> {
    fn from(bytes: Vec<u8>) -> Self {
        let bytes: Rc<[u8]> = bytes.into();
        Self::new(move || Ok(Cursor::new(Rc::clone(&bytes))))
    }
}

/// Concatenated zstd frames: the decoder handles one frame at a time.
struct ZstdFrames<R: Read> {
    decoder: Option<StreamingDecoder<R, ruzstd::decoding::FrameDecoder>>,
    source: Option<R>,
}

impl<R: BufRead> ZstdFrames<R> {
    fn new(source: R) -> Self {
        Self {
            decoder: None,
            source: Some(source),
        }
    }
}

impl<R: BufRead> Read for ZstdFrames<R> {
    fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
        loop {
            if let Some(decoder) = &mut self.decoder {
                // A decoder error means damaged data, not a system fault.
                let damaged =
                    |problem: io::Error| io::Error::new(io::ErrorKind::InvalidData, problem);
                let count = decoder.read(into).map_err(damaged)?;
                if count > 0 || into.is_empty() {
                    return Ok(count);
                }
                self.source = self.decoder.take().map(StreamingDecoder::into_inner);
            }
            let Some(mut source) = self.source.take() else {
                return Ok(0);
            };
            if source.fill_buf()?.is_empty() {
                self.source = Some(source);
                return Ok(0);
            }
            let decoder = StreamingDecoder::new(source).map_err(io::Error::other)?;
            self.decoder = Some(decoder);
        }
    }
}

#[cfg(test)]
mod tests {
    use std::io::Write;

    use super::*;

    #[test]
    fn packed_bytes_come_out_as_they_went_in_and_again_each_time() {
        let mut gzip = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
        gzip.write_all(b"FLASER").unwrap();
        let gzip = gzip.finish().unwrap();
        let level = ruzstd::encoding::CompressionLevel::Fastest;
        let frame = |bytes: &[u8]| ruzstd::encoding::compress_to_vec(bytes, level);
        // Two frames, as parallel compressors write.
        let zstd = [frame(b"FLA"), frame(b"SER")].concat();
        for packed in [&b"FLASER"[..], &gzip, &zstd] {
            let bytes = LogBytes::from(packed);
            for _ in 0..2 {
                let mut text = String::new();
                bytes.stream().unwrap().read_to_string(&mut text).unwrap();
                assert_eq!(text, "FLASER");
                let mut again = String::new();
                bytes
                    .seekable()
                    .unwrap()
                    .read_to_string(&mut again)
                    .unwrap();
                assert_eq!(again, "FLASER");
            }
        }
    }
}
