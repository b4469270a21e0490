//! The options of a log: their names, values and error sentences, once for the command, Python and the page.
//!
//! A host passes pairs of a name and a text to [`LogOptions::read`], and says its own prefix.

use crate::footprint::Footprint;
use crate::laser_mount::LaserMount;
use crate::odometry_use::{OdometryFile, OdometryUse};
use crate::table_layout::TableLayout;

/// Largest shortest range, m.
const MAX_SHORTEST_M: f64 = 100.0;

/// How a log is read; `None`: found by type.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LogOptions {
    /// The topic of scans; default: the first one with scans.
    pub scan_topic: Option<String>,
    /// The topic of odometry, or /tf; default: the first one of nav_msgs/Odometry, else /tf.
    pub odometry_topic: Option<String>,
    /// The odometry frame in /tf; default: one whose name contains ‘odom’.
    pub odometry_frame: Option<String>,
    /// The frame of the robot's body; default: the child frame of the odometry.
    pub body_frame: Option<String>,
    /// Mounting of the laser, which overrides the recording.
    pub laser: Option<LaserMount>,
    /// Mounting of the laser if neither an option nor the recording states it: that of the session that is continued.
    pub laser_before: Option<LaserMount>,
    /// Shorter ranges are no returns, m.
    pub min_range_m: Option<f64>,
    /// Readings on the robot are no returns.
    pub footprint: Option<Footprint>,
    /// Columns of a table; default: those of its header, or those of a known form.
    pub columns: Option<TableLayout>,
    /// How the odometry is used.
    pub odometry: OdometryUse,
    /// The file that the odometry comes from, which follows the log among the files that are opened.
    pub odometry_file: Option<OdometryFile>,
    /// Whether the scans of further robots are read after those of the first one, so that they need not be named.
    pub all_robots: bool,
    /// Height band (m, on the body) for points of a 3-D sensor; without it, only single-ring clouds are read.
    pub heights_m: Option<(f64, f64)>,
}

/// One of [`LogOptions`] that a user may set.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LogOption {
    /// [`LogOptions::scan_topic`].
    ScanTopic,
    /// [`LogOptions::odometry_topic`].
    OdometryTopic,
    /// [`LogOptions::odometry_frame`].
    OdometryFrame,
    /// [`LogOptions::body_frame`].
    BodyFrame,
    /// [`LogOptions::laser`].
    Laser,
    /// [`LogOptions::heights_m`].
    Heights,
    /// [`LogOptions::min_range_m`].
    MinRange,
    /// [`LogOptions::footprint`].
    Footprint,
    /// [`LogOptions::columns`].
    Columns,
    /// [`LogOptions::odometry`].
    Odometry,
    /// [`OdometryUse::Ignore`].
    NoOdometry,
    /// [`LogOptions::all_robots`].
    AllRobots,
}

impl LogOption {
    /// All options.
    pub const ALL: [Self; 12] = [
        Self::ScanTopic,
        Self::OdometryTopic,
        Self::OdometryFrame,
        Self::BodyFrame,
        Self::Laser,
        Self::Heights,
        Self::MinRange,
        Self::Footprint,
        Self::Columns,
        Self::Odometry,
        Self::NoOdometry,
        Self::AllRobots,
    ];

    /// Those that choose a topic or a frame.
    pub const TOPICS: [Self; 4] = [
        Self::ScanTopic,
        Self::OdometryTopic,
        Self::OdometryFrame,
        Self::BodyFrame,
    ];

