//! What the columns of a table are: by the header of the file, by its form, or by the user.

mod clock;
pub(crate) mod guess;
mod names;
mod poses;
mod words;

use std::str::FromStr;

use crate::lines::printable;
pub use clock::seconds;
pub use names::{column, settle};
pub use words::{is_missing, list, number, words};

/// Meaning of a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum ColumnMeaning {
    /// Nothing that is read.
    Other,
    /// Time of a scan or a beam.
    Time,
    /// Whole seconds of a time.
    Seconds,
    /// Nanoseconds of a time.
    Nanoseconds,
    /// Bearing of a beam.
    Angle,
    /// Range of a beam.
    Range,
    /// Quality of a beam; 0 is no return.
    Quality,
    /// Odometry: position and heading.
    X,
    /// Odometry.
    Y,
    /// Odometry.
    Heading,
    /// Odometry: orientation as a quaternion.
    OrientationX,
    /// Odometry.
    OrientationY,
    /// Odometry.
    OrientationZ,
    /// Odometry.
    OrientationW,
    /// Bearing of the first beam.
    AngleMin,
    /// Bearing of the last beam.
    AngleMax,
    /// Angle between beams.
    AngleIncrement,
    /// Time between beams.
    TimeIncrement,
    /// Time between scans.
    ScanTime,
    /// Shorter ranges are no returns.
    RangeMin,
    /// Longer ranges are no returns.
    RangeMax,
    /// One of the ranges of a scan, or all from here on.
    Ranges,
    /// The bearings of a scan, as a list.
    Angles,
    /// The name of the laser, if the table has several.
    Sensor,
}

/// A column with the factor that makes its unit SI; `None` if it is to be found by the size of the numbers.
pub type Scaled = (ColumnMeaning, Option<f64>);

/// The columns of a table in order.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TableLayout {
    /// The columns; the last one counts for all further words if it is [`ColumnMeaning::Ranges`].
    pub columns: Vec<Scaled>,
    /// Whether beams turn clockwise, as RPLidar counts them.
    pub is_clockwise: bool,
    /// First angle and step of scans whose rows state none, rad.
    pub angles_rad: Option<[f64; 2]>,
    /// First and last angle of scans whose rows state none, rad.
    pub view_rad: Option<[f64; 2]>,
    /// Whether the first row has the angles of the beams.
    pub begins_with_angles: bool,
}

/// The header is among so many lines.
const FIRST_LINES: usize = 64;
/// Beams of the URG-04LX in a log of BreezySLAM, and the words before them.
const BREEZY: (usize, usize) = (682, 24);
/// First angle and step of that sensor, degrees.
const BREEZY_ANGLES: [f64; 2] = [-120.0, 240.0 / 681.0];

impl TableLayout {
    /// The layout of a file with this start.
    #[must_use]
    pub fn of(start: &[u8]) -> Option<Self> {
        let lines = Self::first_lines(start);
        let at = lines.iter().position(|line| !is_note(line))?;
        let fits =
            |layout: &Self, row: Option<&&str>| row.is_none_or(|row| layout.has_numbers(row));
        // A comment may be the header, or have its words.
        let noted = lines[..at].iter().find_map(|note| {
            let layout = Self::of_header(note);
            layout.filter(|layout| fits(layout, lines.get(at)))
        });
        let text = lines[at];
        let row = lines[at + 1..].iter().find(|line| !is_note(line));
        noted
            .or_else(|| Self::of_header(text).filter(|layout| fits(layout, row)))
            .or_else(|| Self::of_sdk(text))
            .or_else(|| Self::of_echo(text))
            .or_else(|| Self::of_breezy(text))
            .or_else(|| Self::of_angles(text))
    }

    /// The first lines with text.
    fn first_lines(start: &[u8]) -> Vec<&str> {
        let lines = start.split(|&byte| byte == b'\n' || byte == b'\r');
        let lines = lines.map_while(|line| std::str::from_utf8(line).ok());
        let lines = lines.map(|line| line.trim_start_matches('\u{feff}'));
        let lines = lines.filter(|line| !line.trim().is_empty());
        lines.take(FIRST_LINES).collect()
    }

    /// By a header.
    fn of_header(text: &str) -> Option<Self> {
        let columns = Self::columns_of_header(text)?;
        let of = |wanted: ColumnMeaning| columns.iter().filter(|c| c.0 == wanted).count();
        let is_of_beams = of(ColumnMeaning::Angle) == 1 && of(ColumnMeaning::Range) == 1;
        let is_of_scans = of(ColumnMeaning::Ranges) > 0;
        let is_clockwise = is_of_beams && of(ColumnMeaning::Quality) > 0;
        (is_of_beams != is_of_scans).then(|| Self {
            is_clockwise,
            columns,
            ..Self::default()
        })
    }

