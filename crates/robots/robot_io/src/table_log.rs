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
mod row;
mod sweep;

use core::f64::consts::{PI, TAU};

use ch16_slam2d::scan::LaserScan;
use pr_geom::SE2;

use limit::UnstatedLimit;
use row::Row;
use sweep::BeamBuffer;

use crate::line_log::{LineFormat, LineReader};
use crate::lines::printable;
use crate::log::{LogFrame, LogNotes};
use crate::plausible::plausible_pose;
use crate::remark::{Part, Remark};
use crate::ros::ScanFields;
use crate::table_layout::{self, ColumnMeaning, Scaled, TableLayout};

/// Time between scans of a table without times, s: that of most cheap scanners.
const PERIOD_S: f64 = 0.1;

/// A restart of the odometry is one wide step of its heading.
const WIDE_STEPS: usize = 3;

/// Reads a table, row by row.
pub type TableReader<R> = LineReader<R, TableRows>;

/// State of a table that is being read.
#[derive(Debug, Default)]
pub struct TableRows {
    layout: TableLayout,
    /// The laser whose rows are read: the first one, unless an option names it.
    sensor: Option<String>,
    /// Most words of a row so far.
    most_words: usize,
    /// The last heading without a unit, and the number of steps from one to the next that no turn in radians has.
    last_heading: Option<f64>,
    wide_steps: usize,
    sweep: BeamBuffer,
    limit: UnstatedLimit,
    done: Option<LogFrame>,
    /// Frames completed so far: their times, if the table has none.
    frames: usize,
    has_rows: bool,
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

    /// Reads the rows of the laser with this name only.
    #[must_use]
    pub fn of_sensor(self, sensor: Option<String>) -> Self {
        Self { sensor, ..self }
    }

    /// The frame of an object's values, whose names are those of columns; `None` if it has no ranges or another laser.
    ///
    /// # Errors
    /// If a value is no number, or the scan is incomplete.
    pub(crate) fn frame_of(
        &mut self,
        values: &[(String, String)],
        notes: &mut LogNotes,
    ) -> Result<Option<LogFrame>, String> {
        let names: Vec<&str> = values.iter().map(|(name, _)| name.as_str()).collect();
        let mut columns: Vec<Scaled> = names
            .iter()
            .map(|name| table_layout::column(name))
            .collect();
        table_layout::settle(&mut columns, &names);
        let mut row = Row::default();
        for (column, (name, value)) in columns.into_iter().zip(values) {
            row.take(column, value, name)?;
        }
        let mut row = row.completed()?;
        if !self.is_of_laser(&row, notes) {
            return Ok(None);
        }
        self.complete(&mut row.fields)?;
        self.frame(row, notes).map(Some)
    }

    /// Whether a row is of the laser that is read: each one has its own place on the robot, which a table does not state.
    fn is_of_laser(&mut self, row: &Row, notes: &mut LogNotes) -> bool {
        let Some(name) = &row.sensor else {
            return true;
        };
        let own = self.sensor.get_or_insert_with(|| name.clone());
        if own == name {
            return true;
        }
        let remark = Remark::mended(
            Part::Sensor,
            format!(
                "the scans are of several lasers; those of {} are read, those of {} are not: --scan-topic {} chooses",
                printable(own),
                printable(name),
                printable(name)
            ),
        );
        if !notes.warnings.contains(&remark) && notes.warnings.len() < 10 {
            notes.warnings.push(remark);
        }
        false
    }

    fn row(&self, text: &str) -> Result<Row, String> {
        let mut row = Row::default();
        let is_sdk = text.contains("theta:");
        let words = table_layout::words(text)
            .filter(|word| !is_sdk || table_layout::number(word).is_some());
        for (at, word) in words.enumerate() {
            row.words += 1;
            if let Some(column) = self.layout.column(at) {
                row.take(column, word, &format_args!("word {}", at + 1))?;
            }
        }
        // A separator at the end of the row is none; a reading with a name is one.
        let ranges_m = &mut row.fields.ranges_m;
        let named = self.layout.named_ranges();
        let named = named.min(ranges_m.len() + row.missing);
        if ranges_m.len() < named {
            ranges_m.resize(named, f64::NAN);
        }
        row.completed()
    }

