//! Opens the reader of a log by its format.

use std::io::{self, BufRead};

use crate::carmen::CarmenReader;
use crate::course_log::CourseReader;
use crate::json_log::JsonLogReader;
use crate::log::{LogError, LogOption, LogOptions, LogReader};
use crate::log_bytes::LogBytes;
use crate::log_format::LogFormat;
use crate::mounted_reader::MountedReader;
use crate::near_readings::without_near_readings;
use crate::odometry_file::BesideOdometry;
use crate::restamped::restamped;
use crate::ros::{LiveReader, RosReader};
use crate::table_layout::{ColumnMeaning, TableLayout};
use crate::table_log::{TableReader, TableRows};

/// The parts without those whose bytes are the same as of one before.
fn without_copies(parts: Vec<LogBytes<'_>>) -> Vec<LogBytes<'_>> {
    let mut kept: Vec<LogBytes<'_>> = Vec::new();
    for part in parts {
        // What cannot be read is no copy, and is named when its turn comes.
        let is_copy = |other: &LogBytes<'_>| are_equal(other, &part).unwrap_or(false);
        if !kept.iter().any(is_copy) {
            kept.push(part);
        }
    }
    kept
}

fn are_equal(one: &LogBytes<'_>, other: &LogBytes<'_>) -> io::Result<bool> {
    let (mut one, mut other) = (one.stream()?, other.stream()?);
    loop {
        let (first, second) = (one.fill_buf()?, other.fill_buf()?);
        let count = first.len().min(second.len());
        if count == 0 {
            return Ok(first.len() == second.len());
        }
        if first[..count] != second[..count] {
            return Ok(false);
        }
        one.consume(count);
        other.consume(count);
    }
}

impl LogFormat {
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

    /// Opens a recording while it is made: `stream` is MCAP, and its reads wait for what comes next, or fail with
    /// [`WouldBlock`](std::io::ErrorKind::WouldBlock) between two records: then there is no frame yet, and
    /// [`LogError::Waiting`].
    #[must_use]
    pub fn open_live<'a>(
        stream: impl BufRead + 'a,
        name: &str,
        options: &LogOptions,
    ) -> Box<dyn LogReader + 'a> {
        let reader = Box::new(LiveReader::new(stream, name, options));
        without_near_readings(reader, options.min_range_m, options.footprint)
    }

    /// Opens a log of several files: a recording of ROS may be split, and beside any other log there may be a file of
    /// odometry, which is the last one if an option names it.
    ///
    /// # Errors
    /// Those of [`open`](Self::open), and if several files are neither.
    pub fn open_parts<'a>(
        mut parts: Vec<LogBytes<'a>>,
        name: &str,
        options: &LogOptions,
    ) -> Result<Box<dyn LogReader + 'a>, LogError> {
        let io = |source| LogError::at_start(name, source);
        let named = options.odometry_file.as_ref();
        let beside = match named {
            Some(file) if parts.len() < 2 => {
                return Err(LogError::Odometry {
                    name: file.path.clone(),
                    problem: "open the file of odometry together with the log, without the option"
                        .to_owned(),
                });
            }
            Some(_) => parts.pop(),
            None if parts.len() == 2 => {
                let begins = |part: &LogBytes<'_>| {
                    let start = part.stream();
                    start.is_ok_and(|mut bytes| bytes.fill_buf().is_ok_and(BesideOdometry::begins))
                };
                let at = parts.iter().rposition(begins);
                at.map(|at| parts.remove(at))
            }
            None => None,
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
        let found = match (Self::detect(start), &options.columns) {
            // Columns say how to read any text.
            (found, Some(_)) if !found.is_ros() && found != Self::Json => Self::Table,
            (found, _) => found,
        };
        if let Self::Foreign(kind) = found {
            return Err(foreign(kind.found, kind.advice));
        }
        if parts.len() > 1 && !found.is_ros() {
            return Err(foreign(
                "neither a recording of ROS nor scans with their odometry",
                "give one log at a time, with a file of odometry beside it or none; its header may be time,x,y,heading",
            ));
        }
        parts = without_copies(parts);
        let beside = match beside {
            Some(_) if found.is_ros() => {
                return Err(foreign(
                    "a recording of ROS, which has its odometry in itself",
                    "leave the file of odometry out; --odom-topic chooses a topic",
                ));
            }
            Some(bytes) => Some(BesideOdometry::read(&bytes, named)?),
            None => None,
        };
        let beside = beside.as_ref();
        let columns = options.columns.clone();
        let layout = columns
            .or_else(|| TableLayout::of(start))
            .unwrap_or_default();
        let has_lasers = found == Self::Table && layout.has(ColumnMeaning::Sensor);
        let asked = options.first_asked();
        if !found.is_ros()
            && let Some((option, wanted)) =
                asked.filter(|(option, _)| !(has_lasers && *option == LogOption::ScanTopic))
        {
            return Err(LogError::Missing {
                name: name.to_owned(),
                option: option.name(),
                wanted: wanted.to_owned(),
                advice: "only a recording of ROS has topics and frames; leave the option out"
                    .to_owned(),
            });
        }
        let mounted = |reader: Result<Box<dyn LogReader + 'a>, LogError>| {
            let reader = reader?;
            Ok(match options.laser {
                Some(mount) => Box::new(MountedReader::new(reader, mount)),
                None => reader,
            })
        };
        let reader = match found {
            Self::Json => mounted(restamped(&first, name, beside, |source| {
                JsonLogReader::new(source, name)
            })),
            Self::Course => mounted(restamped(&first, name, beside, |source| {
                CourseReader::new(source, name)
            })),
            Self::Table => {
                let rows = || TableRows::new(layout.clone()).of_sensor(options.scan_topic.clone());
                mounted(restamped(&first, name, beside, |source| {
                    TableReader::with_format(source, name, rows())
                }))
            }
            Self::Mcap | Self::RosBag | Self::Sqlite => {
                let reader: Box<dyn LogReader> = Box::new(RosReader::new(parts, name, options));
                Ok(reader)
            }
            Self::Carmen | Self::Foreign(_) => mounted(restamped(&first, name, beside, |source| {
                CarmenReader::new(source, name)
            })),
        };
        Ok(without_near_readings(
            reader?,
            options.min_range_m,
            options.footprint,
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_topic_is_rejected_where_there_are_none() {
        let options = LogOptions::default()
            .with(LogOption::OdometryTopic, "/wheels")
            .unwrap();
        for bytes in [
            &b"FLASER 1 2 0 0 0 0 0 0 0 host 0\n"[..],
            b"{\"stamp\": 1}\n",
            b"O 100 200 1.5 0.01\n",
            b"angle,range\n0,1\n",
        ] {
            let rejected = LogFormat::open(bytes, "x.log", &options).err();
            assert_eq!(
                rejected.map(|error| error.to_string()).as_deref(),
                Some(
                    "x.log has no odom-topic /wheels; only a recording of ROS has topics and frames; leave the option out"
                )
            );
            assert!(LogFormat::open(bytes, "x.log", &LogOptions::default()).is_ok());
        }
    }

    #[test]
    fn empty_and_foreign_files_are_rejected_in_one_sentence() {
        for (bytes, expected) in [
            (&b""[..], "x.log is empty; use a recorded log"),
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
                b"#ROSBAG V1.2\n",
                "x.log is a ROS 1 recording older than version 2.0; convert it with rosbag fix first",
            ),
            (
                b"version https://git-lfs.github.com/spec/v1\n",
                "x.log is a Git LFS pointer, not the file itself; fetch the file with git lfs pull",
            ),
            (
                b"# stamp\n1,0,0,0,0,0,0,1\n",
                "x.log is a trajectory, not a log of scans; pass a log; slam2d evaluate evaluates a trajectory",
            ),
            (
                b"10.5 16777343 6665 position2d 00 001 001 0.1 0 0 0 0 0 0\n",
                "x.log is a log of Player; write its laser lines as CSV with a header such as time,x,y,heading,angle_min,angle_increment,ranges",
            ),
            (
                &b"\x3e\x81\0\x40\x1f".repeat(40),
                "x.log is what an RPLidar sends on its serial port; record the topic of its driver, or save the output of the SDK's ultra_simple, lines of theta: … Dist: … Q: …",
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
                b"time,x,y,theta\n0,0,0,0\n",
                "x.log is odometry without scans; pass the log of the scans with it: slam2d run SCANS ODOMETRY",
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

    #[test]
    fn only_parts_of_the_same_bytes_are_copies() {
        let long = vec![7; 200_000];
        let (mut other, mut longer) = (long.clone(), long.clone());
        other[150_000] = 8;
        longer.push(7);
        let counted = |parts: [&[u8]; 4]| without_copies(parts.map(LogBytes::from).to_vec()).len();
        assert_eq!(counted([&long, &other, &longer, b"b"]), 4);
        assert_eq!(counted([&long, b"", &long, b""]), 2);
    }
}