    /// The columns that a header names; `None` if the text is none.
    fn columns_of_header(text: &str) -> Option<Vec<Scaled>> {
        let text = text.trim_start_matches(['#', '%', ' ']);
        let mut names: Vec<&str> = words(text).collect();
        while names.last().is_some_and(|name| name.is_empty()) {
            names.pop();
        }
        if names.len() < 2 || names.iter().any(|name| number(name).is_some()) {
            return None;
        }
        let mut columns: Vec<Scaled> = names.iter().map(|name| column(name)).collect();
        // A sentence may have the words of a header.
        let is_prose =
            !text.contains([',', ';', '\t']) && columns.iter().any(|c| c.0 == ColumnMeaning::Other);
        if is_prose {
            return None;
        }
        // `rostopic echo -p` prints every time in nanoseconds, also that of a simulation, which is small.
        if names.iter().any(|name| name.starts_with("field.")) {
            let times = columns.iter_mut();
            times
                .filter(|column| column.0 == ColumnMeaning::Time)
                .for_each(|column| column.1 = Some(1e-9));
        }
        settle(&mut columns, &names);
        Some(columns)
    }

    /// By the words of RPLidar's SDK: `S  theta: 0.50 Dist: 00234.00 Q: 47`.
    fn of_sdk(text: &str) -> Option<Self> {
        let is_sdk = ["theta:", "Dist:", "Q:"]
            .iter()
            .all(|word| text.contains(word));
        is_sdk.then(|| Self {
            columns: vec![
                (ColumnMeaning::Angle, Some(1.0_f64.to_radians())),
                (ColumnMeaning::Range, Some(1e-3)),
                (ColumnMeaning::Quality, Some(1.0)),
            ],
            is_clockwise: true,
            ..Self::default()
        })
    }

    /// By the row of `ros2 topic echo --csv`: two integers, the frame, and numbers.
    fn of_echo(text: &str) -> Option<Self> {
        let words: Vec<&str> = text.split(',').map(str::trim).collect();
        let (head, rest) = words.split_at_checked(3)?;
        let is_time = head[..2].iter().all(|word| word.parse::<u32>().is_ok());
        let is_row = is_time && head[2].parse::<f64>().is_err() && rest.len() > 7;
        let numbers = rest.iter().take(7);
        (is_row && numbers.clone().all(|word| word.parse::<f64>().is_ok())).then(|| {
            "sec,nanosec,frame_id,angle_min,angle_max,angle_increment,time_increment,scan_time,range_min,range_max,ranges"
                .parse()
                .expect("they are names of columns")
        })
    }

    /// By the number of integers in a row of BreezySLAM's examples.
    fn of_breezy(text: &str) -> Option<Self> {
        let (beams, before) = BREEZY;
        let words: Vec<&str> = text.split_ascii_whitespace().collect();
        let is_row =
            words.len() == beams + before && words.iter().all(|w| w.parse::<u64>().is_ok());
        is_row.then(|| {
            let mut columns = vec![(ColumnMeaning::Other, None); before];
            columns[0] = (ColumnMeaning::Time, Some(1e-6));
            columns.push((ColumnMeaning::Ranges, Some(1e-3)));
            Self {
                columns,
                angles_rad: Some(BREEZY_ANGLES.map(f64::to_radians)),
                ..Self::default()
            }
        })
    }

    /// By a first row of evenly spaced angles behind a word that is no number; the rows below are times and ranges.
    fn of_angles(text: &str) -> Option<Self> {
        let mut words = words(text);
        if words.next().and_then(number).is_some_and(f64::is_finite) {
            return None;
        }
        let angles: Option<Vec<f64>> = words.map(number).collect();
        let angles = angles.filter(|angles| angles.len() > 3)?;
        Some(Self {
            columns: vec![(ColumnMeaning::Time, None), (ColumnMeaning::Ranges, None)],
            angles_rad: Some(evenly(&angles)?),
            begins_with_angles: true,
            ..Self::default()
        })
    }

    /// Whether a row has numbers where the layout has ranges.
    fn has_numbers(&self, row: &str) -> bool {
        let is_range = |at: &usize| {
            matches!(
                self.column(*at),
                Some((ColumnMeaning::Range | ColumnMeaning::Ranges, _))
            )
        };
        let mut ranges = words(row)
            .enumerate()
            .filter(|(at, _)| is_range(at))
            .peekable();
        let is_numbers =
            // The reader says what dots mean.
            |word: &str| list(word).all(|item| is_missing(item) || number(item).is_some() || item == "...");
        ranges.peek().is_some() && ranges.all(|(_, word)| is_numbers(word))
    }

