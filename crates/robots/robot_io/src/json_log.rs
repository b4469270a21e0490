//! Logs as lines of JSON, one frame each: for scripts and for conversion between formats.
//!
//! ```text
//! {"stamp_s": 1.0, "odometry": [x, y, theta], "first_angle_rad": -3.14, "angle_step_rad": 0.05,
//!  "range_min_m": 0, "range_max_m": 6, "beam_interval_s": 0, "body_from_sensor": [x, y, theta],
//!  "ranges_m": [1.2, null]}
//! ```
//!
//! A range that is not a number, and an unlimited longest range, are `null`. `odometry` is optional. `truth`, the true
//! pose of a simulated robot, and `pose`, an estimated one, are optional and ignored when a log is read.

use std::io::{self, Write};

use ch16_slam2d::scan::LaserScan;
use pr_geom::SE2;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use crate::line_log::{LineFormat, LineReader};
use crate::lines::{json_words, listed, printable};
use crate::log::{LogFrame, LogNotes};
use crate::plausible::{plausible_pose, plausible_stamp_s};
use crate::table_layout::{ColumnMeaning, column};
use crate::table_log::TableRows;

/// One line: a frame.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FrameLine {
    /// Stamp of the scan, s.
    pub stamp_s: f64,
    /// Pose of the body in the odometry's frame: m, m, rad.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub odometry: Option<[f64; 3]>,
    /// Estimated pose of the body, `world_from_body`: m, m, rad.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pose: Option<[f64; 3]>,
    /// True pose of the body, if known: m, m, rad.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub truth: Option<[f64; 3]>,
    /// Bearing of the first beam in the sensor's frame, rad.
    pub first_angle_rad: f64,
    /// Angle from one beam to the next, rad.
    pub angle_step_rad: f64,
    /// Shorter ranges are no returns, m.
    #[serde(default)]
    pub range_min_m: f64,
    /// Ranges at or beyond this are no returns, m; `None` if there is no limit.
    #[serde(default)]
    pub range_max_m: Option<f64>,
    /// Time from one beam to the next, s.
    #[serde(default)]
    pub beam_interval_s: f64,
    /// Mounting of the sensor on the body: m, m, rad.
    #[serde(default)]
    pub body_from_sensor: [f64; 3],
    /// One range per beam, m; `None` if it is not a number.
    pub ranges_m: Vec<Option<f64>>,
}

impl From<&LogFrame> for FrameLine {
    fn from(frame: &LogFrame) -> Self {
        let scan = &frame.scan;
        let finite = |value: f64| value.is_finite().then_some(value);
        Self {
            stamp_s: frame.stamp_s,
            odometry: frame.odometry.map(|pose| pose.to_array()),
            pose: None,
            truth: None,
            first_angle_rad: scan.first_angle_rad,
            angle_step_rad: scan.angle_step_rad,
            range_min_m: scan.range_min_m,
            range_max_m: finite(scan.range_max_m),
            beam_interval_s: scan.beam_interval_s,
            body_from_sensor: scan.body_from_sensor.to_array(),
            ranges_m: scan
                .ranges_m
                .iter()
                .map(|&range_m| finite(range_m))
                .collect(),
        }
    }
}

impl From<FrameLine> for LogFrame {
    fn from(line: FrameLine) -> Self {
        let pose = |[x, y, theta]: [f64; 3]| SE2::new(x, y, theta);
        let ranges_m = line.ranges_m.into_iter();
        Self {
            stamp_s: line.stamp_s,
            odometry: line.odometry.map(pose),
            scan: LaserScan {
                first_angle_rad: line.first_angle_rad,
                angle_step_rad: line.angle_step_rad,
                range_min_m: line.range_min_m,
                range_max_m: line.range_max_m.unwrap_or(f64::INFINITY),
                body_from_sensor: pose(line.body_from_sensor),
                beam_interval_s: line.beam_interval_s,
                velocity: None,
                ranges_m: ranges_m
                    .map(|range_m| range_m.unwrap_or(f64::NAN))
                    .collect(),
            },
        }
    }
}

