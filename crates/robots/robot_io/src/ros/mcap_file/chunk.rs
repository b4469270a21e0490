//! Decompressed records of a chunk.

use super::records::{HEAD_BYTES, broken, fields, head as record_head, op};
use crate::ros::container::{ContainerError, MAX_BYTES};
use crate::ros::decompress::Packing;
use crate::ros::wire::{WireError, WireReader};

/// Header of a chunk.
struct Head {
    /// Bytes of the records.
    size: u64,
    /// Checksum; 0 if there is none.
    sum: u32,
    packing: String,
    /// Bytes of the compressed records.
    packed: u64,
}

/// Returns the records of a chunk; if it is truncated and not compressed, those that are complete.
pub fn records(chunk: &[u8], is_cut_off: bool) -> Result<Vec<u8>, ContainerError> {
    let cut_off = || ContainerError::CutOff("expected the end of a chunk".to_owned());
    let mut fields = fields(chunk)?;
    let head = head(&mut fields).map_err(|problem| match is_cut_off {
        true => cut_off(),
        false => broken(problem),
    })?;
    let there = fields.rest();
    let packed = usize::try_from(head.packed).ok();
    let Some(packed) = packed.and_then(|packed| there.get(..packed)) else {
        return match (is_cut_off, head.packing.as_str()) {
            (true, "") => Ok(there.to_vec()),
            (true, _) => Err(cut_off()),
            (false, _) => Err(ContainerError::Broken(format!(
                "expected a chunk of {} bytes, found {}",
                head.packed,
                there.len()
            ))),
        };
    };
    let size = head.size.min(MAX_BYTES as u64) as usize;
    let records = match head.packing.as_str() {
        "" => Ok(packed.to_vec()),
        "lz4" => Packing::Lz4.unpack(packed, size),
        "zstd" => Packing::Zstd.unpack(packed, size),
        other => Err(format!(
            "expected a chunk compressed by lz4, zstd or none, found ‘{}’; convert it with mcap compress",
            crate::lines::printable(other)
        )),
    };
    let records = records.map_err(ContainerError::Broken)?;
    if records.len() as u64 != head.size {
        return Err(ContainerError::Broken(format!(
            "expected a chunk of {} bytes, but it decompresses to {}",
            head.size,
            records.len()
        )));
    }
    if head.sum != 0 && head.sum != crc32fast::hash(&records) {
        return Err(ContainerError::Broken(
            "a chunk is damaged: its checksum does not match".to_owned(),
        ));
    }
    Ok(records)
}

/// Bytes that suffice to recognize a chunk: record head, times, sizes, and the name of the compression.
pub const LONGEST_START: usize = HEAD_BYTES + 8 + 8 + 8 + 4 + 4 + 4 + 8;

/// Whether a valid chunk starts here.
pub fn begins(bytes: &[u8]) -> bool {
    let Some((op::CHUNK, length)) = record_head(bytes) else {
        return false;
    };
    let Ok(mut fields) = fields(&bytes[HEAD_BYTES..]) else {
        return false;
    };
    let before = fields.rest().len();
    let Ok(head) = head(&mut fields) else {
        return false;
    };
    let in_front = (before - fields.rest().len()) as u64;
    let is_known = matches!(head.packing.as_str(), "" | "lz4" | "zstd");
    is_known && head.packed.checked_add(in_front) == Some(length) && head.size <= MAX_BYTES as u64
}

fn head(fields: &mut WireReader<'_>) -> Result<Head, WireError> {
    fields.u64("a chunk's first time")?;
    fields.u64("a chunk's last time")?;
    Ok(Head {
        size: fields.u64("a chunk's size")?,
        sum: fields.u32("a chunk's checksum")?,
        packing: fields.name("a chunk's compression")?,
        packed: fields.u64("a chunk's compressed size")?,
    })
}