    /// Name on the command line, without the dashes.
    #[must_use]
    pub fn name(self) -> &'static str {
        self.row().0
    }

    /// Form of its value; `None` if it has none.
    #[must_use]
    pub fn value_name(self) -> Option<&'static str> {
        Some(self.row().1).filter(|form| !form.is_empty())
    }

    /// Description for a help text.
    #[must_use]
    pub fn about(self) -> &'static str {
        self.row().2
    }

    /// Name, form of the value and description.
    fn row(self) -> (&'static str, &'static str, &'static str) {
        match self {
            Self::ScanTopic => (
                "scan-topic",
                "TOPIC",
                "The topic of the scans, such as /scan",
            ),
            Self::OdometryTopic => (
                "odom-topic",
                "TOPIC",
                "The topic of the odometry, such as /odom, of stamped poses, or /tf",
            ),
            Self::OdometryFrame => ("odom-frame", "FRAME", "The odometry frame in /tf"),
            Self::BodyFrame => ("body-frame", "FRAME", "The frame of the robot's body"),
            Self::Laser => (
                "laser",
                "X,Y,DEG[,flipped]",
                "Mounting of the laser on the body, which overrides the recording: metres forward and to the left, and degrees counter-clockwise; ,flipped if it is mounted upside down or its driver lists beams clockwise",
            ),
            Self::Heights => (
                "heights",
                "LOW,HIGH",
                "Use the points of a 3-D sensor between these heights above the body's origin, m",
            ),
            Self::MinRange => (
                "min-range",
                "METRES",
                "Treat shorter ranges as no returns, m",
            ),
            Self::Footprint => (
                "footprint",
                "B,R,F,L",
                "Treat readings on the robot as no returns: back, right, front and left end of the rectangle that it covers, in metres from the body's origin",
            ),
            Self::Columns => (
                "columns",
                "NAMES",
                "Columns of a table of scans or beams without a header, such as time_us,angle_deg,range_mm or time,x,y,heading,angle_min,angle_increment,ranges; - is not read",
            ),
            Self::Odometry => (
                "odometry",
                "check|force|mirrored|none|FILE",
                "How the odometry is used: checked against the scans, as it is, checked with left and right exchanged, or not at all; or the file beside a log of text that it comes from: a table with time, x, y and heading, or lines of TUM, also with its columns, such as odom.csv@time_us,x_mm,y_mm,heading_deg",
            ),
            Self::NoOdometry => (
                "no-odometry",
                "",
                "Ignore odometry and match scans alone; same as --odometry none",
            ),
            Self::AllRobots => (
                "all-robots",
                "",
                "Map all robots of a recording into one map, one after the other, if it has scans of several",
            ),
        }
    }
}

impl LogOptions {
    /// Reads options; a name may have underscores, as in Python, and the last one of a name counts.
    ///
    /// # Errors
    /// If there is no option of a name, or a value does not fit; the sentence starts with the name.
    pub fn read<'a>(pairs: impl IntoIterator<Item = (&'a str, &'a str)>) -> Result<Self, String> {
        let mut options = Self::default();
        for (name, text) in pairs {
            let is_named = |option: &LogOption| option.name() == name.replace('_', "-");
            let option = LogOption::ALL.into_iter().find(is_named);
            let option = option.ok_or_else(|| format!("a log has no option {name}"))?;
            options = options
                .with(option, text)
                .map_err(|problem| format!("{name}: {problem}, not {text:?}"))?;
            if options.all_robots && options.first_asked().is_some() {
                return Err(format!(
                    "{name}: all robots have topics and frames of their own; leave those options out"
                ));
            }
        }
        Ok(options)
    }

    /// Sets one option.
    ///
    /// # Errors
    /// If the value does not fit: what was expected.
    pub fn with(mut self, option: LogOption, text: &str) -> Result<Self, String> {
        let name = || Some(text.to_owned());
        match option {
            LogOption::ScanTopic => self.scan_topic = name(),
            LogOption::OdometryTopic => self.odometry_topic = name(),
            LogOption::OdometryFrame => self.odometry_frame = name(),
            LogOption::BodyFrame => self.body_frame = name(),
            LogOption::Laser => self.laser = Some(text.parse()?),
            LogOption::Heights => self.heights_m = Some(heights_m(text)?),
            LogOption::MinRange => self.min_range_m = Some(min_range_m(text)?),
            LogOption::Footprint => self.footprint = Some(text.parse()?),
            LogOption::Columns => self.columns = Some(text.parse()?),
            LogOption::Odometry => match text.parse() {
                Ok(odometry) => self.odometry = odometry,
                Err(_) if text.contains(['.', '/', '\\']) => {
                    self.odometry_file = Some(text.parse()?);
                }
                Err(problem) => return Err(problem),
            },
            LogOption::NoOdometry => self.odometry = OdometryUse::Ignore,
            LogOption::AllRobots => self.all_robots = true,
        }
        Ok(self)
    }

    /// The options for a robot that drives.
    ///
    /// # Errors
    /// If they name a file.
    pub fn of_drive(self) -> Result<Self, String> {
        match &self.odometry_file {
            Some(file) => Err(format!(
                "odometry: a robot that drives sends its odometry; leave {} out",
                file.path
            )),
            None => Ok(self),
        }
    }

    /// The first topic or frame that is asked for.
    #[must_use]
    pub fn first_asked(&self) -> Option<(LogOption, &str)> {
        let asked = [
            &self.scan_topic,
            &self.odometry_topic,
            &self.odometry_frame,
            &self.body_frame,
        ];
        let mut asked = LogOption::TOPICS.into_iter().zip(asked);
        asked.find_map(|(option, asked)| Some((option, asked.as_deref()?)))
    }

    /// The topics of scans that are asked for.
    #[must_use]
    pub fn scan_topics(&self) -> Vec<String> {
        let asked = self.scan_topic.iter();
        asked
            .flat_map(|topics| topics.split(',').map(|topic| topic.trim().to_owned()))
            .collect()
    }
}

