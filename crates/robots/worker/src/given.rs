//! The user's input: files that were given together, and the options for them.

use std::io::Read as _;

use robot_io::log::{LogError, LogOptions, with_remarks};
use robot_io::log_bytes::{LogBytes, WRITE_AHEAD};
use robot_io::log_format::LogFormat;
use robot_io::motion::ComparedReader;
use robot_io::remark::Remark;
use robot_io::rosbag2;

/// Largest metadata file, bytes.
const MAX_METADATA: u64 = 1 << 20;

/// A given file.
pub struct GivenFile<'a> {
    /// Name without a folder.
    pub name: String,
    /// Size, bytes.
    pub size_bytes: u64,
    /// Content.
    pub bytes: LogBytes<'a>,
}

/// One log: a file, or the files of a recording in order.
#[derive(Clone)]
pub struct Given<'a> {
    /// Display name.
    pub name: String,
    /// Total size of all files.
    pub size_bytes: u64,
    /// Content of each file.
    pub parts: Vec<LogBytes<'a>>,
    /// What differs from the description of the recording.
    pub remarks: Vec<Remark>,
}

impl<'a> Given<'a> {
    /// A log of a single file.
    pub fn one(name: &str, size_bytes: u64, bytes: impl Into<LogBytes<'a>>) -> Self {
        Self {
            name: name.to_owned(),
            size_bytes,
            parts: vec![bytes.into()],
            remarks: Vec::new(),
        }
    }

    /// Makes a log of files that were given together: those that the metadata of a rosbag2 folder lists, else
    /// all recordings by name.
    ///
    /// # Errors
    /// If a file is missing or cannot be read; the message is one sentence.
    pub fn new(files: Vec<GivenFile<'a>>) -> Result<Self, String> {
        let names: Vec<String> = files.iter().map(|file| file.name.clone()).collect();
        let described = names.iter().position(|name| name == rosbag2::METADATA);
        let mut metadata = None;
        if let Some(at) = described.filter(|_| files.len() > 1) {
            let mut text = String::new();
            let source = files[at].bytes.stream();
            source
                .and_then(|source| source.take(MAX_METADATA).read_to_string(&mut text))
                .map_err(|problem| format!("{} cannot be read: {problem}", names[at]))?;
            metadata = Some(text);
        }
        let order = rosbag2::in_order(metadata.as_deref(), &names).map_err(|absent| {
            format!(
                "{} lists {absent}, which is missing; open all files of the folder together",
                rosbag2::METADATA
            )
        })?;
        let (mut order, remarks) = (order.files, order.remarks);
        if order.is_empty() {
            // Not a ROS 2 recording: the log reader decides what it is.
            order = (0..files.len()).collect();
        }
        let first = order.first().map_or("", |&first| names[first].as_str());
        let name = match order.len() {
            0 | 1 => first.to_owned(),
            many => format!("{first} and {} more", many - 1),
        };
        let size_bytes = order.iter().map(|&k| files[k].size_bytes).sum();
        let part = |&k: &usize| {
            let (file, bytes) = (&files[k], files[k].bytes.clone());
            let beside = format!("{}{WRITE_AHEAD}", file.name);
            match files.iter().find(|file| file.name == beside) {
                Some(log) => bytes.with_write_ahead(log.bytes.clone()),
                None => bytes,
            }
        };
        let parts = order.iter().map(part).collect();
        Ok(Self {
            name,
            size_bytes,
            parts,
            remarks,
        })
    }
}

/// Parses options of the command, one per line and without the dashes: `scan-topic /front`.
///
/// # Errors
/// If a line is not an option or has an invalid value; the message is one sentence.
pub fn options(lines: &str) -> Result<LogOptions, String> {
    LogOptions::read(
        lines
            .lines()
            .map(|line| line.split_once(' ').unwrap_or((line, ""))),
    )
}

/// Opens the log, and compares its first scans with its odometry.
///
/// # Errors
/// If it is not a log.
pub fn compared<'a>(
    given: &Given<'a>,
    options: &LogOptions,
) -> Result<ComparedReader<'a>, LogError> {
    let reader = LogFormat::open_parts(given.parts.clone(), &given.name, options)?;
    let reader = with_remarks(reader, given.remarks.clone());
    Ok(ComparedReader::chosen(reader, options))
}
