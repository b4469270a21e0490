//! How the odometry of a recording is taken, and from where.

use std::str::FromStr;

use pr_geom::SE2;

use crate::table_layout::TableLayout;

/// How the odometry of a recording is taken.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum OdometryUse {
    /// Compared with the scans, and corrected or ignored if a trial shows that it is wrong.
    #[default]
    Check,
    /// Taken as it is, whatever the scans say.
    Force,
    /// With left and right exchanged, then compared.
    Mirrored,
    /// Not at all: scans alone. It still shows how the laser is mounted.
    Ignore,
}

impl OdometryUse {
    /// All choices.
    pub const ALL: [Self; 4] = [Self::Check, Self::Force, Self::Mirrored, Self::Ignore];

    /// Name on the command line, as in `--odometry force`.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Check => "check",
            Self::Force => "force",
            Self::Mirrored => "mirrored",
            Self::Ignore => "none",
        }
    }

    /// The option that takes it so.
    #[must_use]
    pub fn option(self) -> String {
        format!("--odometry {}", self.name())
    }

    /// A recorded pose of the body.
    pub(crate) fn pose(self, recorded: SE2) -> SE2 {
        match self {
            Self::Mirrored => SE2::new(recorded.x(), -recorded.y(), -recorded.theta()),
            Self::Check | Self::Force | Self::Ignore => recorded,
        }
    }
}

impl FromStr for OdometryUse {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let named = |choice: &Self| choice.name() == text;
        Self::ALL.into_iter().find(named).ok_or_else(|| {
            "expected check, force, mirrored, none or a file such as odom.csv".to_owned()
        })
    }
}

/// The file that an option names, such as `odom.csv`, or `odom.csv@time_us,x_mm,y_mm,heading_deg` with its columns.
#[derive(Clone, Debug, PartialEq)]
pub struct OdometryFile {
    /// Its path.
    pub path: String,
    /// Its columns; default: those of its header, or those of a known form.
    pub columns: Option<TableLayout>,
}

impl FromStr for OdometryFile {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (path, columns) = match text.rsplit_once('@') {
            Some((path, columns)) => (path, Some(TableLayout::of_named_poses(columns)?)),
            None => (text, None),
        };
        Ok(Self {
            path: path.to_owned(),
            columns,
        })
    }
}
