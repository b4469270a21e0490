//! Tables: one scan or one beam per row, the columns named by a header, by the user, or known by their form.
//!
//! | file | rows |
//! |---|---|
//! | CSV with a header | scans with `ranges0, ranges1, …` and `angle_min`, `angle_increment`; or beams with `angle` and `range` |
//! | `rostopic echo -p`, `ros2 topic echo --csv` of a `sensor_msgs/LaserScan` | scans |
//! | output of RPLidar's SDK, `theta: … Dist: … Q: …` | beams, clockwise |
//! | `.dat` of BreezySLAM's examples | scans of a URG-04LX |
//!
//! Units are those of a name (`time_us`, `angle_deg`, `range_mm`), else those that the size of the numbers suggests.
//! Beams become a scan when their bearing goes back.

mod limit;
mod sweep;

use ch16_slam2d::scan::LaserScan;
use pr_geom::SE2;

use limit::UnstatedLimit;
use sweep::BeamBuffer;

use crate::line_log::{LineFormat, LineReader};
use crate::lines::printable;
use crate::log::{LogFrame, LogNotes};
use crate::plausible::{MAX_BEAMS, plausible_pose, plausible_stamp_s};
use crate::remark::{Part, Remark};
use crate::ros::ScanFields;
use crate::table_layout::{self, ColumnMeaning, TableLayout};
use crate::trajectory::yaw;

/// Time between scans of a table without times, s: that of most cheap scanners.
const PERIOD_S: f64 = 0.1;

/// Reads a table, row by row.
pub type TableReader<R> = LineReader<R, TableRows>;

/// State of a table that is being read.
#[derive(Debug, Default)]
pub struct TableRows {
    layout: TableLayout,
    sweep: BeamBuffer,
    limit: UnstatedLimit,
    done: Option<LogFrame>,
    /// Frames completed so far: their times, if the table has none.
    frames: usize,
    has_rows: bool,
}

/// The numbers of a row.
#[derive(Clone, Debug, Default)]
struct Row {
    time_s: Option<f64>,
    /// x, y and heading of odometry.
    pose: [Option<f64>; 3],
    /// Orientation of odometry: x, y, z and w of a quaternion.
    orientation: [f64; 4],
    angle: Option<f64>,
    range: Option<f64>,
    is_return: bool,
    fields: ScanFields,
}

impl TableRows {
    /// The state before the first row.
    #[must_use]
    pub fn new(layout: TableLayout) -> Self {
        Self {
            layout,
            ..Self::default()
        }
    }

