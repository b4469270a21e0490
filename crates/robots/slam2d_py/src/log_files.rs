//! The files of a log, read with a count of how far.

use std::fs::{self, File};
use std::io::{self, BufReader, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use pyo3::prelude::*;
use robot_io::log::LogOptions;
use robot_io::log_bytes::{LogBytes, WRITE_AHEAD};
use robot_io::remark::Remark;
use robot_io::rosbag2;

use crate::errors::{LogError, os_error};

/// Where in the log the last read ended, and the size of the log, bytes. Some formats are read twice, for their contents and
/// for their scans.
pub struct ReadTo {
    end: Arc<AtomicU64>,
    size: u64,
}

impl ReadTo {
    /// The share of the log that was read.
    pub fn share(&self) -> f64 {
        (self.end.load(Ordering::Relaxed) as f64 / self.size.max(1) as f64).min(1.0)
    }
}

/// The files of a log, then that of its odometry.
pub fn parts(
    path: &Path,
    options: &LogOptions,
) -> PyResult<(Vec<LogBytes<'static>>, Vec<Remark>, ReadTo)> {
    let unreadable = |path: &Path| {
        let path = path.to_owned();
        move |error: io::Error| os_error(&path, &error)
    };
    let mut files = vec![path.to_owned()];
    let mut remarks = Vec::new();
    if path.is_dir() {
        let metadata = path.join(rosbag2::METADATA);
        let listed = fs::read_to_string(&metadata).ok();
        let entries = fs::read_dir(path).map_err(unreadable(path))?;
        let names: Vec<String> = entries
            .flatten()
            .map(|entry| entry.file_name().to_string_lossy().into_owned())
            .collect();
        let order = rosbag2::in_order(listed.as_deref(), &names).map_err(|absent| {
            LogError::new_err(format!(
                "{}: {absent} is listed but missing",
                path.display()
            ))
        })?;
        files = order
            .files
            .iter()
            .map(|at| path.join(&names[*at]))
            .collect();
        remarks = order.remarks;
        if files.is_empty() {
            return Err(LogError::new_err(format!(
                "{} is a folder without a recording of ROS; give a log, or a folder with files that end in .mcap, .db3 or .bag",
                path.display()
            )));
        }
    }
    let odometry = options.odometry_file.as_ref();
    files.extend(odometry.map(|file| PathBuf::from(&file.path)));
    let end = Arc::new(AtomicU64::new(0));
    let mut parts = Vec::new();
    let mut size = 0;
    for file in files {
        let opened = File::open(&file).map_err(unreadable(&file))?;
        let (before, bytes_of_file) = (size, opened.metadata().map_err(unreadable(&file))?.len());
        size += bytes_of_file;
        // Small pieces, so that the share grows with the scans of a short log, too.
        let piece = (bytes_of_file / 256).clamp(1 << 9, 1 << 16) as usize;
        let mut beside = file.clone().into_os_string();
        beside.push(WRITE_AHEAD);
        let bytes = |file: PathBuf| {
            let end = Arc::clone(&end);
            LogBytes::new(move || {
                let source = Followed {
                    file: File::open(&file)?,
                    at: before,
                    before,
                    end: Arc::clone(&end),
                };
                Ok(BufReader::with_capacity(piece, source))
            })
        };
        let part = bytes(file);
        let beside = PathBuf::from(beside);
        parts.push(if beside.is_file() {
            part.with_write_ahead(bytes(beside))
        } else {
            part
        });
    }
    Ok((parts, remarks, ReadTo { end, size }))
}

/// A file that notes where the last read ended.
struct Followed {
    file: File,
    /// Its position in the log, and that of its start.
    at: u64,
    before: u64,
    end: Arc<AtomicU64>,
}

impl Read for Followed {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let count = self.file.read(buffer)?;
        self.at += count as u64;
        self.end.store(self.at, Ordering::Relaxed);
        Ok(count)
    }
}

impl Seek for Followed {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        let found = self.file.seek(to)?;
        self.at = self.before + found;
        Ok(found)
    }
}