    /// The time (s) and the pose of a row of odometry; `None` if the line is empty, a comment or a header.
    ///
    /// # Errors
    /// If the row has none, or they are out of range.
    pub(crate) fn pose(
        &mut self,
        line: &[u8],
        notes: &mut LogNotes,
    ) -> Result<Option<(f64, SE2)>, String> {
        let text = String::from_utf8_lossy(line);
        let text = text.trim_start_matches('\u{feff}').trim();
        if is_empty(text) || is_header(text) {
            return Ok(None);
        }
        let row = self.row(text)?;
        let (Some(time_s), [Some(x), Some(y), Some(heading)]) = (row.time_s, row.pose) else {
            return Err("a pose must have a time, x, y and a heading".to_owned());
        };
        notes.warnings.extend(self.heading_remark(heading));
        Ok(Some((time_s, plausible_pose(SE2::new(x, y, heading))?)))
    }

    /// A remark, once, on a heading whose steps from row to row are more than half a turn again and again, and not those of
    /// an angle that passes half a turn: it is in degrees.
    pub(crate) fn heading_remark(&mut self, heading: f64) -> Option<Remark> {
        let mut columns = self.layout.columns.iter();
        if columns.any(|column| column.0 == ColumnMeaning::Heading && column.1.is_some()) {
            return None;
        }
        let step = self
            .last_heading
            .replace(heading)
            .map_or(0.0, |last| heading - last)
            .abs();
        let is_wide = step > PI && (step - TAU).abs() > 0.5 * PI;
        self.wide_steps += usize::from(is_wide);
        let is_first = is_wide && self.wide_steps == WIDE_STEPS;
        is_first.then(|| {
            Remark::wrong(
                Part::Odometry,
                "its heading turns by more than half a turn from row to row, as one in degrees does that is read as radians: name the column heading_deg".to_owned(),
            )
        })
    }

    /// The frame of a scan; what was corrected goes to the notes.
    fn frame(&mut self, row: Row, notes: &mut LogNotes) -> Result<LogFrame, String> {
        let (mut scan, mut remarks): (LaserScan, _) = row.fields.checked(0.0)?;
        remarks.extend(self.limit.apply(&mut scan));
        for sentence in remarks {
            // The same sentence has other numbers in the next scan.
            let until_number = sentence.find(|c: char| c.is_ascii_digit());
            let kind = &sentence[..until_number.unwrap_or(sentence.len())];
            let mut said = notes.warnings.iter();
            if !said.any(|said| said.text.starts_with(kind)) {
                notes.warnings.push(Remark::mended(Part::Sensor, sentence));
            }
        }
        if row.time_s.is_none() && self.frames == 0 {
            notes.warnings.push(Remark::mended(
                Part::Clocks,
                format!("the table has no times; its scans are taken as {PERIOD_S} s apart"),
            ));
        }
        let heading = row.pose[2].filter(|_| row.orientation == [0.0; 4]);
        let remark = heading.and_then(|heading| self.heading_remark(heading));
        notes.warnings.extend(remark);
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
        let whole = self.most_words.min(self.layout.columns.len());
        if row.words < whole {
            return Err(format!("it has {} of {whole} columns", row.words));
        }
        self.most_words = self.most_words.max(row.words);
        if !self.is_of_laser(&row, notes) {
            return Ok(None);
        }
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

/// Whether a row is a comment or has no words.
fn is_empty(text: &str) -> bool {
    text.is_empty() || table_layout::is_note(text)
}

/// Whether a row names columns.
fn is_header(text: &str) -> bool {
    table_layout::words(text).all(|word| table_layout::number(word).is_none())
}

#[cfg(test)]
mod tests;
