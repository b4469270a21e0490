//! ROS 2 recordings in SQLite: arbitrary bytes after a valid header.

use robot_io::log::LogOptions;

use crate::logs;

/// Bytes of the header, and of a page: the smallest of SQLite, which gives trees early.
const HEADER: usize = 100;
const PAGE: u16 = 512;

/// Reads without mapping, which the target `logs` does. The header is made valid, because no fuzzer would find it.
pub fn fuzz(bytes: &[u8]) {
    if bytes.len() < HEADER {
        return;
    }
    let mut file = bytes.to_vec();
    file[..16].copy_from_slice(b"SQLite format 3\0");
    file[16..18].copy_from_slice(&PAGE.to_be_bytes());
    file[20] = 0;
    file[56..60].copy_from_slice(&1_u32.to_be_bytes());
    logs::read(&file, &LogOptions::default());
}
