//! Remarks on a recording, by the part of the robot that they concern.

use serde::Serialize;

/// The option for mapping by scans alone.
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
    /// Pose of the laser on the body.
    Mounting,
    /// Stamps.
    Clocks,
}

/// Condition of a part.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Condition {
    /// Correct.
    Good,
    /// Something was wrong and was corrected, is missing and not required, or is suspected without proof.
    Mended,
    /// Something is wrong and was not corrected.
    Wrong,
}

impl Condition {
    /// Symbol: ✓, ! or ✗.
    #[must_use]
    pub fn sign(self) -> char {
        match self {
            Self::Good => '✓',
            Self::Mended => '!',
            Self::Wrong => '✗',
        }
    }
}

/// A sentence on a part.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Remark {
    /// The part that it concerns.
    pub part: Part,
    /// Its verdict.
    pub verdict: Condition,
    /// The sentence, without a full stop.
    pub text: String,
    /// Command line options that resolve it, such as `--laser 0,0,180`: alternatives.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub options: Vec<String>,
}

impl Remark {
    fn new(part: Part, verdict: Condition, text: String) -> Self {
        Self {
            part,
            verdict,
            text,
            options: Vec::new(),
        }
    }

    /// A remark that something is correct.
    #[must_use]
    pub fn good(part: Part, text: String) -> Self {
        Self::new(part, Condition::Good, text)
    }

    /// A remark that something was corrected.
    #[must_use]
    pub fn mended(part: Part, text: String) -> Self {
        Self::new(part, Condition::Mended, text)
    }

    /// A remark that something is wrong.
    #[must_use]
    pub fn wrong(part: Part, text: String) -> Self {
        Self::new(part, Condition::Wrong, text)
    }

    /// Adds an option that resolves it.
    #[must_use]
    pub fn with_option(mut self, option: impl AsRef<str>) -> Self {
        self.options.push(option.as_ref().to_owned());
        self
    }
}
