//! The reader's input: files that belong together, and the options for them.

use std::io::Read as _;

use robot_io::laser_mount::LaserMount;
use robot_io::log::{LogOption, LogOptions};
use robot_io::log_bytes::LogBytes;
use robot_io::log_format::LogFormat;
use robot_io::motion::ComparedReader;
use robot_io::remark::NO_ODOMETRY;
use robot_io::rosbag2;
use robot_io::run::OdometryUse;

/// Largest size of a recording's description, bytes.
const MOST_METADATA: u64 = 1 << 20;

/// A file.
pub struct InputFile<'a> {
    /// Its name, without a folder.
    pub name: String,
    /// Its size.
    pub size_bytes: u64,
    /// Its bytes.
    pub bytes: LogBytes<'a>,
}

/// One log: a file, or the files of a recording in their order.
#[derive(Clone)]
pub struct LogInput<'a> {
    /// Its name.
    pub name: String,
    /// Total size of its files.
    pub size_bytes: u64,
    /// The bytes of each file.
    pub parts: Vec<LogBytes<'a>>,
}

impl<'a> LogInput<'a> {
    /// The log of a single file.
    pub fn one(name: &str, size_bytes: u64, bytes: impl Into<LogBytes<'a>>) -> Self {
        Self {
            name: name.to_owned(),
            size_bytes,
            parts: vec![bytes.into()],
        }
    }

    /// The log in files that were given together: from a rosbag2 folder the ones that its metadata lists,
    /// else all recordings by name.
    ///
    /// # Errors
    /// One sentence if a file is missing or cannot be read.
    pub fn new(files: Vec<InputFile<'a>>) -> Result<Self, String> {
        let names: Vec<String> = files.iter().map(|file| file.name.clone()).collect();
        let described = names.iter().position(|name| name == rosbag2::METADATA);
        let mut metadata = None;
        if let Some(at) = described.filter(|_| files.len() > 1) {
            let mut text = String::new();
            let source = files[at].bytes.stream();
            source
                .and_then(|source| source.take(MOST_METADATA).read_to_string(&mut text))
                .map_err(|problem| format!("{} cannot be read: {problem}", names[at]))?;
            metadata = Some(text);
        }
        let mut order = rosbag2::in_order(metadata.as_deref(), &names).map_err(|absent| {
            format!(
                "{} names {absent}, which did not come with it; give all files of the folder together",
                rosbag2::METADATA
            )
        })?;
        if order.is_empty() {
            // Not a ROS 2 recording; the log reader reports what it is.
            order = (0..files.len()).collect();
        }
        let first = order.first().map_or("", |&first| names[first].as_str());
        let name = match order.len() {
            0 | 1 => first.to_owned(),
            many => format!("{first} and {} more", many - 1),
        };
        let size_bytes = order.iter().map(|&k| files[k].size_bytes).sum();
        let parts = order.iter().map(|&k| files[k].bytes.clone()).collect();
        Ok(Self {
            name,
            size_bytes,
            parts,
        })
    }
}

/// The options for a log.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Choices {
    /// Topics, frames and the pose of the laser.
    pub log: LogOptions,
    /// Whether odometry is used.
    pub odometry: OdometryUse,
}

impl Choices {
    /// Parses options in the form of the command line, one per line and without the dashes: `scan-topic
    /// /front`.
    ///
    /// # Errors
    /// One sentence if a line is not an option or has an invalid value.
    pub fn read(lines: &str) -> Result<Self, String> {
        let mut choices = Self::default();
        for line in lines.lines() {
            let (name, value) = line.split_once(' ').unwrap_or((line, ""));
            let mut options = LogOption::ALL.into_iter();
            if let Some(option) = options.find(|option| option.name() == name) {
                choices.log = choices.log.with(option, value);
            } else if name == "laser" {
                choices.log.laser = Some(value.parse::<LaserMount>()?);
            } else if format!("--{name}") == NO_ODOMETRY {
                choices.odometry = OdometryUse::None;
            } else {
                return Err(format!("there is no option {name} for a log"));
            }
        }
        Ok(choices)
    }
}

/// A reader of the log whose first scans are compared with its odometry.
///
/// # Errors
/// One sentence if it is not a log.
pub fn compared<'a>(given: &LogInput<'a>, choices: &Choices) -> Result<ComparedReader<'a>, String> {
    let parts = given.parts.clone();
    let reader = LogFormat::open_parts(parts, &given.name, &choices.log);
    let reader = reader.map_err(|problem| problem.to_string())?;
    let is_alone = choices.odometry == OdometryUse::None;
    Ok(ComparedReader::new(reader, choices.log.laser.is_some()).for_scans_alone(is_alone))
}
