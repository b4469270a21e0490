//! Recordings of ROS 2 in SQLite: any bytes after a valid header.

use robot_io::log::LogOptions;

use crate::logs;

/// Bytes of the header, and of a page: the smallest size of SQLite, so that small inputs contain trees.
const HEADER: usize = 100;
const PAGE: u16 = 512;

/// Reads without mapping, which the target `logs` covers. The header is made valid, because a fuzzer would
/// not find one.
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
