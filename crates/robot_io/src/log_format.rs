//! Detects the format of a log and opens its reader.

use crate::carmen::CarmenReader;
use crate::json_log::JsonLogReader;
use crate::laser_mount::MountedReader;
use crate::log::{FilePosition, LogError, LogOptions, LogReader};
use crate::log_bytes::{LogBytes, packs};
use crate::restamped::restamped;
use crate::ros::RosReader;
use crate::session::Session;
use std::io::{self, BufRead};

/// Formats, distinguished by their first bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LogFormat {
    /// Lines of text, one message each.
    Carmen,
    /// Container of ROS 2 messages.
    Mcap,
    /// Recording of ROS 1.
    RosBag,
    /// SQLite database, the older container of ROS 2.
    Sqlite,
    /// Compressed as a whole, by gzip or zstd.
    Packed,
    /// Recording of ROS 1 older than version 2.0.
    OldRosBag,
    /// metadata.yaml of rosbag2.
    Metadata,
    /// Output of GMapping: particles and their scans.
    Gfs,
    /// A log of the canonical scan matcher, in JSON.
    Csm,
    /// Stamped poses: TUM or EuRoC.
    Trajectory,
    /// A zip or tar archive.
    Archive,
    /// A pose graph of g2o or TORO.
    Graph,
    /// Lines of JSON, one frame each.
    Json,
    /// A saved session.
    Session,
    /// Text in UTF-16.
    Utf16,
}

impl LogFormat {
    /// Detects the format by a file's first bytes; CARMEN if nothing else matches.
    #[must_use]
    pub fn detect(start: &[u8]) -> Self {
        let starts = |magic: &[u8]| start.starts_with(magic);
        if starts(b"\x89MCAP0\r\n") {
            Self::Mcap
        } else if starts(b"#ROSBAG") {
            Self::RosBag
        } else if starts(b"SQLite format 3\0") {
            Self::Sqlite
        } else if starts(b"#ROSRECORD") || starts(b"#ROSBAG V1") {
            Self::OldRosBag
        } else if starts(b"rosbag2_bagfile_information") {
            Self::Metadata
        } else if starts(b"PK\x03\x04") || start.get(257..262) == Some(b"ustar") {
            Self::Archive
        } else if is_trajectory(start) {
            Self::Trajectory
        } else if is_gfs(start) {
            Self::Gfs
        } else if starts(b"{")
            && [&b"\"nrays\""[..], b"\"readings\""]
                .iter()
                .all(|key| contains(start, key))
        {
            Self::Csm
        } else if packs(start) {
            Self::Packed
        } else if starts(b"VERTEX") || starts(b"EDGE") {
            Self::Graph
        } else if starts(b"{") || starts(b"\xef\xbb\xbf{") {
            Self::Json
        } else if Session::begins(start) {
            Self::Session
        } else if starts(b"\xff\xfe") || starts(b"\xfe\xff") {
            Self::Utf16
        } else {
            Self::Carmen
        }
    }

    /// Opens a log by its first bytes; errors contain `name`.
    ///
    /// # Errors
    /// If the bytes cannot be read, are empty, or have a format that is not supported.
    pub fn open<'a>(
        bytes: impl Into<LogBytes<'a>>,
        name: &str,
        options: &LogOptions,
    ) -> Result<Box<dyn LogReader + 'a>, LogError> {
        Self::open_parts(vec![bytes.into()], name, options)
    }

    /// Opens a log of several files in order: a recording of ROS 2 may be split.
    ///
    /// # Errors
    /// Those of [`open`](Self::open), and if several files are not a recording of ROS.
    pub fn open_parts<'a>(
        parts: Vec<LogBytes<'a>>,
        name: &str,
        options: &LogOptions,
    ) -> Result<Box<dyn LogReader + 'a>, LogError> {
        let io = |source| LogError::Io {
            name: name.to_owned(),
            position: FilePosition::Byte(0),
            source,
        };
        let Some(first) = parts.first().cloned() else {
            return Err(LogError::Empty {
                name: name.to_owned(),
            });
        };
        let packed = |problem: io::Error| match first.is_packed() {
            Ok(true) => LogError::NoScans {
                name: name.to_owned(),
                detail: format!(
                    "it is compressed by gzip or zstd and cannot be decompressed: {problem}; copy it again from its source"
                ),
            },
            _ => io(problem),
        };
        let mut bytes = first.stream().map_err(packed)?;
        let start = bytes.fill_buf().map_err(packed)?;
        if start.is_empty() {
            return Err(LogError::Empty {
                name: name.to_owned(),
            });
        }
        let foreign = |found, advice| LogError::Foreign {
            name: name.to_owned(),
            found,
            advice,
        };
        let found = Self::detect(start);
        if parts.len() > 1 && !matches!(found, Self::Mcap | Self::RosBag | Self::Sqlite) {
            return Err(foreign(
                "several files, the first of which is not a ROS recording",
                "give one log at a time",
            ));
        }
        let mounted = |reader: io::Result<Box<dyn LogReader + 'a>>| {
            let reader = reader.map_err(io)?;
            Ok(match options.laser {
                Some(mount) => Box::new(MountedReader::new(reader, mount)),
                None => reader,
            })
        };
        match found {
            Self::Carmen => mounted(restamped(&first, |source| CarmenReader::new(source, name))),
            Self::Json => mounted(restamped(&first, |source| JsonLogReader::new(source, name))),
            Self::Mcap | Self::RosBag | Self::Sqlite => {
                Ok(Box::new(RosReader::new(parts, name, options)))
            }
            Self::Packed => Err(foreign(
                "compressed more than twice",
                "decompress it with zstd -d or gunzip first",
            )),
            Self::OldRosBag => Err(foreign(
                "a ROS 1 recording older than version 2.0",
                "convert it with rosbag fix first",
            )),
            Self::Metadata => Err(foreign(
                "the description of a ROS 2 recording, not the recording itself",
                "pass its folder, or the files that it lists",
            )),
            Self::Gfs => Err(foreign(
                "the output of GMapping, not a log of scans",
                "pass the log that GMapping was run on",
            )),
            Self::Csm => Err(foreign(
                "a log of CSM, the canonical scan matcher",
                "convert it to CARMEN with CSM's json2carmen first",
            )),
            Self::Trajectory => Err(foreign(
                "a trajectory, not a log of scans",
                "pass a log; slam2d evaluate evaluates a trajectory",
            )),
            Self::Archive => Err(foreign(
                "an archive",
                "extract it and pass the recording in it",
            )),
            Self::Utf16 => Err(foreign("text in UTF-16", "save it as UTF-8 first")),
            Self::Session => Err(foreign(
                "a saved session, not a log of scans",
                "pass a log; slam2d run LOG --continue continues a session",
            )),
            Self::Graph => Err(foreign(
                "a pose graph, not a log of scans",
                "optimize it with slam2d optimize",
            )),
        }
    }
}

