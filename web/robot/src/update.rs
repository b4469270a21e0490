//! Updates for the widget: a kind, a text, numbers and bytes.
//!
//! | kind | numbers | text, bytes |
//! |---|---|---|
//! | `file` | size in bytes, whether there are scans | its name |
//! | `stage` | [`Stage`] as a number, share done, scans, loops tested, loops accepted | the error |
//! | `keyframes` | stamp (s), x, y (m), θ (rad), fit, σ (m) of each | |
//! | `map` | columns, rows, least x, least y, cell (m) | a byte a cell from the least y: 0 unknown, 1 free … 255 occupied |
//! | `loops` | ten for each, see [`links`](crate::links) | one line each: why it was rejected |
//! | `evidence` | count of the loops to look into, then of each of the first few: index in `loops`, newer and older keyframe, χ², gate, points around the older and around the newer keyframe, x and y of each in the frame of the older, m | |
//! | `doubts` | keyframes to check | one sentence per line |
//! | `diagnosis` | | the doctor's report as `slam2d doctor --json` prints it |
//! | `remarks` | | messages on the log, one sentence per line |
//! | `scan` | keyframe, then x and y of every point in the body's frame, m | |
//! | `sweep` | the same as it was measured, with the motion during the sweep in it | |
//! | `grade` | see [`grade`](crate::grade) | as text |
//! | `errors` | error of each keyframe, m; NaN if unknown | |
//! | `offers` | | one option per line: name, current choice, possible choices, separated by tabs |
//! | `where` | see [`localization`](crate::localization) | the other log's name, then one sentence per line |
//! | `answer` | | result of the last order |

/// Stage of the engine.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// The file is read, scan by scan.
    Reading = 1,
    /// No scan follows: the last loops are tested.
    Finishing = 2,
    /// A graph file is optimized.
    Solving = 3,
    /// The covariances are computed.
    Checking = 4,
    /// The map is complete.
    Done = 5,
    /// The file cannot be used.
    Failed = 6,
}

/// One update.
#[derive(Clone, Debug, PartialEq)]
pub struct Update {
    /// The part that changed.
    pub kind: &'static str,
    /// Text.
    pub text: String,
    /// Numbers.
    pub numbers: Vec<f64>,
    /// Cells.
    pub bytes: Vec<u8>,
}

impl Update {
    /// An update with numbers only.
    #[must_use]
    pub fn numbers(kind: &'static str, numbers: Vec<f64>) -> Self {
        Self {
            kind,
            text: String::new(),
            numbers,
            bytes: Vec::new(),
        }
    }

    /// An update with text only.
    #[must_use]
    pub fn text(kind: &'static str, text: impl Into<String>) -> Self {
        Self {
            text: text.into(),
            ..Self::numbers(kind, Vec::new())
        }
    }
}