    /// Number of readings that the header names.
    #[must_use]
    pub fn named_ranges(&self) -> usize {
        let columns = self.columns.iter();
        columns
            .filter(|column| column.0 == ColumnMeaning::Ranges)
            .count()
    }

    /// Whether a row is a beam, not a scan.
    #[must_use]
    pub fn is_of_beams(&self) -> bool {
        self.has(ColumnMeaning::Angle) && self.has(ColumnMeaning::Range)
    }

    /// Whether a column has this meaning.
    #[must_use]
    pub fn has(&self, wanted: ColumnMeaning) -> bool {
        self.columns.iter().any(|column| column.0 == wanted)
    }

    /// The column of a word; `None` beyond the last.
    #[must_use]
    pub fn column(&self, at: usize) -> Option<Scaled> {
        let last = self
            .columns
            .last()
            .filter(|last| last.0 == ColumnMeaning::Ranges);
        self.columns.get(at).or(last).copied()
    }
}

impl FromStr for TableLayout {
    type Err = String;

    /// Names of columns, separated by commas; `-` is not read, and `ranges` at the end stands for all that follow.
    /// `ranges@-90:90` states the first and the last angle, degrees.
    fn from_str(text: &str) -> Result<Self, String> {
        let (text, view_rad) = match text.split_once('@') {
            Some((text, view)) => (text, Some(view_of(view)?)),
            None => (text, None),
        };
        let columns = named(text)?;
        let has = |wanted: ColumnMeaning| columns.iter().any(|column| column.0 == wanted);
        if has(ColumnMeaning::Ranges) == (has(ColumnMeaning::Angle) && has(ColumnMeaning::Range)) {
            return Err("name either ranges, or angle and range".to_owned());
        }
        if view_rad.is_some() && columns.last().is_none_or(|c| c.0 != ColumnMeaning::Ranges) {
            return Err(
                "angles come after ranges, which is the last column, such as time,ranges@-90:90"
                    .to_owned(),
            );
        }
        Ok(Self {
            columns,
            view_rad,
            ..Self::default()
        })
    }
}

/// The columns of names, separated by commas.
fn named(text: &str) -> Result<Vec<Scaled>, String> {
    let names: Vec<&str> = text.split(',').map(str::trim).collect();
    let columns: Result<Vec<Scaled>, String> = names
        .iter()
        .map(|name| match column(name) {
            (ColumnMeaning::Other, _) if *name != "-" => Err(format!(
                "there is no column {}; use time, sec, nanosec, angle, range, quality, x, y, heading, angle_min, angle_max, angle_increment, time_increment, scan_time, range_min, range_max, ranges or -, with units such as time_us, angle_deg, range_mm",
                printable(name)
            )),
            column => Ok(column),
        })
        .collect();
    let mut columns = columns?;
    settle(&mut columns, &names);
    Ok(columns)
}

/// The first angle and the step of evenly spaced angles, rad; they are degrees if no turn in radians has so many.
pub fn evenly(angles: &[f64]) -> Option<[f64; 2]> {
    let (first, last) = (*angles.first()?, *angles.last()?);
    let step = (last - first) / (angles.len() as f64 - 1.0);
    let mut steps = angles.windows(2).map(|two| two[1] - two[0]);
    let is_even = steps.all(|other| (other - step).abs() < 0.05 * step.abs());
    let is_in_degrees = first.abs().max(last.abs()) > 7.0;
    let unit = if is_in_degrees {
        1.0_f64.to_radians()
    } else {
        1.0
    };
    is_even.then_some([unit * first, unit * step])
}

/// Whether a line is a comment, or tells a spreadsheet its separator.
pub fn is_note(text: &str) -> bool {
    let text = text.trim_start();
    let begins = text.get(..4).unwrap_or_default();
    text.starts_with(['#', '%']) || text.starts_with("//") || begins.eq_ignore_ascii_case("sep=")
}

/// The first and the last angle of `-90:90`, in rad.
fn view_of(text: &str) -> Result<[f64; 2], String> {
    let angles = text.split_once(':').and_then(|(first, last)| {
        let angle = |text: &str| {
            text.trim()
                .parse::<f64>()
                .ok()
                .filter(|deg| deg.is_finite())
        };
        Some([angle(first)?, angle(last)?])
    });
    angles
        .filter(|[first, last]| first != last && (last - first).abs() <= 360.0)
        .map(|angles| angles.map(f64::to_radians))
        .ok_or_else(|| {
            "the first and the last angle come after ranges, in degrees, such as ranges@-90:90"
                .to_owned()
        })
}
