//! Changes for the widget: a kind, a text, numbers and bytes.
//!
//! | kind | numbers | text, bytes |
//! |---|---|---|
//! | `file` | size in bytes, whether there are scans | its name |
//! | `stage` | [`Stage`] as a number, share done, scans, loops tried, loops closed | what failed |
//! | `keyframes` | stamp (s), x, y (m), θ (rad), fit, σ (m) of each | |
//! | `map` | columns, rows, least x, least y, cell (m) | a byte a cell from the least y: 0 unknown, 1 free … 255 occupied |
//! | `loops` | ten for each, see [`links`](crate::links) | a line each: why it was rejected |
//! | `doubts` | keyframes to check | a sentence a line |
//! | `diagnosis` | | the doctor's screen as `slam2d doctor --json` prints it |
//! | `remarks` | | remarks for the log's owner, a sentence a line |
//! | `scan` | keyframe, then x and y of every point in the body's frame, m | |
//! | `grade` | see [`grade`](crate::grade) | in words |
//! | `errors` | error of each keyframe, m; NaN if unknown | |
//! | `offers` | | an option a line: its name, the current choice, the others, separated by tabs |
//! | `where` | see [`other_log`](crate::other_log) | the other log's name, then a sentence a line |
//! | `answer` | | the reply to the last order |

/// Progress of the engine.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// The file is read, scan by scan.
    Reading = 1,
    /// All scans are read: the last loops are closed.
    Finishing = 2,
    /// A graph from a file is solved.
    Solving = 3,
    /// The covariances are computed.
    Checking = 4,
    /// The map is finished.
    Done = 5,
    /// The file could not be processed.
    Failed = 6,
}

/// One change.
#[derive(Clone, Debug, PartialEq)]
pub struct Update {
    /// The part that changed.
    pub kind: &'static str,
    /// Words.
    pub text: String,
    /// Numbers.
    pub numbers: Vec<f64>,
    /// Cells.
    pub bytes: Vec<u8>,
}

impl Update {
    /// A change that consists of numbers only.
    #[must_use]
    pub fn numbers(kind: &'static str, numbers: Vec<f64>) -> Self {
        Self {
            kind,
            text: String::new(),
            numbers,
            bytes: Vec::new(),
        }
    }

    /// A change that consists of text only.
    #[must_use]
    pub fn text(kind: &'static str, text: impl Into<String>) -> Self {
        Self {
            text: text.into(),
            ..Self::numbers(kind, Vec::new())
        }
    }
}
