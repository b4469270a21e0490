//! What is wrong with a recording, by the part of the robot that it is about.

use serde::Serialize;

/// The option that maps by scans alone.
pub const NO_ODOMETRY: &str = "--no-odometry";

/// A part of a robot's recording.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Part {
    /// The file and its records.
    File,
    /// The laser and the fields of its scans.
    Sensor,
    /// Odometry.
    Odometry,
    /// Where the laser sits.
    Mounting,
    /// Times.
    Clocks,
}

/// How it stands with a part.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// As it should be.
    Good,
    /// Something was wrong and was mended, or is missing and can be done without.
    Mended,
    /// Something is wrong and stays so.
    Wrong,
}

impl Verdict {
    /// Its sign: ✓, ! or ✗.
    #[must_use]
    pub fn sign(self) -> char {
        match self {
            Self::Good => '✓',
            Self::Mended => '!',
            Self::Wrong => '✗',
        }
    }
}

/// A sentence about a part.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Remark {
    /// What it is about.
    pub part: Part,
    /// How it stands with it.
    pub verdict: Verdict,
    /// The sentence, without a point at its end.
    pub text: String,
    /// Options of the command that answer it, such as `--laser 0,0,180`: any of them, not all.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub options: Vec<String>,
}

impl Remark {
    fn new(part: Part, verdict: Verdict, text: String) -> Self {
        Self {
            part,
            verdict,
            text,
            options: Vec::new(),
        }
    }

    /// Something that is as it should be.
    #[must_use]
    pub fn good(part: Part, text: String) -> Self {
        Self::new(part, Verdict::Good, text)
    }

    /// Something that was mended.
    #[must_use]
    pub fn mended(part: Part, text: String) -> Self {
        Self::new(part, Verdict::Mended, text)
    }

    /// Something that is wrong.
    #[must_use]
    pub fn wrong(part: Part, text: String) -> Self {
        Self::new(part, Verdict::Wrong, text)
    }

    /// The same remark with an option more that answers it.
    #[must_use]
    pub fn with_option(mut self, option: impl AsRef<str>) -> Self {
        self.options.push(option.as_ref().to_owned());
        self
    }
}