/// Whether the bytes contain `key`.
fn contains(bytes: &[u8], key: &[u8]) -> bool {
    bytes.windows(key.len()).any(|window| window == key)
}

/// Whether the first line that is not a comment has the eight numbers of a stamped pose, or more.
fn is_trajectory(start: &[u8]) -> bool {
    let mut lines = start.split(|&byte| byte == b'\n');
    let line = lines.find(|line| !line.trim_ascii().is_empty() && !line.starts_with(b"#"));
    let Some(Ok(line)) = line.map(std::str::from_utf8) else {
        return false;
    };
    let separates = |c: char| c.is_ascii_whitespace() || c == ',';
    let words: Vec<&str> = line
        .split(separates)
        .filter(|word| !word.is_empty())
        .collect();
    words.len() >= 8 && words.iter().all(|word| word.parse::<f64>().is_ok())
}

/// Whether a line starts with a keyword of GMapping.
fn is_gfs(start: &[u8]) -> bool {
    let words: [&[u8]; 5] = [
        b"LASER_READING ",
        b"ODO_UPDATE ",
        b"SM_UPDATE ",
        b"GFS ",
        b"NEFF ",
    ];
    let mut lines = start.split(|&byte| byte == b'\n').take(20);
    lines.any(|line| words.iter().any(|word| line.starts_with(word)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn empty_and_foreign_files_are_refused_in_one_sentence() {
        for (bytes, expected) in [
            (&b""[..], "x.log is empty; give a recorded log"),
            (
                b"\x1f\x8b\x08",
                "x.log has no usable scan: it is compressed by gzip or zstd and cannot be decompressed: unexpected end of file; copy it again from its source",
            ),
            (
                b"\xff\xfeF\0L\0",
                "x.log is text in UTF-16; save it as UTF-8 first",
            ),
            (
                b"#ROSRECORD V1.1\n",
                "x.log is a ROS 1 recording older than version 2.0; convert it with rosbag fix first",
            ),
            (
                b"# stamp\n1,0,0,0,0,0,0,1\n",
                "x.log is a trajectory, not a log of scans; pass a log; slam2d evaluate evaluates a trajectory",
            ),
            (
                b"LASER_READING 361 1.2\n",
                "x.log is the output of GMapping, not a log of scans; pass the log that GMapping was run on",
            ),
            (
                b"{\"nrays\":3,\"min_theta\":0,\"readings\":[1,2,3]}\n",
                "x.log is a log of CSM, the canonical scan matcher; convert it to CARMEN with CSM's json2carmen first",
            ),
            (
                b"rosbag2_bagfile_information:\n",
                "x.log is the description of a ROS 2 recording, not the recording itself; pass its folder, or the files that it lists",
            ),
            (
                b"SLAM2D\r\n",
                "x.log is a saved session, not a log of scans; pass a log; slam2d run LOG --continue continues a session",
            ),
            (
                b"VERTEX_SE2 0 0 0 0\n",
                "x.log is a pose graph, not a log of scans; optimize it with slam2d optimize",
            ),
        ] {
            let opened = LogFormat::open(bytes, "x.log", &LogOptions::default());
            assert_eq!(opened.err().unwrap().to_string(), expected);
        }
    }
}