impl FrameLine {
    /// Reads a line that must have a pose.
    ///
    /// # Errors
    /// If the line is not a frame or has no pose.
    pub fn with_pose(line: &str) -> Result<Self, String> {
        let line: Self = serde_json::from_str(line).map_err(|problem| in_words(&problem))?;
        if line.pose.is_none() {
            return Err("expected a frame with a pose".to_owned());
        }
        Ok(line)
    }

    /// Writes the line with its newline.
    ///
    /// # Errors
    /// If `target` fails.
    pub fn write(&self, mut target: impl Write) -> io::Result<()> {
        serde_json::to_writer(&mut target, self)?;
        target.write_all(b"\n")
    }
}

/// Writes frames with their true poses, a line each.
///
/// # Errors
/// If `target` fails.
pub fn write_frames(
    frames: impl IntoIterator<Item = (LogFrame, SE2)>,
    target: &mut impl Write,
) -> io::Result<()> {
    for (frame, truth) in frames {
        let line = FrameLine {
            truth: Some(truth.to_array()),
            ..FrameLine::from(&frame)
        };
        line.write(&mut *target)?;
    }
    target.flush()
}

/// Reads a log of JSON lines.
pub type JsonLogReader<R> = LineReader<R, JsonLines>;

/// The format: each line is independent.
#[derive(Debug, Default)]
pub struct JsonLines {
    /// Objects with names of their own.
    rows: TableRows,
}

impl LineFormat for JsonLines {
    const NO_SCANS: &'static str = "no line is a frame with ranges_m";

    fn read_line(
        &mut self,
        line: &[u8],
        _frames: usize,
        notes: &mut LogNotes,
    ) -> Result<Option<LogFrame>, String> {
        // Byte order mark that some editors write.
        let line = line.strip_prefix(b"\xef\xbb\xbf").unwrap_or(line);
        if line.trim_ascii().is_empty() {
            return Ok(None);
        }
        let read: Result<FrameLine, _> = serde_json::from_slice(line);
        let line = match read {
            Ok(line) => line,
            Err(problem) => {
                let object: Value = serde_json::from_slice(line).map_err(|it| in_words(&it))?;
                let mut values = Vec::new();
                flatten(&object, String::new(), &mut values);
                let is_ranges =
                    |(name, _): &(String, String)| column(name).0 == ColumnMeaning::Ranges;
                if values.iter().any(is_ranges) {
                    return self.rows.frame_of(&values, notes);
                }
                let names = listed(values.into_iter().map(|(name, _)| printable(&name)));
                return Err(format!(
                    "{}; its names are {names}; it needs a time, angle_min, angle_increment and ranges, in these names or those of docs/recordings.md",
                    in_words(&problem)
                ));
            }
        };
        let frame = LogFrame::from(line);
        plausible_stamp_s(frame.stamp_s)?;
        for pose in [Some(frame.scan.body_from_sensor), frame.odometry] {
            pose.map(plausible_pose).transpose()?;
        }
        *notes.records.entry("frame".to_owned()).or_default() += 1;
        Ok(Some(frame))
    }
}

/// The values of an object and of those in it, with the names on the way to each; three numbers of a pose are x, y and theta.
fn flatten(value: &Value, name: String, values: &mut Vec<(String, String)>) {
    let inner = |key: &str| {
        if name.is_empty() {
            key.to_owned()
        } else {
            format!("{name}.{key}")
        }
    };
    match value {
        Value::Object(object) => {
            for (key, value) in object {
                flatten(value, inner(key), values);
            }
        }
        Value::Array(items)
            if items.len() == 3 && column(&inner("theta")).0 == ColumnMeaning::Heading =>
        {
            for (key, item) in ["x", "y", "theta"].iter().zip(items) {
                flatten(item, inner(key), values);
            }
        }
        Value::String(text) => values.push((name, text.clone())),
        other => values.push((name, other.to_string())),
    }
}

