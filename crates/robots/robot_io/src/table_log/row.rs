//! The numbers of a row, word by word.

use std::fmt::Display;

use crate::lines::printable;
use crate::plausible::{MAX_BEAMS, plausible_stamp_s};
use crate::ros::ScanFields;
use crate::table_layout::{self, ColumnMeaning, Scaled};
use crate::trajectory::yaw;

/// The numbers of a row.
#[derive(Clone, Debug)]
pub(super) struct Row {
    pub(super) words: usize,
    /// Readings without a number, before one that has.
    pub(super) missing: usize,
    /// The name of the laser, if the row has it.
    pub(super) sensor: Option<String>,
    pub(super) time_s: Option<f64>,
    /// x, y and heading of odometry.
    pub(super) pose: [Option<f64>; 3],
    /// Orientation of odometry: x, y, z and w of a quaternion.
    pub(super) orientation: [f64; 4],
    pub(super) angle: Option<f64>,
    pub(super) range: Option<f64>,
    pub(super) is_return: bool,
    pub(super) fields: ScanFields,
}

impl Default for Row {
    fn default() -> Self {
        Self {
            words: 0,
            missing: 0,
            sensor: None,
            time_s: None,
            pose: [None; 3],
            orientation: [0.0; 4],
            angle: None,
            range: None,
            is_return: true,
            fields: ScanFields::default(),
        }
    }
}

impl Row {
    /// Takes the word of a column; `place` is where it stands.
    pub(super) fn take(
        &mut self,
        (column, factor): Scaled,
        word: &str,
        place: &dyn Display,
    ) -> Result<(), String> {
        let fields = &mut self.fields;
        if column == ColumnMeaning::Other {
            return Ok(());
        }
        if word.contains("...") {
            return Err(
                "its ranges are cut off; print all of them: in NumPy np.set_printoptions(threshold=sys.maxsize, linewidth=sys.maxsize), in ROS ros2 topic echo --csv --full-length"
                    .to_owned(),
            );
        }
        if table_layout::is_missing(word) {
            self.missing += usize::from(column == ColumnMeaning::Ranges);
            return Ok(());
        }
        let of = |item: &str| {
            table_layout::number(item).ok_or_else(|| {
                let what = match column {
                    ColumnMeaning::Time => "a number of seconds or a date with a time of day",
                    _ => "a number",
                };
                format!("{place} must be {what}, not ‘{}’", printable(item))
            })
        };
        match column {
            ColumnMeaning::Ranges => {
                for item in table_layout::list(word) {
                    if table_layout::is_missing(item) {
                        self.missing += 1;
                        continue;
                    }
                    let range = of(item)?;
                    let beams = fields.ranges_m.len() + std::mem::take(&mut self.missing);
                    if beams >= MAX_BEAMS {
                        return Err(format!("a scan has more than {MAX_BEAMS} ranges"));
                    }
                    fields.ranges_m.resize(beams, f64::NAN);
                    fields.ranges_m.push(factor.unwrap_or(1.0) * range);
                }
                // The last items of a list are beams, as those of a row need not be.
                if table_layout::list(word).nth(1).is_some() {
                    let beams = fields.ranges_m.len() + std::mem::take(&mut self.missing);
                    fields.ranges_m.resize(beams.min(MAX_BEAMS), f64::NAN);
                }
                return Ok(());
            }
            ColumnMeaning::Angles => {
                let angles: Result<Vec<f64>, String> = table_layout::list(word).map(of).collect();
                let mut angles = angles?;
                angles
                    .iter_mut()
                    .for_each(|angle| *angle *= factor.unwrap_or(1.0));
                let [first, step] = table_layout::evenly(&angles)
                    .ok_or_else(|| format!("the angles of {place} must be evenly spaced"))?;
                (fields.angle_min, fields.angle_increment) = (first, step);
                fields.angle_max = f64::NAN;
                return Ok(());
            }
            ColumnMeaning::Sensor => {
                // A number is that of a frame.
                let name = Some(word).filter(|word| table_layout::number(word).is_none());
                self.sensor = name.map(str::to_owned);
                return Ok(());
            }
            ColumnMeaning::Time if let Some(time_s) = table_layout::seconds(word) => {
                self.time_s = Some(time_s);
                return Ok(());
            }
            _ => {}
        }
        let number = of(word)?;
        let value = factor.unwrap_or(1.0) * number;
        match column {
            ColumnMeaning::Other
            | ColumnMeaning::Ranges
            | ColumnMeaning::Angles
            | ColumnMeaning::Sensor => {}
            ColumnMeaning::Time => {
                self.time_s = Some(factor.unwrap_or_else(|| second(number)) * number);
            }
            ColumnMeaning::Seconds => self.time_s = Some(self.time_s.unwrap_or(0.0) + number),
            ColumnMeaning::Nanoseconds => {
                self.time_s = Some(self.time_s.unwrap_or(0.0) + 1e-9 * number);
            }
            ColumnMeaning::Angle => self.angle = Some(value),
            ColumnMeaning::Range => self.range = Some(value),
            ColumnMeaning::Quality => self.is_return = number > 0.0,
            ColumnMeaning::X => self.pose[0] = Some(value),
            ColumnMeaning::Y => self.pose[1] = Some(value),
            ColumnMeaning::Heading => self.pose[2] = Some(value),
            ColumnMeaning::OrientationX => self.orientation[0] = value,
            ColumnMeaning::OrientationY => self.orientation[1] = value,
            ColumnMeaning::OrientationZ => self.orientation[2] = value,
            ColumnMeaning::OrientationW => self.orientation[3] = value,
            ColumnMeaning::AngleMin => fields.angle_min = value,
            ColumnMeaning::AngleMax => fields.angle_max = value,
            ColumnMeaning::AngleIncrement => fields.angle_increment = value,
            ColumnMeaning::TimeIncrement => fields.time_increment = value,
            ColumnMeaning::ScanTime => fields.scan_time = value,
            ColumnMeaning::RangeMin => fields.range_min = value,
            ColumnMeaning::RangeMax => fields.range_max = value,
        }
        Ok(())
    }

    /// The row, whose time is checked and whose heading may be that of a quaternion.
    pub(super) fn completed(mut self) -> Result<Self, String> {
        self.time_s = self.time_s.map(plausible_stamp_s).transpose()?;
        if self.pose[2].is_none() && self.orientation != [0.0; 4] {
            self.pose[2] = Some(yaw(&self.orientation, false));
        }
        Ok(self)
    }
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
