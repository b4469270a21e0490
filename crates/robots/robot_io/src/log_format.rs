//! Detects the format of a log.

use crate::course_log::CourseLines;
use crate::foreign::Foreign;
use crate::table_layout::TableLayout;

/// Formats, distinguished by their first bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LogFormat {
    /// Lines of text, one message each.
    Carmen,
    /// Lines of text of Carnegie Mellon's course on probabilistic robotics.
    Course,
    /// Rows of a table, of scans or of beams.
    Table,
    /// Container of ROS 2 messages.
    Mcap,
    /// Recording of ROS 1.
    RosBag,
    /// SQLite database, the older container of ROS 2.
    Sqlite,
    /// Lines of JSON, one frame each.
    Json,
    /// No log.
    Foreign(&'static Foreign),
}

impl LogFormat {
    /// Detects the format by a file's first bytes; CARMEN if nothing else matches.
    #[must_use]
    pub fn detect(start: &[u8]) -> Self {
        let starts = |magic: &[u8]| start.starts_with(magic);
        if starts(b"\x89MCAP0\r\n") {
            Self::Mcap
        } else if starts(b"SQLite format 3\0") {
            Self::Sqlite
        } else if CourseLines::begins(start) {
            Self::Course
        } else if TableLayout::of(start).is_some() {
            Self::Table
        } else if let Some(kind) = Foreign::of(start) {
            Self::Foreign(kind)
        } else if starts(b"#ROSBAG") {
            Self::RosBag
        } else if starts(b"{") || starts(b"\xef\xbb\xbf{") {
            Self::Json
        } else {
            Self::Carmen
        }
    }

    /// Whether it is a recording of ROS, which may be split into several files.
    #[must_use]
    pub fn is_ros(self) -> bool {
        matches!(self, Self::Mcap | Self::RosBag | Self::Sqlite)
    }
}