    fn row(&self, text: &str) -> Result<Row, String> {
        let mut row = Row {
            is_return: true,
            ..Row::default()
        };
        let fields = &mut row.fields;
        let is_sdk = text.contains("theta:");
        let words = table_layout::words(text)
            .filter(|word| !is_sdk || table_layout::number(word).is_some());
        // Readings without a number, before one that has.
        let mut missing = 0;
        let mut time_s = None;
        for (at, word) in words.enumerate() {
            let Some((column, factor)) = self.layout.column(at) else {
                break;
            };
            if column == ColumnMeaning::Other {
                continue;
            }
            if word.contains("...") {
                return Err(
                    "its ranges are cut off; print them with ros2 topic echo --csv --full-length"
                        .to_owned(),
                );
            }
            if word.is_empty() {
                missing += usize::from(column == ColumnMeaning::Ranges);
                continue;
            }
            if column == ColumnMeaning::Ranges {
                for item in table_layout::list(word) {
                    if table_layout::is_missing(item) {
                        missing += 1;
                        continue;
                    }
                    let range = table_layout::number(item).ok_or_else(|| {
                        format!(
                            "word {} must be a number, not ‘{}’",
                            at + 1,
                            printable(item)
                        )
                    })?;
                    let beams = fields.ranges_m.len() + std::mem::take(&mut missing);
                    if beams >= MAX_BEAMS {
                        return Err(format!("a scan has more than {MAX_BEAMS} ranges"));
                    }
                    fields.ranges_m.resize(beams, f64::NAN);
                    fields.ranges_m.push(factor.unwrap_or(1.0) * range);
                }
                continue;
            }
            let number = table_layout::number(word).ok_or_else(|| {
                let what = if column == ColumnMeaning::Time {
                    "a number of seconds"
                } else {
                    "a number"
                };
                format!("word {} must be {what}, not ‘{}’", at + 1, printable(word))
            })?;
            let value = factor.unwrap_or(1.0) * number;
            match column {
                ColumnMeaning::Other | ColumnMeaning::Ranges => {}
                ColumnMeaning::Time => {
                    time_s = Some(factor.unwrap_or_else(|| second(number)) * number)
                }
                ColumnMeaning::Seconds => time_s = Some(time_s.unwrap_or(0.0) + number),
                ColumnMeaning::Nanoseconds => time_s = Some(time_s.unwrap_or(0.0) + 1e-9 * number),
                ColumnMeaning::Angle => row.angle = Some(value),
                ColumnMeaning::Range => row.range = Some(value),
                ColumnMeaning::Quality => row.is_return = number > 0.0,
                ColumnMeaning::X => row.pose[0] = Some(value),
                ColumnMeaning::Y => row.pose[1] = Some(value),
                ColumnMeaning::Heading => row.pose[2] = Some(value),
                ColumnMeaning::OrientationX => row.orientation[0] = value,
                ColumnMeaning::OrientationY => row.orientation[1] = value,
                ColumnMeaning::OrientationZ => row.orientation[2] = value,
                ColumnMeaning::OrientationW => row.orientation[3] = value,
                ColumnMeaning::AngleMin => fields.angle_min = value,
                ColumnMeaning::AngleMax => fields.angle_max = value,
                ColumnMeaning::AngleIncrement => fields.angle_increment = value,
                ColumnMeaning::TimeIncrement => fields.time_increment = value,
                ColumnMeaning::ScanTime => fields.scan_time = value,
                ColumnMeaning::RangeMin => fields.range_min = value,
                ColumnMeaning::RangeMax => fields.range_max = value,
            }
        }
        // A separator at the end of the row is none; a reading with a name is one.
        let named = self
            .layout
            .named_ranges()
            .min(row.fields.ranges_m.len() + missing);
        if row.fields.ranges_m.len() < named {
            row.fields.ranges_m.resize(named, f64::NAN);
        }
        row.time_s = time_s.map(plausible_stamp_s).transpose()?;
        Ok(row)
    }

    /// The time (s) and the pose of a row of odometry; `None` if the line is empty, a comment or a header.
    ///
    /// # Errors
    /// If the row has none, or they are out of range.
    pub(crate) fn pose(&self, line: &[u8]) -> Result<Option<(f64, SE2)>, String> {
        let text = String::from_utf8_lossy(line);
        let text = text.trim_start_matches('\u{feff}').trim();
        if is_empty(text) || is_header(text) {
            return Ok(None);
        }
        let mut row = self.row(text)?;
        if row.pose[2].is_none() && row.orientation != [0.0; 4] {
            row.pose[2] = Some(yaw(&row.orientation, false));
        }
        let (Some(time_s), [Some(x), Some(y), Some(heading)]) = (row.time_s, row.pose) else {
            return Err("a pose must have a time, x, y and a heading".to_owned());
        };
        Ok(Some((time_s, plausible_pose(SE2::new(x, y, heading))?)))
    }

    /// The frame of a scan; what was corrected goes to the notes.
    fn frame(&mut self, row: Row, notes: &mut LogNotes) -> Result<LogFrame, String> {
        let (mut scan, mut remarks): (LaserScan, _) = row.fields.checked(0.0)?;
        remarks.extend(self.limit.apply(&mut scan));
        for sentence in remarks {
            let remark = Remark::mended(Part::Sensor, sentence);
            if !notes.warnings.contains(&remark) && notes.warnings.len() < 10 {
                notes.warnings.push(remark);
            }
        }
        if row.time_s.is_none() && self.frames == 0 {
            notes.warnings.push(Remark::mended(
                Part::Clocks,
                format!("the table has no times; its scans are taken as {PERIOD_S} s apart"),
            ));
        }
        let odometry = match row.pose {
            [Some(x), Some(y), Some(heading)] => Some(plausible_pose(SE2::new(x, y, heading))?),
            _ => None,
        };
        let stamp_s = row.time_s.unwrap_or(PERIOD_S * self.frames as f64);
        self.frames += 1;
        *notes.records.entry("scan".to_owned()).or_default() += 1;
        Ok(LogFrame {
            stamp_s,
            odometry,
            scan,
        })
    }