/// The error of serde without its own position.
fn in_words(problem: &serde_json::Error) -> String {
    format!(
        "expected a frame as JSON, but at column {}: {}",
        problem.column(),
        json_words(problem)
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::log::{LogOptions, LogReader};
    use crate::log_format::LogFormat;

    fn frame() -> LogFrame {
        LogFrame {
            stamp_s: 12.5,
            odometry: Some(SE2::new(1.0, -2.0, 0.3)),
            scan: LaserScan {
                first_angle_rad: -1.5,
                angle_step_rad: 0.1,
                ranges_m: vec![1.25, 0.0, 0.1 + 0.2],
                ..LaserScan::default()
            },
        }
    }

    #[test]
    fn what_is_written_reads_back_to_the_same_bits() {
        for mark in [&b""[..], b"\xef\xbb\xbf"] {
            let mut bytes = mark.to_vec();
            FrameLine::from(&frame()).write(&mut bytes).unwrap();
            let options = LogOptions::default();
            let mut reader = LogFormat::open(&bytes[..], "x.jsonl", &options).unwrap();
            assert_eq!(reader.next_frame().unwrap(), Some(frame()));
            assert_eq!(reader.next_frame().unwrap(), None);
        }
    }

    #[test]
    fn objects_with_names_of_their_own_are_frames() {
        for line in [
            r#"{"timestamp": 12.5, "pose": {"x": 1, "y": -2, "theta": 0.3}, "scan": {"angle_min": -1.5, "angle_increment": 0.1, "ranges": [1.25, null, 2]}}"#,
            r#"{"t": 12.5, "odom": [1, -2, 0.3], "angle_min": -1.5, "angle_increment": 0.1, "ranges": [1.25, "N/A", 2, null]}"#,
            r#"{"data": {"header": {"stamp": {"sec": 12, "nanosec": 500000000}}, "angle_min": -1.5, "angle_increment": 0.1, "ranges": [1.25, null, 2]}, "position": {"x": 1, "y": -2}, "yaw": 0.3}"#,
        ] {
            let mut reader = JsonLogReader::new(line.as_bytes(), "x.jsonl");
            let read = reader.next_frame().unwrap().unwrap();
            assert_eq!(
                (read.stamp_s, read.odometry),
                (12.5, frame().odometry),
                "{line}"
            );
            assert_eq!(read.scan.first_angle_rad, -1.5);
            assert!(read.scan.ranges_m[1].is_nan() && read.scan.ranges_m[2] == 2.0);
            let beams = 3 + usize::from(line.contains("2, null"));
            assert_eq!(read.scan.ranges_m.len(), beams);
        }
        let other = br#"{"time": 1, "values": [1, 2]}"#;
        let mut reader = JsonLogReader::new(&other[..], "x.jsonl");
        let error = reader.next_frame().unwrap_err().to_string();
        assert!(
            error.contains("its names are time, values; it needs"),
            "{error}"
        );
    }

    #[test]
    fn lines_that_are_no_frame_are_named() {
        let mut bytes = b"{\"stamp_s\": 1}\n".to_vec();
        let mut reader = JsonLogReader::new(&bytes[..], "x.jsonl");
        let error = reader.next_frame().unwrap_err().to_string();
        assert!(
            error.starts_with("x.jsonl has no usable scan: line 1: expected a frame as JSON"),
            "{error}"
        );
        FrameLine::from(&frame()).write(&mut bytes).unwrap();
        bytes.extend_from_slice(b"{\"stamp");
        let mut reader = JsonLogReader::new(&bytes[..], "x.jsonl");
        while reader.next_frame().unwrap().is_some() {}
        let sentences = reader.notes().sentences("x.jsonl").join(" ");
        assert!(sentences.contains("the first is line 1"), "{sentences}");
        assert!(
            sentences.contains("the last line, 3, is incomplete"),
            "{sentences}"
        );
    }
}