fn heights_m(text: &str) -> Result<(f64, f64), String> {
    let numbers = text.split_once(',').and_then(|(low, high)| {
        let (low, high) = (finite(low)?, finite(high)?);
        (low < high).then_some((low, high))
    });
    numbers.ok_or_else(|| "expected two heights, the lower one first, such as 0.2,0.6".to_owned())
}

fn min_range_m(text: &str) -> Result<f64, String> {
    let range_m = finite(text).filter(|range_m| (0.0..=MAX_SHORTEST_M).contains(range_m));
    range_m.ok_or_else(|| format!("expected metres within 0 to {MAX_SHORTEST_M}"))
}

fn finite(text: &str) -> Option<f64> {
    let number = text.trim().parse().ok();
    number.filter(|number: &f64| number.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn options_are_read_by_name_and_rejected_in_a_sentence() {
        let read = |name: &str, text: &str| LogOptions::read([(name, text)]);
        let options = LogOptions::read([
            ("heights", "0.2, 0.6"),
            ("min_range", "0.5"),
            ("odometry", "force"),
            ("no-odometry", ""),
        ]);
        let expected = LogOptions {
            heights_m: Some((0.2, 0.6)),
            min_range_m: Some(0.5),
            odometry: OdometryUse::Ignore,
            ..LogOptions::default()
        };
        assert_eq!(options, Ok(expected));
        for (name, text, said) in [
            (
                "heights",
                "2,1",
                "heights: expected two heights, the lower one first, such as 0.2,0.6, not \"2,1\"",
            ),
            (
                "min_range",
                "-1",
                "min_range: expected metres within 0 to 100, not \"-1\"",
            ),
            (
                "odometry",
                "wheels",
                "odometry: expected check, force, mirrored, none or a file such as odom.csv, not \"wheels\"",
            ),
            (
                "odometry",
                "odom.csv@time,x,y",
                "odometry: name time, x, y and heading of the odometry, not \"odom.csv@time,x,y\"",
            ),
            ("speed", "3", "a log has no option speed"),
        ] {
            assert_eq!(read(name, text), Err(said.to_owned()));
        }
        for (name, text) in [("laser", "0,0"), ("footprint", "1,1,0,0"), ("columns", "x")] {
            let said = read(name, text).unwrap_err();
            assert!(said.starts_with(&format!("{name}: ")), "{said}");
        }
        let both = LogOptions::read([("all-robots", ""), ("body-frame", "base")]).unwrap_err();
        assert!(both.starts_with("body-frame: all robots have"), "{both}");
    }
}
