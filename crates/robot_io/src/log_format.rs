//! Which format a log has, and the reader that goes with it.

use std::io::BufRead;

use crate::carmen::CarmenReader;
use crate::json_log::JsonLogReader;
use crate::log::{LogError, LogOptions, LogReader, Place};
use crate::ros::RosReader;
use crate::session::Session;

/// The formats that are told apart by their first bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LogFormat {
    /// Lines of text, one message each.
    Carmen,
    /// A container of ROS 2 messages.
    Mcap,
    /// A recording of ROS 1.
    RosBag,
    /// A database of SQLite, the older container of ROS 2.
    Sqlite,
    /// Compressed by gzip.
    Gzip,
    /// A pose graph of g2o or TORO.
    Graph,
    /// Lines of JSON, one frame each.
    Json,
    /// A saved session.
    Session,
    /// Text whose characters have two bytes each.
    Utf16,
}

impl LogFormat {
    /// The format that a file's first bytes belong to; CARMEN's is what is nothing else.
    #[must_use]
    pub fn detect(start: &[u8]) -> Self {
        let starts = |magic: &[u8]| start.starts_with(magic);
        if starts(b"\x89MCAP0\r\n") {
            Self::Mcap
        } else if starts(b"#ROSBAG") {
            Self::RosBag
        } else if starts(b"SQLite format 3\0") {
            Self::Sqlite
        } else if starts(b"\x1f\x8b") {
            Self::Gzip
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

    /// Opens a log by its first bytes; `name` is what errors call it.
    ///
    /// # Errors
    /// Where the bytes cannot be had, there are none, or the format holds no log that is read here.
    pub fn open<'a>(
        mut bytes: impl BufRead + 'a,
        name: &str,
        options: &LogOptions,
    ) -> Result<Box<dyn LogReader + 'a>, LogError> {
        let start = bytes.fill_buf().map_err(|source| LogError::Io {
            name: name.to_owned(),
            place: Place::Byte(0),
            source,
        })?;
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
        match Self::detect(start) {
            Self::Carmen => Ok(Box::new(CarmenReader::new(bytes, name))),
            Self::Mcap => Ok(Box::new(RosReader::mcap(bytes, name, options))),
            Self::RosBag => Ok(Box::new(RosReader::bag(bytes, name, options))),
            Self::Json => Ok(Box::new(JsonLogReader::new(bytes, name))),
            Self::Gzip => Err(foreign(
                "compressed by gzip",
                "unpack it with gunzip and give the result",
            )),
            Self::Sqlite => Err(foreign(
                "a recording of ROS 2 in SQLite",
                "convert it to MCAP with ros2 bag convert",
            )),
            Self::Utf16 => Err(foreign(
                "text in UTF-16",
                "save it as UTF-8 and give the result",
            )),
            Self::Session => Err(foreign(
                "a saved session, not a log of scans",
                "give a log; slam2d run LOG --continue takes a session to go on from",
            )),
            Self::Graph => Err(foreign(
                "a pose graph, not a log of scans",
                "optimize it with slam2d optimize",
            )),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn empty_and_foreign_files_are_refused_in_one_sentence() {
        for (bytes, said) in [
            (&b""[..], "x.log is empty; give a recorded log"),
            (
                b"\x1f\x8b\x08",
                "x.log is compressed by gzip; unpack it with gunzip and give the result",
            ),
            (
                b"\xff\xfeF\0L\0",
                "x.log is text in UTF-16; save it as UTF-8 and give the result",
            ),
            (
                b"SQLite format 3\0",
                "x.log is a recording of ROS 2 in SQLite; convert it to MCAP with ros2 bag convert",
            ),
            (
                b"SLAM2D\r\n",
                "x.log is a saved session, not a log of scans; give a log; slam2d run LOG --continue takes a session to go on from",
            ),
            (
                b"VERTEX_SE2 0 0 0 0\n",
                "x.log is a pose graph, not a log of scans; optimize it with slam2d optimize",
            ),
        ] {
            let opened = LogFormat::open(bytes, "x.log", &LogOptions::default());
            assert_eq!(opened.err().unwrap().to_string(), said);
        }
    }
}