    /// Ends a sweep of beams.
    fn end_sweep(&mut self, notes: &mut LogNotes) -> Result<Option<LogFrame>, String> {
        let sweep = std::mem::take(&mut self.sweep);
        let Some(fields) = sweep.fields(self.layout.is_clockwise) else {
            return Ok(None);
        };
        if self.frames == 0 {
            notes.about.push(format!(
                "rows are beams, and a scan ends where their bearing jumps back; bearings count {}",
                if self.layout.is_clockwise {
                    "clockwise, as RPLidar does; if the map is mirrored, pass --laser 0,0,0,flipped"
                } else {
                    "counter-clockwise; if the map is mirrored, pass --laser 0,0,0,flipped"
                }
            ));
        }
        let row = Row {
            time_s: sweep.first_s(),
            pose: sweep.pose,
            fields,
            ..Row::default()
        };
        self.frame(row, notes).map(Some)
    }
}

impl LineFormat for TableRows {
    const NO_SCANS: &'static str = "no row is a scan";

    fn read_line(
        &mut self,
        line: &[u8],
        _frames: usize,
        notes: &mut LogNotes,
    ) -> Result<Option<LogFrame>, String> {
        let text = String::from_utf8_lossy(line);
        let text = text.trim_start_matches('\u{feff}').trim();
        if is_empty(text) {
            return Ok(None);
        }
        if self.layout.begins_with_angles && !self.has_rows {
            self.has_rows = true;
            return Ok(None);
        }
        let row = match self.row(text) {
            Err(_) if !self.has_rows && is_header(text) => return Ok(None),
            other => other?,
        };
        self.has_rows = true;
        if !self.layout.is_of_beams() {
            let mut row = row;
            self.complete(&mut row.fields)?;
            return self.frame(row, notes).map(Some);
        }
        let (Some(angle), Some(range)) = (row.angle, row.range) else {
            return Err("a beam must have an angle and a range".to_owned());
        };
        let continued = self.sweep.bearing(angle, row.time_s);
        let bearing = continued.filter(|_| !text.starts_with("S "));
        let ended = match bearing {
            Some(_) => Ok(None),
            None => self.end_sweep(notes),
        };
        let range = if row.is_return { range } else { 0.0 };
        let bearing = bearing.unwrap_or(angle);
        self.sweep.add(bearing, range, row.time_s, row.pose)?;
        ended
    }

    fn at_end(&mut self, notes: &mut LogNotes) {
        // The last sweep may be a part of one; a part is a scan, too.
        self.done = self.end_sweep(notes).unwrap_or(None);
    }

    fn waiting(&mut self, is_done: bool) -> Option<LogFrame> {
        self.done.take().filter(|_| is_done)
    }
}

impl TableRows {
    /// Adds what the row of a scan does not state.
    fn complete(&self, fields: &mut ScanFields) -> Result<(), String> {
        if let Some([first, step]) = self.layout.angles_rad {
            (fields.angle_min, fields.angle_increment) = (first, step);
            // The angle of the last beam follows from them.
            fields.angle_max = f64::NAN;
            return Ok(());
        }
        if let Some([first, last]) = self.layout.view_rad {
            let steps = fields.ranges_m.len() as f64 - 1.0;
            fields.angle_min = first;
            fields.angle_increment = (last - first) / steps.max(1.0);
            fields.angle_max = f64::NAN;
            return Ok(());
        }
        if fields.angle_increment == 0.0 && fields.angle_min == fields.angle_max {
            return Err(
                "a scan must have angle_min and angle_increment; add both columns to the table, or state the first and the last angle, in degrees, with --columns …,ranges@-90:90"
                    .to_owned(),
            );
        }
        if fields.angle_max == 0.0 && fields.angle_increment != 0.0 {
            fields.angle_max = f64::NAN;
        }
        // `ros2 topic echo --csv` appends the intensities.
        let beams = (fields.angle_max - fields.angle_min) / fields.angle_increment;
        let beams = beams.round() + 1.0;
        if beams >= 1.0 && fields.ranges_m.len() as f64 > 1.5 * beams {
            fields.ranges_m.truncate(beams as usize);
        }
        Ok(())
    }
}

/// Whether a row is a comment or has no words.
fn is_empty(text: &str) -> bool {
    text.is_empty() || text.starts_with(['#', '%'])
}

/// Whether a row names columns.
fn is_header(text: &str) -> bool {
    table_layout::words(text).all(|word| table_layout::number(word).is_none())
}

/// The unit of a time by its size: s, ms, µs or ns since 1970.
fn second(time: f64) -> f64 {
    match time.abs() {
        size if size > 1e17 => 1e-9,
        size if size > 1e14 => 1e-6,
        size if size > 1e11 => 1e-3,
        _ => 1.0,
    }
}

#[cfg(test)]
mod tests;
